// Sticks and grips.
#include "app/view/wearer_controls.h"

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
                            ViewSettings& settings, Similarity& scene_from_room) {
    const bool menu = hands[kLeft].menu || hands[kRight].menu;
    if (menu && !menu_) {
        settings.panel = !settings.panel;
        if (settings.panel) { panel.hangBefore(room_from_head); }
    }
    menu_ = menu;
    panel.update(settings.panel ? hands : std::array<xr::Hand, 2>{});

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
    std::array<std::optional<glm::dvec3>, 2> now;
    for (const int h : {kLeft, kRight}) {
        if (holds(h)) { now[static_cast<std::size_t>(h)] = hands[static_cast<std::size_t>(h)].grip->position; }
    }
    // A hand that begins or ends to hold changes who holds, and moves nothing.
    const bool goes_on = now[kLeft].has_value() == held_[kLeft].has_value() && now[kRight].has_value() == held_[kRight].has_value();
    if (goes_on && now[kLeft] && now[kRight]) {
        scene_from_room = heldBy(scene_from_room, {*held_[kLeft], *held_[kRight]}, {*now[kLeft], *now[kRight]}, settings.tilt);
    } else if (goes_on && (now[kLeft] || now[kRight])) {
        const std::size_t h = now[kLeft] ? kLeft : kRight;
        scene_from_room = movedBy(scene_from_room, *held_[h] - *now[h]);
    }
    held_ = now;
}

}  // namespace binosplat
