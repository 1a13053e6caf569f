// Chapter 11: the controls that actions are bound to, their names, and haptics.
#include <algorithm>
#include <cctype>

#include "xr/simulated/api/actions.h"
#include "xr/simulated/api/api.h"
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr XrInputSourceLocalizedNameFlags kAllComponents =
    XR_INPUT_SOURCE_LOCALIZED_NAME_USER_PATH_BIT | XR_INPUT_SOURCE_LOCALIZED_NAME_INTERACTION_PROFILE_BIT |
    XR_INPUT_SOURCE_LOCALIZED_NAME_COMPONENT_BIT;

std::string titleOfUserPath(std::string_view user_path) {
    if (user_path == "/user/hand/left") { return "Left hand"; }
    if (user_path == "/user/hand/right") { return "Right hand"; }
    if (user_path == "/user/eyes_ext") { return "Eyes"; }
    return user_path == "/user/head" ? "Head" : "Gamepad";
}

// "/input/volume_up/click" is "Volume up".
std::string titleOfComponent(std::string_view component) {
    const std::size_t start = component.find('/', 1) + 1;
    std::string title(component.substr(start, component.find('/', start) - start));
    std::replace(title.begin(), title.end(), '_', ' ');
    title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
    return title;
}

const AttachedAction& checkHaptic(Session& session, const XrHapticActionInfo* hapticActionInfo) {
    const XrHapticActionInfo& info = checkStruct(hapticActionInfo, XR_TYPE_HAPTIC_ACTION_INFO);
    const AttachedAction& action = getAttached(session, info.action);
    require(action.type == XR_ACTION_TYPE_VIBRATION_OUTPUT, XR_ERROR_ACTION_TYPE_MISMATCH, "the action ",
            getAction(session.instance, info.action).name, " is not haptic");
    checkSubactionPath(session.instance, action.subaction_paths, info.subactionPath);
    return action;
}

const Profile* profileOf(const Session& session, std::string_view user_path) {
    const std::optional<std::size_t> device = deviceOf(user_path);
    return device ? session.attachment->profiles[*device] : nullptr;
}

// A line in the log for each controller that would vibrate.
void logHaptic(Session& session, const AttachedAction& action, XrPath subaction_path,
               const std::string& what) {
    if (session.state != XR_SESSION_STATE_FOCUSED) { return; }
    for (const BoundSource& source : action.sources) {
        if (subaction_path != XR_NULL_PATH && source.user_path != subaction_path) { continue; }
        constexpr const char* kNames[kDevices] = {"left ", "right ", "head ", "gamepad ", "eyes "};
        session.log_events.push_back(std::string("haptic ") + kNames[source.device] + what);
    }
}

// Even before the session begins: haptics are dropped then.
XrResult successOfHaptic(const Session& session) {
    return session.state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

}  // namespace

XrResult xrGetCurrentInteractionProfile(XrSession session, XrPath topLevelUserPath,
                                        XrInteractionProfileState* interactionProfile) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        XrInteractionProfileState& output =
            checkStruct(interactionProfile, XR_TYPE_INTERACTION_PROFILE_STATE);
        const std::string& user_path = owner.instance.paths.textOf(topLevelUserPath);
        require(owner.instance.hasUserPath(user_path), XR_ERROR_PATH_UNSUPPORTED, user_path,
                " is not a top-level user path");
        require(owner.attachment.has_value(), XR_ERROR_ACTIONSET_NOT_ATTACHED, "no action sets are attached");
        const Profile* const profile = profileOf(owner, user_path);
        output.interactionProfile =
            profile != nullptr ? owner.instance.paths.pathOf(profile->path) : XR_NULL_PATH;
    });
}

XrResult xrEnumerateBoundSourcesForAction(XrSession session,
                                          const XrBoundSourcesForActionEnumerateInfo* enumerateInfo,
                                          uint32_t sourceCapacityInput, uint32_t* sourceCountOutput,
                                          XrPath* sources) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const auto& info = checkStruct(enumerateInfo, XR_TYPE_BOUND_SOURCES_FOR_ACTION_ENUMERATE_INFO);
        std::vector<XrPath> paths;
        for (const BoundSource& source : getAttached(owner, info.action).sources) {
            if (std::find(paths.begin(), paths.end(), source.path) == paths.end()) {
                paths.push_back(source.path);
            }
        }
        fillArray(sourceCapacityInput, sourceCountOutput, sources, paths);
    });
}

XrResult xrGetInputSourceLocalizedName(XrSession session, const XrInputSourceLocalizedNameGetInfo* getInfo,
                                       uint32_t bufferCapacityInput, uint32_t* bufferCountOutput,
                                       char* buffer) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const auto& info = checkStruct(getInfo, XR_TYPE_INPUT_SOURCE_LOCALIZED_NAME_GET_INFO);
        checkFlags(info.whichComponents, kAllComponents, "whichComponents");
        const std::string& path = owner.instance.paths.textOf(info.sourcePath);
        require(owner.attachment.has_value(), XR_ERROR_ACTIONSET_NOT_ATTACHED, "no action sets are attached");
        const std::string_view user_path = userPathOf(path);
        const std::string_view component = std::string_view(path).substr(user_path.size());
        const bool is_source =
            !user_path.empty() && (component.starts_with("/input/") || component.starts_with("/output/"));
        require(is_source, XR_ERROR_PATH_UNSUPPORTED, path, " is not the path of a source");
        std::string name;
        const auto append = [&](XrInputSourceLocalizedNameFlags part, const std::string& title) {
            if ((info.whichComponents & part) != 0 && !title.empty()) {
                name += (name.empty() ? "" : " ") + title;
            }
        };
        append(XR_INPUT_SOURCE_LOCALIZED_NAME_USER_PATH_BIT, titleOfUserPath(user_path));
        if (const Profile* profile = profileOf(owner, user_path)) {
            append(XR_INPUT_SOURCE_LOCALIZED_NAME_INTERACTION_PROFILE_BIT, std::string(profile->title));
        }
        append(XR_INPUT_SOURCE_LOCALIZED_NAME_COMPONENT_BIT, titleOfComponent(component));
        fillString(bufferCapacityInput, bufferCountOutput, buffer, name);
    });
}

XrResult xrApplyHapticFeedback(XrSession session, const XrHapticActionInfo* hapticActionInfo,
                               const XrHapticBaseHeader* hapticFeedback) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const AttachedAction& action = checkHaptic(owner, hapticActionInfo);
        const auto& vibration =
            reinterpret_cast<const XrHapticVibration&>(checkStruct(hapticFeedback, XR_TYPE_HAPTIC_VIBRATION));
        const bool has_duration = vibration.duration > 0 || vibration.duration == XR_MIN_HAPTIC_DURATION;
        require(has_duration, XR_ERROR_VALIDATION_FAILURE, "the duration is ", vibration.duration,
                ", must be positive or XR_MIN_HAPTIC_DURATION");
        const bool is_in_range =
            vibration.amplitude >= 0 && vibration.amplitude <= 1 && vibration.frequency >= 0;
        require(is_in_range, XR_ERROR_VALIDATION_FAILURE, "the amplitude is ", vibration.amplitude,
                ", must be 0 to 1, and the frequency ", vibration.frequency, ", must not be negative");
        std::string pulse = "on ";
        append(pulse, vibration.duration);
        pulse += ' ';
        append(pulse, vibration.amplitude);
        // An amplitude of 0 ends any vibration.
        logHaptic(owner, action, hapticActionInfo->subactionPath, vibration.amplitude > 0 ? pulse : "off");
        return successOfHaptic(owner);
    });
}

XrResult xrStopHapticFeedback(XrSession session, const XrHapticActionInfo* hapticActionInfo) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const AttachedAction& action = checkHaptic(owner, hapticActionInfo);
        logHaptic(owner, action, hapticActionInfo->subactionPath, "off");
        return successOfHaptic(owner);
    });
}

}  // namespace simulated
