// An eye's picture from the one that it showed before, and the tiles of both eyes that are rendered again.
//
//   warp_past    what the past shows, block by block, and the error to expect of each tile
//   warp_pixels  the pixels of other blocks one by one
//   mark_changed where the scene is another than the past saw
//   price        what it costs to mend that, with one budget for all eyes
//   select       the tiles that are rendered
#pragma once

#include "engine/gpu/kernel.h"
#include "engine/passes/warp_passes.h"

#include <span>

namespace binosplat {

// What the passes of one eye work on.
struct PastInputs {
    const FrameBuffers& buffers;
    const WarpBuffers& warp;
    int index;  // of FrameState::targets
    Role role;
    const Picture& source;
    const Picture& target;
    gpu::DeviceAddress<gpu::uint> shown;  // mask of the tiles that the lens shows; null: all
    // Where only some tiles are made: those, and how many (TargetState::wanted_tiles); the kinds of all are there then.
    gpu::DeviceAddress<gpu::uint> some_tiles;
    const Intrinsics& lens;
    std::optional<Gaze> gaze;  // empty: all tiles are seen alike
    float area = 1.0f;         // of a pixel, in those of the eye's own picture
};

// How the eye `now` and the one whose picture is its past look to the device. `near`: nothing is seen before this, in scene units.
gpu::PastView pastViewOf(const Eye& now, const Eye& past, double near, const glm::vec3& background);

KernelTable pastKernels();

class PastPasses {
public:
    explicit PastPasses(const Context& context) : kernels_(context, pastKernels()) {}
    // As of WarpPasses.
    void rebuildKernels() { kernels_.rebuild(); }
    [[nodiscard]] std::size_t kernelCount() const { return kernels_.size(); }
    void takeKernels(PastPasses& from) { kernels_.take(from.kernels_); }

    // The target's colours, words and tiles.
    void recordWarp(Commands& commands, const PastInputs& in);
    // Between the two: where the scene changed since the past was made.
    void recordChanged(Commands& commands, const PastInputs& in, gpu::DeviceAddress<gpu::ChangedRect> rects, gpu::uint count);
    // Which tiles of all `eyes` are rendered again. The first one's WarpView says the budget, a share of all eyes' work.
    void recordChoice(Commands& commands, std::span<const PastInputs> eyes);

private:
    KernelCache kernels_;
};

}  // namespace binosplat
