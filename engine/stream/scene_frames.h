// What a moving scene shows at one time, and how it differs from what it showed before.
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/gpu/packed_splats.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace binosplat {

// Up to kPageSplats splats as the device holds them.
struct SplatPage {
    std::uint32_t splats = 0;
    gpu::ScenePage bounds;
    std::vector<std::uint8_t> bytes;  // laid out as a ChunkLayout of kPageSplats
};

// All splats of one scene frame, in the order of their file. What is the same in two frames may be one page.
using SceneFrame = std::vector<std::shared_ptr<const SplatPage>>;

// Throws Error where the scene's splats are of another kind than the traits'. Pages that `like` has too are its own.
SceneFrame makeSceneFrame(const Scene& scene, const SceneTraits& traits, const SceneFrame& like = {});
// Splats, and bytes of the pages that `without` has not.
std::uint64_t splatsIn(const SceneFrame& frame);
std::uint64_t bytesIn(const SceneFrame& frame, const SceneFrame& without = {});

// Whether splat i of one is splat i of the other, a little further on: as many of them, most of which lie nearer to each other than
// kNearbyShare of what lies between two of one frame.
inline constexpr double kNearbyShare = 0.1;
bool correspond(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits);
// Between two that correspond, `share` of the way: every value on a straight line, and rotations on the shorter of their two, of unit
// length.
SceneFrame between(const SceneFrame& from, const SceneFrame& to, float share, const SceneTraits& traits);

struct FrameDifference {
    std::vector<std::uint32_t> pages;  // that are others, or that only one of the two has
    // Where splats of these pages that are others were and are: boxes that share no splat, kMostBoxes at most.
    std::vector<SceneChange> changes;
};
inline constexpr int kBoxesAside = 12;
inline constexpr std::size_t kMostBoxes = std::size_t{kBoxesAside} * kBoxesAside * kBoxesAside;
FrameDifference differenceOf(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits);

}  // namespace binosplat
