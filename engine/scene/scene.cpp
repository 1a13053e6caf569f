// Changes to a whole scene: fewer bands of harmonics, another origin, only a part of it, discs made from
// Gaussians.
#include "engine/scene/scene.h"

#include "engine/scene/pick_splats.h"

#include <fmt/format.h>

#include <algorithm>

namespace binosplat {

void limitShDegree(Scene& scene, int sh_degree, LoadNotes& notes) {
    if (scene.sh_degree <= sh_degree) { return; }
    const auto old_width = static_cast<std::ptrdiff_t>(3 * shCoefficientCount(scene.sh_degree));
    const auto new_width = static_cast<std::ptrdiff_t>(3 * shCoefficientCount(sh_degree));
    for (std::ptrdiff_t i = 1; i < static_cast<std::ptrdiff_t>(scene.size()); ++i) {
        std::copy_n(scene.sh.begin() + i * old_width, new_width, scene.sh.begin() + i * new_width);
    }
    scene.sh.resize(scene.size() * static_cast<std::size_t>(new_width));
    scene.sh.shrink_to_fit();
    notes.sh_limited = true;
    notes.lines.push_back(fmt::format("{}: colours of SH degree {}, limited to {} as asked", scene.name,
                                      scene.sh_degree, sh_degree));
    scene.sh_degree = sh_degree;
}

void countFrom(Scene& scene, const glm::dvec3& origin) {
    if (scene.origin == origin) { return; }
    const glm::dvec3 shift = scene.origin - origin;
    for (glm::vec3& position : scene.positions) { position = glm::vec3(glm::dvec3(position) + shift); }
    scene.origin = origin;
}

std::string describeOrigin(const Scene& scene) {
    return fmt::format("{},{},{}", scene.origin.x, scene.origin.y, scene.origin.z);
}

void keepWithin(Scene& scene, const glm::dvec3& centre, double radius) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
        if (glm::distance(glm::dvec3(scene.positions[i]), centre) <= radius) { kept.push_back(i); }
    }
    if (kept.size() < scene.size()) { scene = pickSplats(scene, kept); }
}

void flatten(Scene& scene, LoadNotes& notes) {
    if (!scene.isGaussian3d()) { return; }
    scene.thicknesses = {};
    scene.antialiased = false;
    notes.lines.push_back(
        fmt::format("{}: three scales a splat (3DGS), flattened to discs by dropping the shortest axis of "
                    "each; the median splat is {:.2f} times "
                    "as thick as its second axis, so surfaces may look more translucent than as trained",
                    scene.name, notes.median_flatness));
}

}  // namespace binosplat
