// The tiles of an eye's picture that its lens shows, for the passes: a visibility mask for binning, and marks for the other eye's pixels.
#pragma once

#include "engine/gpu/commands.h"

#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

class ShownTiles {
public:
    explicit ShownTiles(const Context& context) : context_(context) {}

    // A byte a tile, row-major: 1 where nobody will see it; empty: all are shown. Changes are uploaded by the next record().
    void set(std::span<const std::uint8_t> hidden, glm::uvec2 size_tiles);
    // True if set() with these would change nothing.
    [[nodiscard]] bool isOf(std::span<const std::uint8_t> hidden, glm::uvec2 size_tiles) const;
    // Before the passes that read the mask. Records nothing if the device has it already.
    void record(Commands& commands);
    // To be called once what was recorded has run.
    void forgetUpload() { upload_ = {}; }

    [[nodiscard]] bool hideAny() const { return hidden_count_ > 0; }
    [[nodiscard]] std::uint32_t hiddenCount() const { return hidden_count_; }
    // The shown tiles, as in shaders/lib/tile_mask.glsl. Null if none is hidden.
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> mask() const { return words_.address<gpu::uint>(); }
    // Writes kTileHidden, or 0, into an array of tile kinds that begins `offset_bytes` into `kinds`.
    void recordKinds(Commands& commands, const Buffer& kinds, std::uint64_t offset_bytes) const;

private:
    const Context& context_;
    std::vector<std::uint8_t> hidden_;
    std::uint32_t hidden_count_ = 0;
    glm::uvec2 size_tiles_{0, 0};
    std::uint64_t mask_words_ = 0;
    Buffer words_, upload_;  // mask, kinds
};

}  // namespace binosplat
