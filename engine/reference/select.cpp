// select: the tiles whose errors are mended at the least cost.
#include "engine/reference/stereo.h"

#include <functional>
#include <map>

namespace binosplat::reference {

void select(std::vector<TileKind>& kinds, std::span<const std::optional<std::uint32_t>> prices, std::span<const std::uint64_t> costs,
            std::uint64_t budget_cost, std::span<const std::optional<std::uint32_t>> whole_prices) {
    const std::span<const std::optional<std::uint32_t>> whole = whole_prices.empty() ? prices : whole_prices;
    std::map<std::uint32_t, std::uint64_t, std::greater<>> cost_of_price;
    for (std::size_t tile = 0; tile < whole.size(); ++tile) {
        if (whole[tile]) { cost_of_price[*whole[tile]] += costs[tile]; }
    }
    // The price at which the budget ends, and what is left for it.
    std::optional<std::uint32_t> last;
    std::uint64_t left = budget_cost;
    for (const auto& [price, cost] : cost_of_price) {
        if (cost > left) {
            last = price;
            break;
        }
        left -= cost;
    }
    bool goes_on = true;
    for (std::size_t tile = 0; tile < prices.size(); ++tile) {
        if (!prices[tile] || (last && *prices[tile] < *last)) { continue; }
        if (last && *prices[tile] == *last) {
            if (*whole[tile] != *last) { continue; }  // it would have been paid for before
            goes_on = goes_on && costs[tile] <= left;
            if (!goes_on) { continue; }
            left -= costs[tile];
        }
        kinds[tile] = TileKind::kPredicted;
    }
}

}  // namespace binosplat::reference
