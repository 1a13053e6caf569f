// Scenes whose chunks come and go, for tests: neighbouring splats are loaded together.
#pragma once

#include "engine/stream/resident_scene.h"
#include "tests/engine/frame/gpu_scenes.h"

namespace binosplat::test {

// These splats of a scene, in this order.
inline Scene splatsOf(const Scene& scene, std::span<const std::uint32_t> splats) {
    Scene some = scene;
    some.positions.clear();
    some.rotations.clear();
    some.scales.clear();
    some.thicknesses.clear();
    some.opacities.clear();
    some.sh.clear();
    const auto numbers = static_cast<std::ptrdiff_t>(3 * shCoefficientCount(scene.sh_degree));
    for (const std::uint32_t splat : splats) {
        some.positions.push_back(scene.positions[splat]);
        some.rotations.push_back(scene.rotations[splat]);
        some.scales.push_back(scene.scales[splat]);
        if (scene.isGaussian3d()) { some.thicknesses.push_back(scene.thicknesses[splat]); }
        some.opacities.push_back(scene.opacities[splat]);
        some.sh.insert(some.sh.end(), scene.sh.begin() + splat * numbers,
                       scene.sh.begin() + (splat + 1) * numbers);
    }
    return some;
}

inline Scene splatsOf(const Scene& scene, std::size_t first, std::size_t count) {
    std::vector<std::uint32_t> splats(count);
    std::iota(splats.begin(), splats.end(), static_cast<std::uint32_t>(first));
    return splatsOf(scene, splats);
}

// All of it along Morton's curve through its bounds, with ten bits per axis.
inline Scene inMortonOrder(const Scene& scene) {
    glm::vec3 low(scene.positions.at(0)), high = low;
    for (const glm::vec3& position : scene.positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    std::vector<std::uint32_t> codes, order(scene.size());
    for (const glm::vec3& position : scene.positions) {
        const glm::uvec3 cell(1023.0f * (position - low) / glm::max(high - low, glm::vec3(1e-30f)));
        std::uint32_t code = 0;
        for (int bit = 0; bit < 10; ++bit) {
            for (int axis = 0; axis < 3; ++axis) { code |= (cell[axis] >> bit & 1u) << (3 * bit + axis); }
        }
        codes.push_back(code);
    }
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t splat) { return codes[splat]; });
    return splatsOf(scene, order);
}

inline std::uint32_t pagesOf(std::size_t splats) {
    return static_cast<std::uint32_t>((splats + gpu::kPageSplats - 1) / gpu::kPageSplats);
}

// A whole scene as one part, which the first frame brings to the device; `more` pages stay free.
class WholeInPages {
public:
    WholeInPages(const Context& context, const Scene& scene, std::uint32_t more = 0)
        : resident(context, traitsOf(scene),
                   {.capacity_pages = pagesOf(scene.size()) + more, .most_bytes_a_frame = 1u << 30}),
          part(resident.add(PackedPages(scene, resident.traits())).value()) {}

    ResidentScene resident;
    ResidentScene::Part part;
};

}  // namespace binosplat::test
