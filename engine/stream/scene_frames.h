// The splats of a moving scene at one time, and how they differ from those before.
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

// All splats of one scene frame, in the order of their file. Frames may share a page that is the same in both.
using SceneFrame = std::vector<std::shared_ptr<const SplatPage>>;

// Throws Error if the scene's splats are of another kind than the traits'. Pages that are the same in `like` are shared with it.
SceneFrame makeSceneFrame(const Scene& scene, const SceneTraits& traits, const SceneFrame& like = {});
// Splats, and bytes of the pages that are not in `without`.
std::uint64_t splatsIn(const SceneFrame& frame);
std::uint64_t bytesIn(const SceneFrame& frame, const SceneFrame& without = {});

// True if splat i of one is splat i of the other, a little further on: there are as many, and most are nearer to each other than
// kNearbyShare of the distance between two of one frame.
inline constexpr double kNearbyShare = 0.1;
bool correspond(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits);
// Between two frames that correspond, `share` of the way: every value linearly, and rotations along the shorter of two ways, of unit
// length.
SceneFrame between(const SceneFrame& from, const SceneFrame& to, float share, const SceneTraits& traits);

struct FrameDifference {
    std::vector<std::uint32_t> pages;  // that differ, or that only one of the two has
    // Where the differing splats of these pages were and are: boxes that share no splat, kMostBoxes at most.
    std::vector<SceneChange> changes;
};
inline constexpr int kBoxesAside = 12;
inline constexpr std::size_t kMostBoxes = std::size_t{kBoxesAside} * kBoxesAside * kBoxesAside;
FrameDifference differenceOf(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits);

}  // namespace binosplat
