// An eye's picture warped from the one that it showed before, and the tiles of both eyes that are rendered again.
//
//   warp_past    what the past shows, block by block, and the error to expect of each tile
//   warp_pixels  the pixels of other blocks one by one
//   mark_changed where the scene differs from what the past saw
//   price        what it costs to mend that, with one budget for all eyes
//   select       the tiles to render
#pragma once

#include "engine/gpu/kernel.h"
#include "engine/passes/warp_passes.h"

#include <span>

namespace binosplat {

// The inputs of one eye's passes.
struct PastInputs {
    const FrameBuffers& buffers;
    const WarpBuffers& warp;
    int index;  // of FrameState::targets
    Role role;
    const Picture& source;
    const Picture& target;
    gpu::DeviceAddress<gpu::uint> shown, source_shown;  // masks of the tiles that are seen; null: all
    bool gaze;                                          // it is known where the eye looks; otherwise all tiles count alike
};

// The eye `now` and the one whose picture is its past, for the device. `near`: nothing is seen before this, in scene units.
gpu::PastView pastViewOf(const Eye& now, const Eye& past, double near, const glm::vec3& background);

// `by_address`: as lib/past.glsl has it; of software devices.
KernelTable pastKernels(bool by_address);

class PastPasses {
public:
    explicit PastPasses(const Context& context) : by_address_(context.isSoftware()), kernels_(context, pastKernels(by_address_)) {}
    // As in WarpPasses.
    void rebuildKernels() { kernels_.rebuild(); }
    [[nodiscard]] std::size_t kernelCount() const { return kernels_.size(); }
    void takeKernels(PastPasses& from) { kernels_.take(from.kernels_); }

    // The target's colours, words and tiles.
    void recordWarp(Commands& commands, const PastInputs& in);
    // Between the two: marks where the scene changed since the past was made.
    void recordChanged(Commands& commands, const PastInputs& in, gpu::DeviceAddress<gpu::ChangedRect> rects, gpu::uint count);
    // Chooses the tiles of all `eyes`, one target after the other, that are rendered again; `at_once` of them at the same time. The first
    // one's WarpView has the budget, a share of all eyes' work.
    void recordChoice(Commands& commands, std::span<const PastInputs> eyes, gpu::uint at_once);

private:
    bool by_address_;
    KernelCache kernels_;
};

}  // namespace binosplat
