// Sticks and grips.
#include "app/view/wearer/wearer_controls.h"

#include "app/view/placement/placement.h"

#include <cmath>
#include <utility>

namespace binosplat {

namespace {

constexpr double kWalkMetresPerSecond = 1.5, kRiseMetresPerSecond = 0.8;
constexpr double kTurnRadians = 0.5235987755982988;  // 30 degrees
constexpr double kTurnRadiansPerSecond = 1.5707963267948966;
constexpr double kStickTurns = 0.7, kStickRests = 0.4, kStickDeadZone = 0.15;
// Where the runtime knows no floor: below the head of a wearer who stands at the start.
constexpr double kUsualFloorMetres = 1.6;

// Thumbs push aside a little when they push ahead: the larger part counts alone.
glm::dvec2 dominantAxis(const glm::dvec2& stick) {
    return std::abs(stick.x) > std::abs(stick.y) ? glm::dvec2(stick.x, 0.0) : glm::dvec2(0.0, stick.y);
}

double withoutShiver(double stick) { return std::abs(stick) < kStickDeadZone ? 0.0 : stick; }

}  // namespace

void WearerControls::update(const WearerNow& now, PanelInRoom& panel, ViewState& state) {
    const ViewSettings& settings = state.settings();
    const bool menu = now.hands[kLeft].menu || now.hands[kRight].menu;
    if (menu && !menu_) {
        state.togglePanel();
        if (settings.panel) { panel.hangBefore(now.room_from_head); }
    }
    menu_ = menu;
    const bool play = now.hands[kLeft].play || now.hands[kRight].play;
    play_pressed_ = play && !std::exchange(play_, play);
    play_ = play;
    viewpoint_step_ = 0;
    for (const int h : {kLeft, kRight}) {
        const bool pressed = now.hands[static_cast<std::size_t>(h)].stick_presses;
        if (pressed && !std::exchange(stick_presses_[static_cast<std::size_t>(h)], pressed)) { viewpoint_step_ += h == kRight ? 1 : -1; }
        stick_presses_[static_cast<std::size_t>(h)] = pressed;
    }
    panel.update(now.hands, settings.panel);
    walk(now, panel, state);
    if (settings.teleport) {
        teleport(now, panel, state);
    } else {
        aiming_.reset();
        teleport_ = {};
    }
    turn(now, panel, state);
    hold(now, panel, state);
}

void WearerControls::walk(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    const glm::dvec3 forward = levelled(now.room_from_head.orientation * glm::dvec3(0.0, 0.0, 1.0));
    const glm::dvec3 down(0.0, 1.0, 0.0), right = glm::cross(down, forward);
    const auto stickOf = [&](int h) { return panel.isPointedAtBy(h) ? glm::dvec2(0.0) : now.hands[static_cast<std::size_t>(h)].stick; };
    const glm::dvec2 left_stick = state.settings().teleport ? glm::dvec2(0.0) : stickOf(kLeft);
    const glm::dvec2 walk(withoutShiver(left_stick.x), withoutShiver(left_stick.y));
    const double rise = withoutShiver(dominantAxis(stickOf(kRight)).y);
    const glm::dvec3 step_m = kWalkMetresPerSecond * (walk.x * right + walk.y * forward) - kRiseMetresPerSecond * rise * down;
    moves_ = step_m != glm::dvec3(0.0);
    if (moves_) { state.place(movedBy(state.sceneFromRoom(), now.step_seconds * step_m)); }
}

void WearerControls::teleport(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    const auto aims = [&](int h) {
        const xr::Hand& hand = now.hands[static_cast<std::size_t>(h)];
        // Who aims may pass over the panel.
        const bool may_push = h == kLeft && (aiming_ == h || !panel.isPointedAtBy(h));
        const bool pushed = may_push && hand.stick.y > (aiming_ == h ? kStickRests : kStickTurns);
        return hand.aim.has_value() && (pushed || panel.clicksElsewhere(h));
    };
    if (aiming_ && !aims(*aiming_)) {
        // A hand that was lost did not let go.
        if (now.hands[static_cast<std::size_t>(*aiming_)].aim && teleport_.target) {
            glm::dvec3 step_m = *teleport_.target - now.room_from_head.position;
            step_m.y = 0.0;
            state.place(movedBy(state.sceneFromRoom(), step_m));
        }
        aiming_.reset();
    }
    for (const int h : {kRight, kLeft}) {
        if (!aiming_ && aims(h)) { aiming_ = h; }
    }
    teleport_ = {};
    if (aiming_) { teleport_ = aimTeleport(*now.hands[static_cast<std::size_t>(*aiming_)].aim, now.floor_m.value_or(kUsualFloorMetres)); }
}

void WearerControls::turn(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    const glm::dvec2& stick = now.hands[kRight].stick;
    const double turn = dominantAxis(stick).x;
    if (state.settings().smooth_turn) {
        const double rate = panel.isPointedAtBy(kRight) ? 0.0 : withoutShiver(turn);
        if (rate == 0.0) { return; }
        moves_ = true;
        const double angle_rad = kTurnRadiansPerSecond * rate * now.step_seconds;
        state.place(turnedBy(state.sceneFromRoom(), angle_rad, now.room_from_head.position));
        return;
    }
    if (std::abs(turn) > kStickTurns && !turned_) {
        state.place(turnedBy(state.sceneFromRoom(), std::copysign(kTurnRadians, turn), now.room_from_head.position));
        turned_ = true;
    } else if (std::abs(stick.x) < kStickRests) {  // however far it is pushed ahead
        turned_ = false;
    }
}

void WearerControls::hold(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    std::array<std::optional<glm::dvec3>, 2> holding;
    for (const int h : {kLeft, kRight}) {
        const xr::Hand& hand = now.hands[static_cast<std::size_t>(h)];
        if (hand.grabs && hand.grip && !panel.isCarriedBy(h)) { holding[static_cast<std::size_t>(h)] = hand.grip->position; }
    }
    // A hand that begins or ends to hold changes who holds, and moves nothing.
    const bool goes_on = holding[kLeft].has_value() == held_[kLeft].has_value() && holding[kRight].has_value() == held_[kRight].has_value();
    if (goes_on && holding[kLeft] && holding[kRight]) {
        state.place(
            heldBy(state.sceneFromRoom(), {*held_[kLeft], *held_[kRight]}, {*holding[kLeft], *holding[kRight]}, state.settings().tilt));
    } else if (goes_on && (holding[kLeft] || holding[kRight])) {
        const std::size_t h = holding[kLeft] ? kLeft : kRight;
        state.place(movedBy(state.sceneFromRoom(), *held_[h] - *holding[h]));
    }
    held_ = holding;
}

}  // namespace binosplat
