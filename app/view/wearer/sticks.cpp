// Walking and turning.
#include "app/view/wearer/sticks.h"

#include "app/view/placement/placement.h"

#include <cmath>

namespace binosplat {

namespace {

constexpr double kWalkMetresPerSecond = 1.5, kRiseMetresPerSecond = 0.8;
constexpr double kTurnRadiansPerSecond = 1.5707963267948966;

// Thumbs that push forwards also push aside a little: only the larger part counts.
glm::dvec2 dominantAxis(const glm::dvec2& stick) {
    return std::abs(stick.x) > std::abs(stick.y) ? glm::dvec2(stick.x, 0.0) : glm::dvec2(0.0, stick.y);
}

double withoutShiver(double stick) { return std::abs(stick) < kStickDeadZone ? 0.0 : stick; }

}  // namespace

void Walk::update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    const glm::dvec3 forward = levelAhead(now.room_from_head);
    const glm::dvec3 down(0.0, 1.0, 0.0), right = glm::cross(down, forward);
    const auto stickOf = [&](int h) {
        return panel.isPointedAtBy(h) ? glm::dvec2(0.0) : now.hands[static_cast<std::size_t>(h)].stick;
    };
    const glm::dvec2 left_stick = state.settings().teleport ? glm::dvec2(0.0) : stickOf(kLeft);
    const glm::dvec2 walk(withoutShiver(left_stick.x), withoutShiver(left_stick.y));
    const double rise = withoutShiver(dominantAxis(stickOf(kRight)).y);
    const glm::dvec3 step_m =
        kWalkMetresPerSecond * (walk.x * right + walk.y * forward) - kRiseMetresPerSecond * rise * down;
    moves_ = step_m != glm::dvec3(0.0);
    if (moves_) { state.place(movedBy(state.sceneFromRoom(), now.step_seconds * step_m)); }
}

void Turn::update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    moves_ = false;
    const glm::dvec2& stick = now.hands[kRight].stick;
    const double turn = dominantAxis(stick).x;
    if (state.settings().smooth_turn) {
        const double rate = panel.isPointedAtBy(kRight) ? 0.0 : withoutShiver(turn);
        moves_ = rate != 0.0;
        const double angle_rad = kTurnRadiansPerSecond * rate * now.step_seconds;
        if (moves_) { state.place(turnedBy(state.sceneFromRoom(), angle_rad, now.room_from_head.position)); }
        return;
    }
    if (std::abs(turn) > kStickPushed && !turned_) {
        state.place(
            turnedBy(state.sceneFromRoom(), std::copysign(kTurnRadians, turn), now.room_from_head.position));
        turned_ = true;
    } else if (std::abs(stick.x) < kStickRests) {  // however far the stick is pushed forwards
        turned_ = false;
    }
}

}  // namespace binosplat
