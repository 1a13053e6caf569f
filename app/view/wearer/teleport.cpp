// A throw.
#include "app/view/wearer/teleport.h"

#include <cmath>

namespace binosplat {

namespace {

constexpr double kThrowMetresPerSecond = 7.0, kFallMetresPerSecond2 = 9.8;
constexpr double kArcWidthMetres = 0.012, kTargetMetres = 0.5, kAboveFloorMetres = 0.01;

}  // namespace

TeleportAim aimTeleport(const Pose& room_from_aim, double floor_m) {
    const glm::dvec3& from = room_from_aim.position;
    const double height_m = floor_m - from.y;
    if (!(height_m > 0.0)) { return {}; }
    const glm::dvec3 start = kThrowMetresPerSecond * (room_from_aim.orientation * glm::dvec3(0.0, 0.0, 1.0));
    const glm::dvec3 fall(0.0, kFallMetresPerSecond2, 0.0);
    // height = start.y t + fall t^2 / 2
    const double seconds = (-start.y + std::sqrt(start.y * start.y + 2.0 * kFallMetresPerSecond2 * height_m)) / kFallMetresPerSecond2;
    TeleportAim aim;
    for (std::size_t i = 0; i <= kTeleportStrips; ++i) {
        const double t = seconds * static_cast<double>(i) / static_cast<double>(kTeleportStrips);
        aim.arc.push_back(from + t * start + 0.5 * t * t * fall);
    }
    aim.target = aim.arc.back();
    return aim;
}

std::vector<Thing> thingsOf(const TeleportAim& aim, const glm::dvec3& eye) {
    std::vector<Thing> things;
    for (std::size_t i = 0; i + 1 < aim.arc.size(); ++i) {
        if (const auto strip = stripBetween(aim.arc[i], aim.arc[i + 1], kArcWidthMetres, eye)) { things.push_back({Sprite::kRay, *strip}); }
    }
    if (aim.target) { things.push_back({Sprite::kTarget, lying(*aim.target - glm::dvec3(0.0, kAboveFloorMetres, 0.0), kTargetMetres)}); }
    return things;
}

}  // namespace binosplat
