// The passes of a frame: those of shaders/sort and shaders/splat, as functions that record them.
//
//   cull_pages  which pages of a scene whose chunks come and go may hold splats that cull keeps
//   cull        which splats may touch a pixel of any eye
//   compact     these in the scene's order, with the depth or the distance of their centres
//   sort_depth  front to back
//   project     as one eye sees them, and how many tiles each meets
//   bin         a (tile, splat) pair for each tile a splat meets
//   sort_tiles  the pairs by tile, front to back within
//   rasterize   blending: colour, alpha and depth
// The passes that make the other eye from this one are in warp_passes.h.
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/passes/frame_buffers.h"
#include "shaders/shared/passes.h"

#include <optional>

namespace binosplat {

// What the rasterizer writes in addition to the colour.
struct Kept {
    bool depth = false;                           // D, to Picture::depths
    bool moments = false;                         // I and J
    bool moving = false;                          // the picture is going to be warped into the other eye
    bool even_rows = false;                       // only its even rows are warped; needs kDepthInverse, and no moments kept
    gpu::uint depth_choice = gpu::kDepthInverse;  // of a warped pixel; that of a past is always this
    bool half_floats = false;                     // colours are stored as half floats
    bool past = false;                            // later pictures are going to be made from this one: its words and tiles are kept
};

// The tiles to render (shaders/lib/tile_mask.glsl). `list` is there only if the device alone knows how many they are; `full` is
// then as long, for those of them that have pairs.
struct TileMask {
    gpu::DeviceAddress<gpu::uint> mask, list, full;
};

// A picture that a frame renders, all of it or some tiles.
struct Target {
    int index = 0;  // of FrameState::views and targets
    int list = 0;   // of the visible splats
    glm::uvec2 size_px{0, 0}, size_tiles{0, 0};
    PairArrays pairs;
    const Picture* picture = nullptr;
    glm::vec3 background{0.0f};
    Kept kept;
    bool is_made = false;                                      // from a past: tiles whose lists have no room stay
    bool coarse = false;                                       // tiles that its eye does not see sharply may be
    gpu::DeviceAddress<gpu::vec2> moments = {};                // if they are kept
    gpu::DeviceAddress<gpu::uint> moving = {}, arrivals = {};  // if the picture is warped
    gpu::uint row_words = 0;                                   // of `moving` and `arrivals`
    int share = 0, shares = 1;                                 // of the lists' room: `pairs` belongs to this share
    float low_pass = gpu::kLowPass;                            // EyeView
    bool lists_chosen = false;                 // the list holds what touches its chosen tiles, and there is no other one for these
    gpu::DeviceAddress<gpu::uint> shown = {};  // the lens's visibility mask, if it hides anything; the other tiles become background
};

// How many bits distinguish the tiles of a picture, and no tile.
unsigned tileBits(glm::uvec2 size_tiles);

// The eyes of a list of visible splats: it holds what any of the eyes [first, first + count) sees, ordered by the distance from the middle
// between the eyes, or without one by the depths of `order_eye`.
struct EyesOfList {
    int first = 0;
    int count = 1;
    int order_eye = 0;
    int list = 0;
    std::optional<gpu::Place> middle = {};
    int shares = 1;                                                 // how many pictures are rendered from it at the same time
    gpu::DeviceAddress<gpu::uint> first_mask = {}, last_mask = {};  // if only the chosen tiles of each eye count
};

// All kernels of cull to rasterize, sorting included. `threads_per_cell`: see Passes.
KernelTable passKernels(const Context& context, std::uint32_t threads_per_cell = 0);

class Passes {
public:
    // `threads_per_cell`: 8, 16, 32 or 64 invocations blend 8x8 pixels; 0: as wide as the device's
    // subgroups. Fewer if its workgroups are too small.
    explicit Passes(const Context& context, std::uint32_t threads_per_cell = 0);
    // See Context::replacedShaders. Throws Error if one cannot be made, and then keeps the old ones.
    void rebuildKernels();
    [[nodiscard]] std::size_t kernelCount() const { return kernels_.size(); }
    // Takes over the kernels of others on the same device, with as many threads per cell, whose work is done, and keeps those of its own
    // that the others lack.
    void takeKernels(Passes& from);

    // How many splats are visible: only cull.
    void recordCull(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes, Role role);
    // The list of these, front to back: compact and sort_depth. Also again by the depths of another eye; visibility is then not determined
    // anew.
    void recordOrder(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes, Role role);
    // The picture of an eye: project to rasterize.
    void recordEye(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const Target& target, Role role);
    // The same for some tiles only: the others stay as they are. Several pictures with equal tiles run beside each other, each with its
    // share of the lists.
    struct Patch {
        Target target;
        TileMask mask;
    };
    void recordTiles(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, std::span<const Patch> patches, Role role);

private:
    void recordCullPages(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes, Role role);
    struct EyePart;
    void record(std::span<const EyePart> parts);
    void recordProjected(const EyePart& part);
    void recordBinned(const EyePart& part);
    void recordLargeBinned(const EyePart& part);
    void recordTileRanges(const EyePart& part, const KeyValues& sorted);
    void recordRasterized(const EyePart& part, const KeyValues& sorted);
    const Sort& sort();

    const Context& context_;
    std::uint32_t threads_per_cell_;
    std::optional<Sort> sort_;  // made when it is first needed
    KernelCache kernels_;
};

}  // namespace binosplat
