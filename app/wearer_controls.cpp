// Sticks and grips.
#include "app/wearer_controls.h"

#include <cmath>

namespace binosplat {

namespace {

constexpr double kWalkMetresPerSecond = 1.5, kRiseMetresPerSecond = 0.8;
constexpr double kTurnRadians = 0.5235987755982988;  // 30 degrees
constexpr double kStickTurns = 0.7, kStickRests = 0.4, kStickDeadZone = 0.15;

// Thumbs push aside a little when they push ahead: the larger part counts alone.
glm::dvec2 dominantAxis(const glm::dvec2& stick) {
    return std::abs(stick.x) > std::abs(stick.y) ? glm::dvec2(stick.x, 0.0) : glm::dvec2(0.0, stick.y);
}

double withoutShiver(double stick) { return std::abs(stick) < kStickDeadZone ? 0.0 : stick; }

}  // namespace

void WearerControls::update(const std::array<xr::Hand, 2>& hands, const Pose& room_from_head, double step_seconds, OverlayPanel& panel,
                            bool& panel_shown, Similarity& scene_from_room) {
    const bool menu = hands[kLeft].menu || hands[kRight].menu;
    if (menu && !menu_) {
        panel_shown = !panel_shown;
        if (panel_shown) { panel.hangBefore(room_from_head); }
    }
    menu_ = menu;
    panel.update(panel_shown ? hands : std::array<xr::Hand, 2>{});

    const glm::dvec3 forward = levelled(room_from_head.orientation * glm::dvec3(0.0, 0.0, 1.0));
    const glm::dvec3 down(0.0, 1.0, 0.0), right = glm::cross(down, forward);
    const glm::dvec2 walk(withoutShiver(hands[kLeft].stick.x), withoutShiver(hands[kLeft].stick.y));
    const glm::dvec2 right_stick = dominantAxis(hands[kRight].stick);
    const double rise = panel.pointer().place_px ? 0.0 : withoutShiver(right_stick.y);  // over the panel it scrolls
    const glm::dvec3 step_m = kWalkMetresPerSecond * (walk.x * right + walk.y * forward) - kRiseMetresPerSecond * rise * down;
    if (step_m != glm::dvec3(0.0)) { scene_from_room = movedBy(scene_from_room, step_seconds * step_m); }

    const double turn = right_stick.x;
    if (std::abs(turn) > kStickTurns && !turned_) {
        scene_from_room = turnedBy(scene_from_room, std::copysign(kTurnRadians, turn), room_from_head.position);
        turned_ = true;
    } else if (std::abs(turn) < kStickRests) {
        turned_ = false;
    }

    const auto holds = [&](int h) {
        const xr::Hand& hand = hands[static_cast<std::size_t>(h)];
        return hand.grabs && hand.grip.has_value() && !panel.isCarriedBy(h);
    };
    if (!holds(kLeft) || !holds(kRight)) {
        held_.reset();
        return;
    }
    const std::array<glm::dvec3, 2> now{hands[kLeft].grip->position, hands[kRight].grip->position};
    if (held_) { scene_from_room = heldBy(scene_from_room, *held_, now); }
    held_ = now;
}

}  // namespace binosplat
