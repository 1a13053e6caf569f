// A script as a function of time.
#include "xr/simulated/script/script.h"

#include "xr/simulated/script/script_inputs.h"

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace simulated {

namespace {

// The effect of an axis or a press on the components of its input.
void setAxis(ControllerState& state, const std::string& name, InputKind kind, const glm::dvec2& value) {
    if (kind == InputKind::kStick) {
        state.inputs[name + "/x"] = value.x;
        state.inputs[name + "/y"] = value.y;
        state.inputs[name + "/touch"] = value != glm::dvec2(0.0) ? 1.0 : 0.0;
        return;
    }
    constexpr double kClicksFrom = 0.9;
    state.inputs[name + "/value"] = value.x;
    if (kind == InputKind::kGesture) {
        state.inputs[name + "/ready_ext"] = value.x > 0.0 ? 1.0 : 0.0;
        return;
    }
    state.inputs[name + "/force"] = value.x;
    state.inputs[name + "/click"] = value.x >= kClicksFrom ? 1.0 : 0.0;
    state.inputs[name + "/touch"] = value.x > 0.0 ? 1.0 : 0.0;
}

void setPress(ControllerState& state, const Script::Hand::Press& press) {
    const InputKind kind = *kindOfInput(press.input);
    const bool is_gesture = kind == InputKind::kGesture;
    state.inputs[press.input + (is_gesture ? "/ready_ext" : "/touch")] = 1.0;
    if (press.touch_only) { return; }
    if (!is_gesture) { state.inputs[press.input + "/click"] = 1.0; }
    if (is_gesture || kind == InputKind::kAnalog) { state.inputs[press.input + "/value"] = 1.0; }
    if (kind == InputKind::kAnalog || kind == InputKind::kStick) {
        state.inputs[press.input + "/force"] = 1.0;
    }
}

ControllerState findController(const Script::Hand& hand, double time_s) {
    ControllerState state;
    state.tracked = hand.tracked.at(time_s);
    state.stage_from_grip = hand.stage_from_grip.at(time_s);
    state.stage_from_aim = compose(state.stage_from_grip, hand.grip_from_aim);
    if (!state.tracked) { return state; }
    for (const auto& [name, track] : hand.axes) {
        setAxis(state, name, *kindOfInput(name), track.at(time_s));
    }
    for (const Script::Hand::Press& press : hand.presses) {
        if (press.from_s <= time_s && time_s < press.to_s) { setPress(state, press); }
    }
    return state;
}

}  // namespace

std::optional<InputKind> kindOfInput(std::string_view name) {
    for (const Inputs inputs : {Inputs(kInputs), Inputs(kGamepadInputs)}) {
        const auto found = std::ranges::find(inputs, name, [](const auto& input) { return input.first; });
        if (found != inputs.end()) { return found->second; }
    }
    return std::nullopt;
}

double ControllerState::input(std::string_view identifier_and_component) const {
    const auto found = inputs.find(identifier_and_component);
    return found == inputs.end() ? 0.0 : found->second;
}

const char* nameOf(ScriptEvent::Kind kind) {
    constexpr const char* kNames[] = {"rate",         "slow-images",   "recentre",
                                      "lose-session", "lose-instance", "exit"};
    static_assert(std::size(kNames) == static_cast<std::size_t>(ScriptEvent::Kind::kExit) + 1);
    return kNames[static_cast<std::size_t>(kind)];
}

Script::Script() {
    stage_from_head = Track<Pose>(Pose{{1.0, 0.0, 0.0, 0.0}, {0.0, 1.6, 0.0}});
    for (const Side side : kSides) {
        // The forearms point ahead, a little below the shoulders.
        const double x = side == kLeft ? -0.2 : 0.2;
        hands[side].stage_from_grip = Track<Pose>(Pose{{1.0, 0.0, 0.0, 0.0}, {x, 1.2, -0.35}});
        const double angle = glm::radians(45.0);
        fovs[side].setInitial({-angle, angle, angle, -angle});
    }
}

State Script::at(double time_s) const {
    State state;
    state.time_s = time_s;
    state.stage_from_head = stage_from_head.at(time_s);
    for (const Side side : kSides) {
        state.eyes[side] = {compose(state.stage_from_head, headFromEye(side, eye_distance_m, cant_rad[side])),
                            fovs[side].at(time_s)};
        state.controllers[side] = findController(hands[side], time_s);
    }
    state.head_turn_known = head_turn_known.at(time_s);
    state.head_place_known = head_place_known.at(time_s) && state.head_turn_known;
    for (ControllerState& other : state.others) { other.tracked = false; }
    if (gamepad.isThere()) { state.device(kGamepad) = findController(gamepad, time_s); }
    ControllerState& eyes = state.device(kGaze);
    eyes.tracked = gaze.trackedAt(time_s) != GazeTracking::kOff;
    eyes.stage_from_aim = eyes.stage_from_grip = compose(state.stage_from_head, gaze.headFromGaze(time_s));
    state.gaze_is_good = gaze.trackedAt(time_s) == GazeTracking::kOn;
    state.should_render = should_render.at(time_s);
    state.worn = worn.at(time_s);
    state.visible = visible.at(time_s);
    state.focused = focused.at(time_s);
    state.present = present.at(time_s);
    return state;
}

std::vector<ScriptEvent> Script::eventsIn(double from_s, double to_s) const {
    std::vector<ScriptEvent> chosen;
    for (const ScriptEvent& event : events) {
        if (event.time_s > from_s && event.time_s <= to_s) { chosen.push_back(event); }
    }
    return chosen;
}

Pose Script::stageFromLocal(double time_s) const {
    const auto next = std::ranges::upper_bound(recentres_s, time_s);
    if (next != recentres_s.begin()) { return makeLevel(stage_from_head.at(*std::prev(next))); }
    return stage_from_local ? *stage_from_local : makeLevel(stage_from_head.at(0.0));
}

Pose Script::stageFromLocalFloor(double time_s) const {
    Pose floor = stageFromLocal(time_s);
    floor.position.y = 0.0;
    return floor;
}

Fov Script::findInset(const State& state, Side side, bool follows_gaze) const {
    const EyeState& eye = state.eyes[side];
    const ControllerState& gazing = state.device(kGaze);
    glm::dvec2 middle_rad = lens_centres_rad[side];
    if (follows_gaze && gazing.tracked && state.gaze_is_good) {
        const glm::dvec3 ahead = gazing.stage_from_aim.orientation * glm::dvec3(0.0, 0.0, -1.0);
        const glm::dvec3 direction = glm::conjugate(eye.stage_from_eye.orientation) * ahead;
        middle_rad = {std::atan2(direction.x, -direction.z), std::atan2(direction.y, -direction.z)};
    }
    return makeInset(eye.fov, middle_rad, inset.half_angle_rad);
}

glm::uvec2 Script::contextSizePx() const { return inset.context_px.value_or((size_px + 1u) / 2u); }

glm::uvec2 Script::insetSizePx() const {
    if (inset.size_px) { return *inset.size_px; }
    const auto extentOf = [](const Fov& fov) {
        return glm::dvec2(std::tan(fov.right_rad) - std::tan(fov.left_rad),
                          std::tan(fov.up_rad) - std::tan(fov.down_rad));
    };
    glm::dvec2 share(0.0);
    for (const Side side : kSides) {
        const Fov& whole = fovs[side].initial();
        share = glm::max(share, extentOf(makeInset(whole, lens_centres_rad[side], inset.half_angle_rad)) /
                                    extentOf(whole));
    }
    return glm::uvec2(glm::ceil(share * glm::dvec2(size_px) - 1e-9));
}

}  // namespace simulated
