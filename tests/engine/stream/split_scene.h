// Makes streamed SOG scenes from whole ones, for tests without a real one.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <string>

namespace binosplat::test {

struct SplitSettings {
    std::uint32_t leaf_splats = 16384;  // at most, at the finest level
    // Each has half the splats of the one before, but at least one per leaf.
    std::uint32_t levels = 5;
    std::uint32_t chunk_splats = 262144;  // per file, at most, unless a leaf has more
};

// Writes lod-meta.json and its chunks, as bundles LEVEL_NUMBER.sog, to `folder`, which is created if it does
// not exist. The tree is cut at medians. Level k keeps every 2^k-th splat of a leaf along a Morton curve,
// with its group's mean colour and 2^k times its area. Throws Error if files cannot be written.
void splitScene(const Scene& scene, const std::string& folder, const SplitSettings& settings = {});

}  // namespace binosplat::test
