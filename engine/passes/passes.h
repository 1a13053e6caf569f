// The passes of a frame: those of shaders/sort and shaders/splat, as functions that record them.
//
//   cull_pages  which pages of a scene whose chunks come and go may hold such splats as cull keeps
//   cull        which splats may touch a pixel of any eye
//   compact     those in the scene's order, with the depth or the distance of their centres
//   sort_depth  front to back
//   project     as one eye sees them, and how many tiles each meets
//   bin         a (tile, splat) pair for each tile a splat meets
//   sort_tiles  the pairs by tile, front to back within
//   rasterize   blending: colour, alpha and depth
// What makes the other eye from this one is in warp_passes.h.
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
    bool moving = false;                          // the picture is going to be moved into the other eye
    bool spread = false;                          // and how far its pixels' depths spread
    bool even_rows = false;                       // only its even rows are; needs kDepthInverse, and no moments kept
    gpu::uint depth_choice = gpu::kDepthInverse;  // of a moving pixel
    bool half_floats = false;                     // colours are kept as these
    bool past = false;  // later pictures are going to be made from this one: its words and tiles are kept; it moves with its spread
};

// The tiles that are rendered (shaders/lib/tile_mask.glsl). `list` is there only where the device alone knows how many they are; `full` is
// then as long, and has room for those of them that have pairs.
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
    bool is_made = false;                                      // by a past: tiles of which lists have no room stay
    bool square_boxes = false;                                 // EyeCounters::square_box_pairs are counted, where all tiles are shown
    gpu::DeviceAddress<gpu::vec2> moments = {};                // where they are kept
    gpu::DeviceAddress<gpu::uint> moving = {}, arrivals = {};  // likewise
    gpu::uint row_words = 0;                                   // of these two
    int share = 0, shares = 1;                                 // of the lists' room: `pairs` is of this share
    float low_pass = gpu::kLowPass;                            // EyeView
    bool lists_chosen = false;                 // the list holds what touches its chosen tiles, and has no one of its own for these
    gpu::DeviceAddress<gpu::uint> shown = {};  // what the lens shows, as a mask, if it hides anything; the other tiles become background
};

// How many bits tell the tiles of a picture and no tile apart.
unsigned tileBits(glm::uvec2 size_tiles);

// Whose splats a list of visible ones holds: those that any of the eyes [first, first + count) sees, by the distance from the middle
// between the eyes, or without one by the depths of `order_eye`.
struct EyesOfList {
    int first = 0;
    int count = 1;
    int order_eye = 0;
    int list = 0;
    std::optional<gpu::Place> middle = {};
    int shares = 1;                                                 // as many pictures are rendered from it at the same time
    gpu::DeviceAddress<gpu::uint> first_mask = {}, last_mask = {};  // where only the chosen tiles of each eye count
};

// All kernels of cull to rasterize, sorting included. `threads_per_cell`: see Passes.
KernelTable passKernels(const Context& context, std::uint32_t threads_per_cell = 0);

class Passes {
public:
    // `threads_per_cell`: 8, 16, 32 or 64 invocations blend 8x8 pixels; 0: as wide as the device's
    // subgroups. Fewer where its workgroups are too small.
    explicit Passes(const Context& context, std::uint32_t threads_per_cell = 0);
    // See Context::replacedShaders. Throws Error where one cannot be made, and keeps the old ones then.
    void rebuildKernels();
    [[nodiscard]] std::size_t kernelCount() const { return kernels_.size(); }
    // Goes on with the kernels of others on the same device, with as many threads per cell, whose work is over, and with its own that
    // those lack.
    void takeKernels(Passes& from);

    // How many splats are visible: cull alone.
    void recordCull(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes, Role role);
    // The list of these, front to back: compact and sort_depth; also once more by the depths of another eye, and which eyes see the splats
    // is not asked again.
    void recordOrder(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes, Role role);
    // The picture of an eye: project to rasterize.
    void recordEye(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const Target& target, Role role);
    // The same for some tiles alone: the others stay as they are. Of several pictures with equal tiles beside each other, each with its
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
    std::optional<Sort> sort_;  // once it is wanted
    KernelCache kernels_;
};

}  // namespace binosplat
