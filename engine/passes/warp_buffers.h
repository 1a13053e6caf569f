// The device memory of reprojection and of the choice of tiles.
#pragma once

#include "engine/passes/frame_buffers.h"

namespace binosplat {

// How much of a row resample can keep in shared memory, in units of kArrivalsStep.
std::uint32_t mostRowSteps(const Context& context);

// A frame's requirements.
struct WarpBufferNeeds {
    glm::uvec2 memory_px{0, 0};  // memory for pictures of both eyes of this size; 0: no mode that reprojects
    bool classes = false;        // of the target's pixels
    bool half_floats = false;    // what pictures consist of
    bool history = false;        // the eye's own history is the source
    std::uint32_t boxes = 0;     // components of holes that get their own boxes; 0 if centre ROIs are off
    bool operator==(const WarpBufferNeeds&) const = default;
};

// Arrays over the tiles and the price list are in one buffer, one after another. Moving pixels and arrivals
// share memory with the target eye's colours, row by row, if resample can keep a row of arrivals in shared
// memory; otherwise they are here.
class WarpBuffers {
public:
    WarpBuffers() = default;
    WarpBuffers(const Context& context, const WarpBufferNeeds& needs);

    [[nodiscard]] const WarpBufferNeeds& needs() const { return needs_; }
    // From now on pictures have this size, at most memory_px, which is their size at first.
    void use(glm::uvec2 size_px) { size_px_ = size_px; }
    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    [[nodiscard]] glm::uvec2 sizeTiles() const { return tilesOf(size_px_); }
    [[nodiscard]] std::uint32_t tileCount() const { return sizeTiles().x * sizeTiles().y; }

    [[nodiscard]] const Buffer& tiles() const { return tiles_; }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tileKinds() const {
        return tiles_.address<gpu::uint>(tileKindsOffset());
    }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tileErrors() const { return tileArray(1); }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tileCosts() const { return tileArray(2); }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tilePrices() const { return tileArray(3); }
    // The source's depth in the middle of each tile, until the prices replace it.
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tileDepths() const { return tilePrices(); }
    // Once tiles are chosen: those in the list that have pairs.
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tilesWithPairs() const { return tilePrices(); }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tileList() const { return tileArray(4); }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tileMask() const { return tileArray(5); }
    // Tells the target where these are.
    void tell(gpu::TargetState& target) const;
    // The price list, or the counts of depths.
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> bins() const { return tileMask().at(maskWords(size_px_)); }
    [[nodiscard]] static std::uint64_t tileKindsOffset() { return 0; }
    // Words of a mask of tiles: one bit each, with each row beginning a new word.
    static std::uint64_t maskWords(glm::uvec2 size_px);

    // The blocks that are made pixel by pixel.
    [[nodiscard]] gpu::DeviceAddress<gpu::HistoryBlock> historyBlocks() const {
        return history_blocks_.address<gpu::HistoryBlock>();
    }
    [[nodiscard]] gpu::DeviceAddress<gpu::PixelBox> boxes() const { return boxes_.address<gpu::PixelBox>(); }
    // Two bits a pixel, sixteen pixels a word, rows padded to whole tiles.
    [[nodiscard]] const Buffer& classesBuffer() const { return classes_; }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> pixelClasses() const { return classes_.address<gpu::uint>(); }

    // Moving pixels and arrivals: where the first rows begin, and the number of words from a row to the next.
    [[nodiscard]] bool sharesRows() const { return size_px_.x <= longest_shared_row_; }
    [[nodiscard]] gpu::uint rowWords() const {
        return (!sharesRows() ? 1 : needs_.half_floats ? 2 : 4) * size_px_.x;
    }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> arrivals(const Picture& target) const;
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> moving(const Picture& target) const;
    // How many kArrivalsStep a row takes in shared memory (see resample); 0: rows are not kept there.
    [[nodiscard]] std::uint32_t rowSteps() const {
        return sharesRows() ? (size_px_.x + gpu::kArrivalsStep - 1) / gpu::kArrivalsStep : 0;
    }

    [[nodiscard]] std::uint64_t bytes() const {
        return tiles_.bytes() + classes_.bytes() + boxes_.bytes() + planes_.bytes() + history_blocks_.bytes();
    }

private:
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tileArray(std::uint64_t i) const {
        return tileKinds().at(i * tileCount());
    }

    WarpBufferNeeds needs_;
    glm::uvec2 size_px_{0, 0};
    std::uint32_t longest_shared_row_ = 0;
    Buffer tiles_, classes_, boxes_, planes_, history_blocks_;
};

}  // namespace binosplat
