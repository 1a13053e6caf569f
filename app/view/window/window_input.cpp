// Walking and turning without a headset's controllers.
#include "app/view/window/window_input.h"

#include "app/view/placement/placement.h"

#include <cmath>

namespace binosplat {

namespace {

constexpr double kKeyTurnRadiansPerSecond = 1.2, kKeyWalkMetresPerSecond = 1.5;
// Factor by which a step of the wheel enlarges the scene.
constexpr double kGrowthPerStep = 1.1;

}  // namespace

Similarity movedByWindow(const Similarity& scene_from_room, const WindowInput& input,
                         const Pose& room_from_head, double step_seconds) {
    Similarity moved = scene_from_room;
    const double turn_rad = input.turn_rad + step_seconds * input.turn_rate * kKeyTurnRadiansPerSecond;
    if (turn_rad != 0.0) { moved = turnedBy(moved, turn_rad, room_from_head.position); }
    const glm::dvec3 forward = levelAhead(room_from_head), down(0.0, 1.0, 0.0);
    const glm::dvec3 right = glm::cross(down, forward);
    if (input.wheel != 0.0) {
        moved = grownBy(moved, std::pow(kGrowthPerStep, input.wheel), room_from_head.position);
    }
    if (input.tilt_rad != glm::dvec2(0.0)) {
        const glm::dquat tilt =
            glm::angleAxis(input.tilt_rad.x, forward) * glm::angleAxis(input.tilt_rad.y, right);
        moved = tiltedBy(moved, tilt, room_from_head.position);
    }
    const glm::dvec3 walk = input.walk.x * right + input.walk.y * down + input.walk.z * forward;
    if (walk != glm::dvec3(0.0)) { moved = movedBy(moved, step_seconds * kKeyWalkMetresPerSecond * walk); }
    return moved;
}

}  // namespace binosplat
