// Finds the nearest splat, by its centre.
#include "app/blind_camera.h"

#include "app/summary/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace binosplat {

std::string describeNearest(const Pose& world_from_camera, std::span<const glm::vec3> positions, double near,
                            const glm::dvec3& origin) {
    if (positions.empty()) { return "no splat is seen: the scene has none"; }
    const glm::dvec3 eye = world_from_camera.position,
                     forward = world_from_camera.orientation * glm::dvec3(0.0, 0.0, 1.0);
    const auto distanceTo = [&](const glm::vec3& position) {
        return glm::distance(eye, glm::dvec3(position));
    };
    const glm::dvec3 towards = glm::dvec3(*std::ranges::min_element(positions, {}, distanceTo)) - eye;
    const double nearest = glm::length(towards);
    const double cosine = nearest > 0.0 ? glm::dot(towards, forward) / nearest : 1.0;
    return fmt::format(
        "no splat is seen from {}: the nearest is {:.4g} scene units away, {:.0f} degrees off the middle of "
        "the "
        "picture{}",
        describePlace(eye + origin, nearest), nearest, glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))),
        nearest < near ? fmt::format("; nothing nearer than {:.4g} is drawn (near)", near) : "");
}

std::string describeCut(const Eye& eye, std::span<const glm::vec3> positions, double near) {
    const Pose camera_from_world = inverse(eye.world_from_camera);
    std::size_t cut = 0, seen = 0;
    for (const glm::vec3& position : positions) {
        const glm::dvec3 centre = transform(camera_from_world, glm::dvec3(position));
        if (!isInPicture(eye, centre)) { continue; }
        ++seen;
        cut += centre.z < near;
    }
    if (cut == 0 || 20 * cut < seen) { return ""; }
    return fmt::format("{} of the {} splats in the picture are nearer than {:.4g} (near) and are cut off",
                       cut, seen, near);
}

}  // namespace binosplat
