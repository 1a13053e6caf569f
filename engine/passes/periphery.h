// An eye's picture away from its gaze: rendered at half its size, except where the eye would see the difference.
//
//   periphery       which tiles of the half-size picture are needed; and once it exists, which of the eye's own are rendered
//   fill_periphery  fills the others from the half-size picture
#pragma once

#include "engine/gpu/kernel.h"
#include "engine/passes/passes.h"
#include "engine/passes/shown_tiles.h"
#include "engine/passes/warp_passes.h"

namespace binosplat {

// The same view in half as many rows and columns, with the low-pass of the eye's own: each pixel covers two by two of these, and the last
// one may reach beyond.
Eye halfOf(const Eye& eye);

// The tiles to render of both pictures of an eye.
class PeripheryBuffers {
public:
    PeripheryBuffers() = default;
    // For a picture of `size_px`; 0: none.
    PeripheryBuffers(const Context& context, glm::uvec2 size_px);

    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    [[nodiscard]] TileMask own() const { return tilesAt(0, size_px_); }
    [[nodiscard]] TileMask ofHalf() const;
    // For the eye's own tiles, the loss expected at half the size.
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> losses() const;
    [[nodiscard]] const Buffer& buffer() const { return words_; }

private:
    [[nodiscard]] TileMask tilesAt(std::uint64_t first_word, glm::uvec2 size_px) const;

    glm::uvec2 size_px_{0, 0};
    Buffer words_;
};

// The inputs of one eye's passes.
struct PeripheryInputs {
    const FrameBuffers& buffers;
    const PeripheryBuffers& tiles;
    int index, half_index;  // of FrameState::targets
    Role role;
    const Picture& target;
    const Picture& half;
    const ShownTiles& shown;
    glm::vec3 background;
    const Intrinsics& lens;
    const Gaze& gaze;
    // If both pictures are made from their pasts, and some of the tiles here are chosen later: kinds by tile, kTileHidden if not needed.
    gpu::DeviceAddress<gpu::uint> kinds = {}, half_kinds = {};
    [[nodiscard]] bool fromPasts() const { return kinds.value != 0; }
};

KernelTable peripheryKernels();

class PeripheryPasses {
public:
    explicit PeripheryPasses(const Context& context) : kernels_(context, peripheryKernels()) {}
    // As in WarpPasses.
    void rebuildKernels() { kernels_.rebuild(); }
    [[nodiscard]] std::size_t kernelCount() const { return kernels_.size(); }
    void takeKernels(PeripheryPasses& from) { kernels_.take(from.kernels_); }

    // In this order; the half-size picture is made after the first, and the other one after the second.
    void recordHalfChoice(Commands& commands, const PeripheryInputs& in);
    void recordChoice(Commands& commands, const PeripheryInputs& in);
    void recordFill(Commands& commands, const PeripheryInputs& in);

private:
    KernelCache kernels_;
};

}  // namespace binosplat
