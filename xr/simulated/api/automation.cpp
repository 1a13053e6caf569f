// Inputs that a program's own test sets, checked against the profiles; they override the script.
#include "xr/simulated/api/automation.h"

#include <algorithm>
#include <cmath>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/poses.h"
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/spaces.h"

namespace simulated {
namespace {

constexpr std::string_view kInputPrefix = "/input/";

std::size_t checkInputDevice(const Session& session, XrPath user_path) {
    const std::string& text = session.instance.paths.textOf(user_path);
    const std::optional<std::size_t> device = deviceOf(text);
    require(device.has_value(), XR_ERROR_PATH_UNSUPPORTED, text, " is not the path of a device");
    return *device;
}

struct Input {
    DeviceOverride& device;
    std::string name;  // "trigger/value"; "thumbstick" of a vector
};

// An input of the device, by its whole path. `suffix` completes a vector's path to that of a component.
Input checkInput(Session& session, XrPath user_path, XrPath source_path, const char* suffix) {
    DeviceOverride& device = session.automation.devices[checkInputDevice(session, user_path)];
    const std::string &user = session.instance.paths.textOf(user_path),
                      &source = session.instance.paths.textOf(source_path);
    const std::string prefix = user + std::string(kInputPrefix);
    require(source.starts_with(prefix), XR_ERROR_PATH_UNSUPPORTED, source, " is not an input of ", user);
    const auto has = [&](const Profile& profile) {
        return session.instance.has(profile) &&
               findComponent(profile, user, source.substr(user.size()) + suffix, session.instance) != nullptr;
    };
    bool is_known = device.profile != nullptr && has(*device.profile);
    if (device.profile == nullptr) {
        for (const Profile& profile : listProfiles()) { is_known = is_known || has(profile); }
    }
    require(is_known, XR_ERROR_PATH_UNSUPPORTED,
            device.profile != nullptr ? device.profile->path : "no interaction profile", " has no ", source,
            suffix);
    return {device, source.substr(prefix.size())};
}

XrResult setInput(const char* function, XrSession session, XrPath user_path, XrPath source_path,
                  double value) {
    return answerFor<Session>(function, session, [&](Session& owner) {
        require(std::isfinite(value), XR_ERROR_VALIDATION_FAILURE, "the value is ", value,
                ", must be finite");
        const Input input = checkInput(owner, user_path, source_path, "");
        input.device.inputs[input.name] = value;
    });
}

}  // namespace

void Automation::applyTo(State& state) const {
    for (std::size_t i = 0; i < kDevices; ++i) {
        ControllerState& device = state.device(i);
        if (devices[i].is_active) { device.tracked = *devices[i].is_active; }
        if (devices[i].is_active && i == kGaze) { state.gaze_is_good = *devices[i].is_active; }
        for (const auto& [name, value] : devices[i].inputs) { device.inputs[name] = value; }
        if (devices[i].stage_from_grip) { device.stage_from_grip = *devices[i].stage_from_grip; }
        if (devices[i].stage_from_aim) { device.stage_from_aim = *devices[i].stage_from_aim; }
    }
}

XrResult xrSetInputDeviceActiveEXT(XrSession session, XrPath interactionProfile, XrPath topLevelPath,
                                   XrBool32 isActive) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const std::string& name = owner.instance.paths.textOf(interactionProfile);
        const Profile* const profile = findProfile(name);
        require(profile != nullptr, XR_ERROR_PATH_UNSUPPORTED, name, " is not an interaction profile");
        require(owner.instance.has(*profile), XR_ERROR_PATH_UNSUPPORTED, name, " needs ", profile->depends);
        const std::size_t device = checkInputDevice(owner, topLevelPath);
        const std::string& user_path = owner.instance.paths.textOf(topLevelPath);
        const bool is_for_it = std::find(profile->user_paths.begin(), profile->user_paths.end(), user_path) !=
                               profile->user_paths.end();
        require(is_for_it, XR_ERROR_PATH_UNSUPPORTED, name, " is not for ", user_path);
        DeviceOverride& moved = owner.automation.devices[device];
        // Another controller has other buttons.
        if (moved.profile != profile) { moved.inputs.clear(); }
        moved.profile = profile;
        moved.is_active = isActive != XR_FALSE;
    });
}

XrResult xrSetInputDeviceStateBoolEXT(XrSession session, XrPath topLevelPath, XrPath inputSourcePath,
                                      XrBool32 state) {
    return setInput(__func__, session, topLevelPath, inputSourcePath, state != XR_FALSE ? 1 : 0);
}

XrResult xrSetInputDeviceStateFloatEXT(XrSession session, XrPath topLevelPath, XrPath inputSourcePath,
                                       float state) {
    return setInput(__func__, session, topLevelPath, inputSourcePath, static_cast<double>(state));
}

XrResult xrSetInputDeviceStateVector2fEXT(XrSession session, XrPath topLevelPath, XrPath inputSourcePath,
                                          XrVector2f state) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        require(std::isfinite(state.x) && std::isfinite(state.y), XR_ERROR_VALIDATION_FAILURE,
                "the value is ", state.x, " ", state.y, ", must be finite");
        const Input input = checkInput(owner, topLevelPath, inputSourcePath, "/x");
        input.device.inputs[input.name + "/x"] = state.x;
        input.device.inputs[input.name + "/y"] = state.y;
    });
}

XrResult xrSetInputDeviceLocationEXT(XrSession session, XrPath topLevelPath, XrPath inputSourcePath,
                                     XrSpace space, XrPosef pose) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const Input input = checkInput(owner, topLevelPath, inputSourcePath, "");
        require(input.name.ends_with("/pose"), XR_ERROR_PATH_UNSUPPORTED, input.name, " is not a pose");
        checkPose(pose);
        const std::optional<Pose> stage_from_space =
            stageFromSpace(getSpace(owner, space), owner.at(owner.instance.simulation->clock.now()));
        require(stage_from_space.has_value(), XR_ERROR_VALIDATION_FAILURE,
                "the place of the space is not known");
        Pose stage_from_pose = compose(*stage_from_space, fromXr(pose));
        const bool aims = input.name == "aim/pose" || input.name == "gaze_ext/pose";
        if (!aims) {
            stage_from_pose = compose(
                stage_from_pose, inverse(gripFromPose(input.name, checkInputDevice(owner, topLevelPath))));
        }
        (aims ? input.device.stage_from_aim : input.device.stage_from_grip) = stage_from_pose;
    });
}

}  // namespace simulated
