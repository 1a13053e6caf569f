// The fence of the built-in scene before a wall of a quarter as many splats: as much to see around, at a third of the work.
#pragma once

#include "engine/scene/ply.h"
#include "engine/scene/procedural.h"

#include <cmath>
#include <filesystem>

namespace binosplat::test {

inline void writeLightFence(const std::filesystem::path& file) {
    const Scene whole = makeBuiltin("builtin:fence");
    Scene light = whole;
    light.positions.clear();
    light.rotations.clear();
    light.scales.clear();
    light.opacities.clear();
    light.sh.clear();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const glm::vec3& at = whole.positions[i];
        const bool is_wall = at.z > 2.0f;
        const auto isOdd = [](float along) { return std::lround((along + 3.0f) / 0.05f) % 2 != 0; };
        if (is_wall && (isOdd(at.x) || isOdd(at.y))) { continue; }
        light.positions.push_back(at);
        light.rotations.push_back(whole.rotations[i]);
        light.scales.push_back(whole.scales[i] * (is_wall ? 2.0f : 1.0f));
        light.opacities.push_back(whole.opacities[i]);
        light.sh.insert(light.sh.end(), whole.sh.begin() + static_cast<std::ptrdiff_t>(3 * i),
                        whole.sh.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    }
    writePly(light, file.string());
}

}  // namespace binosplat::test
