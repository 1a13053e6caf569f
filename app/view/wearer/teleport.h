// Where a wearer who points at the floor will stand. Room axes: x right, y down, z forward; metres.
#pragma once

#include "app/view/room/thing.h"

#include <optional>
#include <vector>

namespace binosplat {

struct TeleportAim {
    std::vector<glm::dvec3> arc;       // from the hand to the floor, kTeleportStrips + 1 points
    std::optional<glm::dvec3> target;  // on the floor; empty: the hand is below it, and there is no arc
};
constexpr std::size_t kTeleportStrips = 6;

// What is thrown from the hand along its aim falls there: the higher one points, the farther, up to some six metres. The floor's y is
// `floor_m`.
TeleportAim aimTeleport(const Pose& room_from_aim, double floor_m);

// The arc and its end, as `eye` sees them.
std::vector<Thing> thingsOf(const TeleportAim& aim, const glm::dvec3& eye);

}  // namespace binosplat
