// Picks the same splats from every array of a scene.
#include "engine/scene/pick_splats.h"

#include <algorithm>

namespace binosplat {

namespace {

// The scene's harmonics, padded with bands of zeros up to `degree`.
std::vector<float> widened(const Scene& scene, int degree) {
    const auto from = static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree)),
               to = static_cast<std::size_t>(3 * shCoefficientCount(degree));
    std::vector<float> sh(scene.size() * to);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        std::copy_n(scene.sh.data() + i * from, from, sh.data() + i * to);
    }
    return sh;
}

}  // namespace

Scene pickSplats(const Scene& scene, std::span<const std::uint32_t> splats) {
    Scene picked;
    const auto pick = [&](const auto& from, auto& to, std::size_t width) {
        to.reserve(splats.size() * width);
        for (const std::uint32_t splat : splats) {
            const auto begin = from.begin() + static_cast<std::ptrdiff_t>(splat * width);
            to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
        }
    };
    pick(scene.positions, picked.positions, 1);
    pick(scene.rotations, picked.rotations, 1);
    pick(scene.scales, picked.scales, 1);
    if (scene.isGaussian3d()) { pick(scene.thicknesses, picked.thicknesses, 1); }
    pick(scene.opacities, picked.opacities, 1);
    pick(scene.sh, picked.sh, static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree)));
    picked.name = scene.name;
    picked.sh_degree = scene.sh_degree;
    picked.origin = scene.origin;
    picked.antialiased = scene.antialiased;
    picked.by_distance = scene.by_distance;
    picked.y_up = scene.y_up;
    picked.vertical_axis = scene.vertical_axis;
    picked.is_linear = scene.is_linear;
    return picked;
}

void appendSplats(Scene& scene, const Scene& more) {
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    const int degree = std::max(scene.sh_degree, more.sh_degree);
    if (degree > scene.sh_degree) {
        scene.sh = widened(scene, degree);
        scene.sh_degree = degree;
    }
    append(scene.positions, more.positions);
    append(scene.rotations, more.rotations);
    append(scene.scales, more.scales);
    append(scene.thicknesses, more.thicknesses);
    append(scene.opacities, more.opacities);
    append(scene.sh, degree > more.sh_degree ? widened(more, degree) : more.sh);
}

}  // namespace binosplat
