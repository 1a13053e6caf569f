// The splats of a moving scene at one time, and how to get from them to those of another time.
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/gpu/packed_splats.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace binosplat {

// All splats of one scene frame, in the order of their file; each entry is one page, and only the last has
// fewer than kPageSplats.
using SceneFrame = std::vector<PackedPages>;

// Throws Error if the scene's splats are of another kind than the traits'.
SceneFrame makeSceneFrame(const Scene& scene, const SceneTraits& traits);
std::uint64_t splatsIn(const SceneFrame& frame);
std::uint64_t bytesIn(const SceneFrame& frame);

// True if splat i of one is splat i of the other, slightly moved: both have the same number, and most pairs
// are nearer to each other than kNearbyShare of the distance between two splats of the same frame.
inline constexpr double kNearbyShare = 0.1;
bool correspond(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits);

struct FrameStep {
    std::uint64_t splats = 0;          // in the frame that it leads to
    std::vector<std::uint32_t> pages;  // that differ, or that only one of the two has, in ascending order
    SceneFrame now;                    // these pages, as many of them as the frame has that it leads to
    // Where the differing splats of these pages were and are: at most kMostBoxes boxes, none of which share a
    // splat.
    std::vector<SceneChange> changes;
};
inline constexpr int kBoxesAside = 12;
inline constexpr std::size_t kMostBoxes = std::size_t{kBoxesAside} * kBoxesAside * kBoxesAside;
// The step to a frame or, if `next` corresponds to it, to a share of the way from that frame to `next`: every
// value is interpolated linearly, and rotations along the shorter of two arcs, with unit length.
FrameStep stepBetween(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits,
                      const SceneFrame* next = nullptr, float share = 0.0f);

}  // namespace binosplat
