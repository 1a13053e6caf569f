// The passes of a frame: those of shaders/sort and shaders/splat, as functions that record them.
//
//   cull_pages  which pages of a scene whose chunks come and go may hold splats that cull keeps
//   cull        which splats may touch a pixel of any eye
//   compact     these in the scene's order, with the depth or the distance of their centres
//   sort_depth  front to back
//   project     as one eye sees them, and how many tiles each touches
//   bin         a (tile, splat) pair for each tile a splat touches
//   sort_tiles  the pairs by tile, front to back within
//   rasterize   blending: colour, alpha and depth
// The passes that make the other eye from this one are in engine/baselines.
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/passes/frame_buffers.h"
#include "engine/passes/pass_kernels.h"
#include "shaders/shared/passes.h"

#include <optional>

namespace binosplat {

// What the rasterizer writes in addition to the colour.
struct Kept {
    bool depth = false;    // D, to Picture::depths
    bool surface = false;  // instead: A times the depth of the surface, see RasterizePass
    bool moments = false;  // I and J
    bool moving = false;   // the picture is going to be warped into the other eye
    // Only even rows are warped; needs kDepthInverse, and no moments kept.
    bool even_rows = false;
    gpu::uint depth_choice = gpu::kDepthInverse;  // of a warped pixel; that of a history is always this
    bool half_floats = false;                     // colours are stored as half floats
    // Splats are visible only where they are nearer than the target's mesh_depths.
    bool cut = false;
    // Later pictures are going to be made from this one: its words and tiles are kept.
    bool history = false;
};

// Pictures that a frame renders at once, in full or only some tiles; FrameState::views and targets say where
// they are.
struct Targets {
    int first = 0, count = 1;
    int list = 0;                 // of the visible splats
    glm::uvec2 size_tiles{0, 0};  // of the greatest
    gpu::uint all_tiles = 0;      // of all of them
    EmptyPictures empty;          // where lists may lie
    glm::vec3 background{0.0f};
    Kept kept;
    bool coarse = false;        // tiles that their eyes do not see sharply may be
    bool masked = false;        // not all tiles count: some are chosen, or a lens hides some
    bool chosen = false;        // passes listed the tiles to render; others stay as they are
    bool lists_chosen = false;  // the list holds what touches these, and there is no other one for them
};

// Where their lists are.
VisibleArrays visibleOf(const FrameBuffers& buffers, const Targets& targets);
PairFormat pairFormatOf(const FrameBuffers& buffers, const Targets& targets);
PairArrays pairsOf(const FrameBuffers& buffers, const Targets& targets);

// The eyes of a list of visible splats: it holds what any of the eyes [first, first + count) sees, ordered by
// the distance from the midpoint between the eyes or, without one, by the depths of `order_eye`.
struct EyesOfList {
    int first = 0;
    int count = 1;
    int order_eye = 0;
    int list = 0;
    std::optional<gpu::Place> middle = {};
    // How many pictures are rendered from it at once, and where lists of these may lie.
    int at_once = 1;
    EmptyPictures empty = {};
    // For when only the chosen tiles of each eye count.
    gpu::DeviceAddress<gpu::uint> first_mask = {}, last_mask = {};
};

// `by_lanes`: only if PassKernels::cellsAreNarrow.
ContributeKernel contributeKernel(std::uint32_t threads_per_cell, std::uint32_t splat_shape, bool fits,
                                  bool by_lanes);
RasterizeKernel rasterizeKernel(std::uint32_t threads_per_cell, const Kept& kept, std::uint32_t splat_shape,
                                bool masked, bool coarse);

// Only cull: how many splats are visible.
void recordCull(PassKernels& kernels, Commands& commands, const GpuScene& scene, const FrameBuffers& buffers,
                const EyesOfList& eyes, Role role);
// The list of visible splats, front to back: compact and sort_depth. May be called again with the depths of
// another eye; visibility is then not determined again.
void recordOrder(PassKernels& kernels, Commands& commands, const GpuScene& scene, const FrameBuffers& buffers,
                 const EyesOfList& eyes, Role role);
// The pictures: project to rasterize.
void recordPictures(PassKernels& kernels, Commands& commands, const GpuScene& scene,
                    const FrameBuffers& buffers, const Targets& targets, Role role);

}  // namespace binosplat
