// The shown tiles of an eye's picture, for the passes: a visibility mask for binning, and marks for the other
// eye's pixels. Lenses hide the same ones in all frames; if a picture keeps its axes while the head turns,
// they change from frame to frame.
#pragma once

#include "engine/gpu/commands.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

class ShownTiles {
public:
    explicit ShownTiles(const Context& context) : context_(context) {}

    // For the next frame: a byte per tile, row-major, 1 if it is hidden; empty: all are shown. Masks have
    // memory for pictures of `memory_tiles`.
    void set(std::span<const std::uint8_t> hidden, glm::uvec2 size_tiles, glm::uvec2 memory_tiles);
    // Before the passes of a frame: uploads the mask, and keeps that of the frame before.
    void record(Commands& commands);

    // True if some tiles may be hidden.
    [[nodiscard]] bool isMasked() const { return !words_.empty(); }
    // The shown tiles, as in shaders/lib/tile_mask.glsl. Null if there is no mask.
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> mask() const { return addressOf(masks_[turn_]); }
    // Those of the frame before.
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> maskBefore() const { return addressOf(masks_[1 - turn_]); }
    // Writes kTileHidden, or 0, into an array of tile kinds that begins `offset_bytes` into `kinds`.
    void recordKinds(Commands& commands, const Buffer& kinds, std::uint64_t offset_bytes) const;

private:
    static gpu::DeviceAddress<gpu::uint> addressOf(const Buffer& mask) {
        return mask.bytes() > 0 ? mask.address<gpu::uint>() : gpu::DeviceAddress<gpu::uint>{};
    }

    const Context& context_;
    std::vector<std::uint8_t> hidden_;
    glm::uvec2 size_tiles_{0, 0}, memory_tiles_{0, 0};
    std::vector<gpu::uint> words_;  // of the mask
    std::array<Buffer, 2> masks_;   // of the last two frames; unused if all tiles are shown
    Buffer retired_;                // may be in use by a frame in flight
    std::size_t turn_ = 0;          // of the last frame that was recorded
};

}  // namespace binosplat
