// Finds up from cameras, or from the floor.
#include "app/view/scenes/scene_up.h"

#include "app/options/start_view.h"
#include "engine/builtin/procedural.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace binosplat {

namespace {

// The most splats that are examined.
constexpr std::size_t kMostSplats = 262144;
// A splat's area counts at most as this many medians: the largest are hills and sky.
constexpr double kMostMedians = 4.0;

}  // namespace

glm::dvec3 upOfFloor(const Scene& scene, const glm::dvec3& usual) {
    const std::size_t step = scene.size() / kMostSplats + 1;
    const auto areaOf = [&](std::size_t i) {
        return static_cast<double>(scene.scales[i].x) * static_cast<double>(scene.scales[i].y);
    };
    std::vector<double> areas;
    for (std::size_t i = 0; i < scene.size(); i += step) { areas.push_back(areaOf(i)); }
    if (areas.empty()) { return glm::normalize(usual); }
    const auto median = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
    std::nth_element(areas.begin(), median, areas.end());
    glm::dvec3 up = glm::normalize(usual);
    for (const double reach_deg : {45.0, 30.0, 20.0, 15.0, 10.0, 10.0}) {
        const double least_cosine = std::cos(glm::radians(reach_deg));
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < scene.size(); i += step) {
            const glm::dvec3 normal = glm::dquat(scene.rotations[i]) * glm::dvec3(0.0, 0.0, 1.0);
            const double cosine = glm::dot(normal, up);
            if (!(std::abs(cosine) >= least_cosine)) { continue; }
            const double weight =
                static_cast<double>(scene.opacities[i]) * std::min(areaOf(i), kMostMedians * *median);
            sum += std::copysign(weight, cosine) * normal;
        }
        const double length = glm::length(sum);
        if (!(length > 0.0) || !std::isfinite(length)) { return glm::normalize(usual); }
        up = sum / length;
    }
    return up;
}

glm::dvec3 upOfScene(const Scene& scene, const std::filesystem::path& source, const glm::dvec3& usual) {
    if (isBuiltin(scene.name)) { return glm::normalize(usual); }
    if (const auto found = upOfCameras(readSceneCameras(source, scene.origin).cameras, scene)) {
        return found->up;
    }
    return upOfFloor(scene, usual);
}

}  // namespace binosplat
