// 8i: the tiles whose errors are mended at the least cost.
#include "engine/reference/stereo.h"

#include <algorithm>

namespace binosplat::reference {

void select(std::vector<TileKind>& kinds, std::span<const std::optional<std::uint32_t>> prices, std::span<const std::uint64_t> costs,
            std::uint64_t budget_cost) {
    std::vector<std::size_t> order;
    for (std::size_t tile = 0; tile < prices.size(); ++tile) {
        if (prices[tile]) { order.push_back(tile); }
    }
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return *prices[a] > *prices[b]; });
    std::uint64_t spent = 0;
    for (const std::size_t tile : order) {
        spent += costs[tile];
        if (spent > budget_cost) { break; }
        kinds[tile] = TileKind::kPredicted;
    }
}

}  // namespace binosplat::reference
