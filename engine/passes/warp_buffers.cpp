// Allocating the buffers of the passes of warp and choose.
#include "engine/passes/warp_buffers.h"

#include <algorithm>

namespace binosplat {

std::uint32_t mostRowSteps(const Context& context) {
    return context.sharedMemory() >= 32768 ? gpu::kMostRowSteps : 1;
}

std::uint64_t WarpBuffers::maskWords(glm::uvec2 size_px) {
    const glm::uvec2 tiles = tilesOf(size_px);
    return std::uint64_t{(tiles.x + 31) / 32} * tiles.y;
}

WarpBuffers::WarpBuffers(const Context& context, const WarpBufferNeeds& needs)
    : needs_(needs),
      size_px_(needs.memory_px),
      longest_shared_row_(mostRowSteps(context) * gpu::kArrivalsStep) {
    if (needs.memory_px.x == 0) { return; }
    const std::uint64_t words = 5 * std::uint64_t{tileCount()} + maskWords(needs.memory_px) +
                                std::max(gpu::kPriceBins, gpu::kDepthBins);
    tiles_ = Buffer(context, "warp tiles", words * sizeof(gpu::uint));
    if (needs.classes) {
        classes_ = Buffer(context, "pixel classes",
                          std::uint64_t{sizeTiles().x} * needs.memory_px.y * sizeof(gpu::uint));
    }
    boxes_ = Buffer(context, "boxes of holes", needs.boxes * sizeof(gpu::PixelBox));
    if (needs.history) {
        const glm::uvec2 block{gpu::kHistoryColumns, gpu::kHistoryRows},
            blocks = (needs.memory_px + block - 1u) / block;
        history_blocks_ = Buffer(context, "blocks of the history",
                                 std::uint64_t{blocks.x} * blocks.y * sizeof(gpu::HistoryBlock));
    } else if (!sharesRows()) {
        planes_ = Buffer(context, "reprojected pixels",
                         2 * sizeof(gpu::uint) * std::uint64_t{needs.memory_px.x} * needs.memory_px.y);
    }
}

void WarpBuffers::tell(gpu::TargetState& target) const {
    target.tile_kinds = tileKinds();
    target.tile_costs = tileCosts();
    target.tile_errors = tileErrors();
    target.tile_prices = tilePrices();
    target.tile_list = tileList();
    target.tile_mask = tileMask();
    target.full_tiles = tilesWithPairs();
}

gpu::DeviceAddress<gpu::uint> WarpBuffers::arrivals(const Picture& target) const {
    return sharesRows() ? target.colours.address<gpu::uint>() : planes_.address<gpu::uint>();
}

gpu::DeviceAddress<gpu::uint> WarpBuffers::moving(const Picture& target) const {
    const std::uint64_t width = size_px_.x;
    return sharesRows() ? arrivals(target).at(width) : arrivals(target).at(width * size_px_.y);
}

}  // namespace binosplat
