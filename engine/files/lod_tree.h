// The leaves of a streamed SOG scene: where each is, and which splats show it at each level of detail.
#pragma once

#include "engine/files/sog_meta.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace binosplat {

// At least one splat of a chunk, which is identified by its index in the scene's list of chunks.
struct LodRange {
    std::uint32_t level = 0;  // 0 is the scene's finest
    std::uint32_t file = 0;
    SplatRange splats;
};

struct LodLeaf {
    glm::vec3 low{0.0f}, high{0.0f};  // the corners of its box, scene units; finite, and low <= high
    // At least one level, the finest first; a leaf need not have every level of the scene.
    std::vector<LodRange> levels;
    // For each of `levels`, how far its picture is from that of the finest, in any unit that all leaves share
    // and in which errors add up; finite and not negative. Empty: not measured.
    std::vector<float> errors = {};
};

}  // namespace binosplat
