// Random scenes, and measures of how two scenes agree.
#pragma once

#include "engine/files/ply.h"
#include "tests/engine/files/ply_files.h"

namespace binosplat::test {

// `sh_range`: of the harmonics above the constant one.
inline Scene randomScene(int sh_degree, std::size_t splats, bool are_gaussians = true,
                         float sh_range = 0.2f) {
    std::mt19937 random(17);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    Scene scene;
    scene.sh_degree = sh_degree;
    for (std::size_t i = 0; i < splats; ++i) {
        scene.positions.emplace_back(3.0f * unit(random), 2.0f * unit(random), 50.0f * unit(random));
        scene.rotations.push_back(
            glm::normalize(glm::quat(unit(random), unit(random), unit(random), unit(random))));
        scene.scales.emplace_back(std::exp(-4.0f + 2.0f * unit(random)),
                                  std::exp(-4.0f + 2.0f * unit(random)));
        if (are_gaussians) {
            scene.thicknesses.push_back(std::min(scene.scales[i].x, scene.scales[i].y) *
                                        (0.5f + 0.4f * unit(random)));
        }
        scene.opacities.push_back(0.5f + 0.5f * unit(random));
        for (int k = 0; k < 3 * shCoefficientCount(sh_degree); ++k) {
            scene.sh.push_back((k < 3 ? 2.0f : sh_range) * unit(random));
        }
    }
    return scene;
}

// Whether every array has as many values as there are splats, and none is one that cannot be drawn.
inline bool isSound(const Scene& scene) {
    const std::size_t splats = scene.size();
    const auto finite = [](const auto&... values) { return (std::isfinite(values) && ...); };
    bool sound = scene.rotations.size() == splats && scene.scales.size() == splats &&
                 scene.opacities.size() == splats && std::ranges::all_of(scene.sh, finite) &&
                 scene.sh.size() == splats * 3 * shCoefficientCount(scene.sh_degree);
    for (std::size_t i = 0; sound && i < splats; ++i) {
        const glm::vec3& p = scene.positions[i];
        const glm::vec2& scale = scene.scales[i];
        sound = finite(p.x, p.y, p.z, scale.x, scale.y) && std::min(scale.x, scale.y) >= 0.0f &&
                std::abs(glm::length(scene.rotations[i]) - 1.0f) < 1e-4f &&
                scene.opacities[i] == within(0.0, 1.0);
    }
    return sound;
}

// What defines an ellipsoid or a disc, whatever the order of its axes.
inline glm::dmat3 covarianceOf(const Scene& scene, std::size_t splat) {
    glm::dmat3 axes(glm::mat3_cast(glm::dquat(scene.rotations[splat])));
    const glm::dvec3 lengths(scene.scales[splat], scene.isGaussian3d() ? scene.thicknesses[splat] : 0.0f);
    for (int axis = 0; axis < 3; ++axis) { axes[axis] *= lengths[axis]; }
    return axes * glm::transpose(axes);
}

inline double largest(const glm::dmat3& matrix) {
    double most = 0.0;
    for (int i = 0; i < 9; ++i) { most = std::max(most, std::abs(matrix[i / 3][i % 3])); }
    return most;
}

// The largest differences between two scenes of the same degree, in the constant harmonics and in the others.
// Splat i of `b` is order[i] of `a`, or i without an order.
inline std::pair<float, float> shDifferences(const Scene& a, const Scene& b,
                                             const std::vector<std::uint32_t>& order = {}) {
    const int width = 3 * shCoefficientCount(a.sh_degree);
    std::pair<float, float> most;
    for (std::size_t i = 0; i < b.sh.size(); ++i) {
        const std::size_t splat = order.empty() ? i / width : order[i / width];
        float& of_band = i % width < 3 ? most.first : most.second;
        of_band = std::max(of_band, std::abs(a.sh[width * splat + i % width] - b.sh[i]));
    }
    return most;
}

inline Scene writtenAndRead(const Folder& folder, const Scene& scene) {
    writePly(scene, folder.file("again.ply"));
    return loadScene(folder.file("again.ply"));
}

}  // namespace binosplat::test
