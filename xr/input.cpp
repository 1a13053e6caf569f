// Actions, and what they are bound to.
#include "xr/input.h"

#include "xr/bindings.h"
#include "xr/convert.h"

#include <cstring>
#include <utility>

namespace binosplat::xr {
namespace {

constexpr XrDuration kPulseNs = 15'000'000;
constexpr float kPulseStrength = 0.4f;
constexpr const char* kHandPaths[] = {"/user/hand/left", "/user/hand/right"};
constexpr XrSpaceLocationFlags kKnown = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
constexpr XrSpaceLocationFlags kTracked = XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;

}  // namespace

Input::Input(const Session& session) : session_(session), tracking_(session) {
    const Instance& instance = session.instance();
    for (std::size_t h = 0; h < 2; ++h) { hands_[h] = instance.path(kHandPaths[h]); }
    auto info = structure<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
    std::strcpy(info.actionSetName, "viewer");
    std::strcpy(info.localizedActionSetName, "Viewer");
    BINOSPLAT_XR(xrCreateActionSet(instance.handle(), &info, &set_));
    try {
        attachActions();
    } catch (...) {
        xrDestroyActionSet(set_);  // it is the instance's, and the next session's has the same name
        throw;
    }
}

void Input::attachActions() {
    const Instance& instance = session_.instance();
    aim_ = makeAction("aim", "Point at the panel", XR_ACTION_TYPE_POSE_INPUT);
    grip_ = makeAction("grip", "Hold the scene", XR_ACTION_TYPE_POSE_INPUT);
    trigger_ = makeAction("trigger", "Click", XR_ACTION_TYPE_FLOAT_INPUT);
    squeeze_ = makeAction("squeeze", "Grab", XR_ACTION_TYPE_FLOAT_INPUT);
    stick_ = makeAction("stick", "Move and turn", XR_ACTION_TYPE_VECTOR2F_INPUT);
    stick_click_ = makeAction("pad", "Press the pad to move and turn", XR_ACTION_TYPE_BOOLEAN_INPUT);
    stick_press_ = makeAction("viewpoint", "Next viewpoint, and back on the left", XR_ACTION_TYPE_BOOLEAN_INPUT);
    menu_ = makeAction("menu", "Show or hide the panel", XR_ACTION_TYPE_BOOLEAN_INPUT);
    haptic_ = makeAction("pulse", "Feel the panel", XR_ACTION_TYPE_VIBRATION_OUTPUT);
    suggestBindings();
    if (instance.tracksEyes()) { makeGazeAction(); }
    auto attach = structure<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
    attach.countActionSets = 1;
    attach.actionSets = &set_;
    BINOSPLAT_XR(xrAttachSessionActionSets(session_.handle(), &attach));
    for (std::size_t h = 0; h < 2; ++h) {
        auto space = structure<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
        space.subactionPath = hands_[h];
        space.poseInActionSpace.orientation.w = 1.0f;
        space.action = aim_;
        BINOSPLAT_XR(xrCreateActionSpace(session_.handle(), &space, &aim_spaces_[h]));
        space.action = grip_;
        BINOSPLAT_XR(xrCreateActionSpace(session_.handle(), &space, &grip_spaces_[h]));
    }
    if (gaze_ != XR_NULL_HANDLE) { makeGazeSpace(); }
}

void Input::makeGazeAction() {
    const Instance& instance = session_.instance();
    const bool made = instance.troubles().tryFor("eye tracking", [&] {
        gaze_ = makeAction("gaze", "Sharp where you look", XR_ACTION_TYPE_POSE_INPUT, false);
        const XrPath pose = instance.path("/user/eyes_ext/input/gaze_ext/pose");
        checkResult(suggest("ext/eye_gaze_interaction", {{gaze_, pose}}), "xrSuggestInteractionProfileBindings");
    });
    if (!made) { gaze_ = XR_NULL_HANDLE; }
}

void Input::makeGazeSpace() {
    auto space = structure<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
    space.poseInActionSpace.orientation.w = 1.0f;
    space.action = gaze_;
    const auto make = [&] { BINOSPLAT_XR(xrCreateActionSpace(session_.handle(), &space, &gaze_space_)); };
    if (!session_.instance().troubles().tryFor("eye tracking", make)) { gaze_ = XR_NULL_HANDLE; }
}

Input::~Input() {
    for (std::size_t h = 0; h < 2; ++h) {
        xrDestroySpace(aim_spaces_[h]);
        xrDestroySpace(grip_spaces_[h]);
    }
    if (gaze_space_ != XR_NULL_HANDLE) { xrDestroySpace(gaze_space_); }
    xrDestroyActionSet(set_);
}

XrAction Input::makeAction(const char* name, const char* description, XrActionType type, bool by_hand) {
    auto info = structure<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
    std::strcpy(info.actionName, name);
    std::strcpy(info.localizedActionName, description);
    info.actionType = type;
    if (by_hand) {
        info.countSubactionPaths = 2;
        info.subactionPaths = hands_.data();
    }
    XrAction action = XR_NULL_HANDLE;
    BINOSPLAT_XR(xrCreateAction(set_, &info, &action));
    return action;
}

void Input::suggestBindings() const {
    const Instance& instance = session_.instance();
    std::string rejected;
    for (const ProfileBindings& profile : allProfileBindings()) {
        if (profile.extension != nullptr && !instance.hasExtension(profile.extension)) { continue; }
        std::vector<XrActionSuggestedBinding> bindings;
        for (std::size_t h = 0; h < 2; ++h) {
            const auto bind = [&](XrAction action, const char* where) {
                if (where != nullptr) { bindings.push_back({action, instance.path(fmt::format("{}/{}", kHandPaths[h], where).c_str())}); }
            };
            bind(aim_, "input/aim/pose");
            bind(grip_, "input/grip/pose");
            bind(trigger_, profile.trigger);
            bind(squeeze_, profile.squeeze);
            bind(stick_, profile.stick);
            bind(stick_click_, profile.stick_click);
            bind(stick_press_, profile.stick_press);
            bind(menu_, profile.menu[h]);
            bind(haptic_, profile.haptic);
        }
        // A runtime need not know every controller.
        const XrResult result = suggest(profile.path, bindings);
        if (XR_FAILED(result)) { rejected += fmt::format("{}{} ({})", rejected.empty() ? "" : ", ", profile.path, nameOf(result)); }
    }
    if (!rejected.empty()) { instance.troubles().add("controllers that the OpenXR runtime does not take: " + rejected); }
}

XrResult Input::suggest(const std::string& profile, const std::vector<XrActionSuggestedBinding>& bindings) const {
    const Instance& instance = session_.instance();
    auto suggestion = structure<XrInteractionProfileSuggestedBinding>(XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
    suggestion.interactionProfile = instance.path(fmt::format("/interaction_profiles/{}", profile).c_str());
    suggestion.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
    suggestion.suggestedBindings = bindings.data();
    const XrResult result = xrSuggestInteractionProfileBindings(instance.handle(), &suggestion);
    if (result == XR_ERROR_INSTANCE_LOST) { checkResult(result, "xrSuggestInteractionProfileBindings"); }
    return result;
}

std::array<Hand, 2> Input::read() {
    std::array<Hand, 2> hands;
    const XrActiveActionSet active{set_, XR_NULL_PATH};
    auto sync = structure<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
    sync.countActiveActionSets = 1;
    sync.activeActionSets = &active;
    const bool is_focused = BINOSPLAT_XR(xrSyncActions(session_.handle(), &sync)) != XR_SESSION_NOT_FOCUSED;
    const bool was_at_rest = std::exchange(is_at_rest_, !is_focused);
    const bool is_new = std::exchange(times_focused_, session_.timesFocused()) != session_.timesFocused();
    if (!is_focused || is_new) {
        for (auto* holds : {&clicks_, &grabs_, &menus_, &presses_}) {
            for (Hold& hold : *holds) { hold.forget(); }
        }
    }
    // Where the focus went and came back between two frames, hands rest in one all the same, so that nothing is let go in its place.
    if (!is_focused || (is_new && !was_at_rest)) { return hands; }
    for (std::size_t h = 0; h < 2; ++h) {
        hands[h].aim = locate(aim_, hands_[h], aim_spaces_[h], kKnown);
        hands[h].grip = locate(grip_, hands_[h], grip_spaces_[h], kKnown);
        hands[h].joints = tracking_.locate(static_cast<int>(h));
        hands[h].clicks = clicks_[h].update(readNumber(trigger_, hands_[h]));
        hands[h].grabs = grabs_[h].update(readNumber(squeeze_, hands_[h]));
        // A pad that only feels the thumb is at rest.
        if (readButton(stick_click_, hands_[h]).value_or(true)) { hands[h].stick = readStick(hands_[h]); }
        const auto isHeld = [&](XrAction button, Hold& hold) {
            const std::optional<bool> pressed = readButton(button, hands_[h]);
            return hold.update(pressed ? std::optional(*pressed ? 1.0 : 0.0) : std::nullopt);
        };
        hands[h].menu = isHeld(menu_, menus_[h]);
        hands[h].stick_presses = isHeld(stick_press_, presses_[h]);
    }
    return hands;
}

std::optional<glm::dvec3> Input::gaze() {
    if (gaze_ == XR_NULL_HANDLE) { return std::nullopt; }
    std::optional<Pose> pose;
    const auto find = [&] { pose = locate(gaze_, XR_NULL_PATH, gaze_space_, kKnown | kTracked); };
    if (!session_.instance().troubles().tryFor("eye tracking", find)) { gaze_ = XR_NULL_HANDLE; }
    if (!pose) { return std::nullopt; }
    return pose->orientation * glm::dvec3(0.0, 0.0, 1.0);
}

void Input::pulse(int hand) {
    if (!pulses_) { return; }
    auto info = structure<XrHapticActionInfo>(XR_TYPE_HAPTIC_ACTION_INFO);
    info.action = haptic_;
    info.subactionPath = hands_[static_cast<std::size_t>(hand)];
    auto vibration = structure<XrHapticVibration>(XR_TYPE_HAPTIC_VIBRATION);
    vibration.duration = kPulseNs;
    vibration.frequency = XR_FREQUENCY_UNSPECIFIED;
    vibration.amplitude = kPulseStrength;
    pulses_ = session_.instance().troubles().tryFor("pulses", [&] {
        BINOSPLAT_XR(xrApplyHapticFeedback(session_.handle(), &info, reinterpret_cast<const XrHapticBaseHeader*>(&vibration)));
    });
}

std::optional<bool> Input::readButton(XrAction action, XrPath hand) const {
    auto get = structure<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
    get.action = action;
    get.subactionPath = hand;
    auto state = structure<XrActionStateBoolean>(XR_TYPE_ACTION_STATE_BOOLEAN);
    BINOSPLAT_XR(xrGetActionStateBoolean(session_.handle(), &get, &state));
    if (state.isActive != XR_TRUE) { return std::nullopt; }
    return state.currentState == XR_TRUE;
}

glm::dvec2 Input::readStick(XrPath hand) const {
    auto get = structure<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
    get.action = stick_;
    get.subactionPath = hand;
    auto state = structure<XrActionStateVector2f>(XR_TYPE_ACTION_STATE_VECTOR2F);
    BINOSPLAT_XR(xrGetActionStateVector2f(session_.handle(), &get, &state));
    return state.isActive == XR_TRUE ? glm::dvec2(glm::vec2(state.currentState.x, state.currentState.y)) : glm::dvec2(0.0);
}

std::optional<double> Input::readNumber(XrAction action, XrPath hand) const {
    auto get = structure<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
    get.action = action;
    get.subactionPath = hand;
    auto state = structure<XrActionStateFloat>(XR_TYPE_ACTION_STATE_FLOAT);
    BINOSPLAT_XR(xrGetActionStateFloat(session_.handle(), &get, &state));
    if (state.isActive != XR_TRUE) { return std::nullopt; }
    return static_cast<double>(state.currentState);
}

std::optional<Pose> Input::locate(XrAction action, XrPath hand, XrSpace space, XrSpaceLocationFlags needed) const {
    auto get = structure<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
    get.action = action;
    get.subactionPath = hand;
    auto state = structure<XrActionStatePose>(XR_TYPE_ACTION_STATE_POSE);
    BINOSPLAT_XR(xrGetActionStatePose(session_.handle(), &get, &state));
    if (state.isActive != XR_TRUE) { return std::nullopt; }
    auto location = structure<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    BINOSPLAT_XR(xrLocateSpace(space, session_.space(), session_.displayTime(), &location));
    if ((location.locationFlags & needed) != needed) { return std::nullopt; }
    return fromXr(location.pose);
}

}  // namespace binosplat::xr
