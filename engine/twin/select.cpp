// Twin of select: chooses the tiles whose errors cost least to remove.
#include "engine/twin/history.h"

#include <functional>
#include <map>

namespace binosplat::reference {

namespace {

// The price at which the budget ends, and what is left of the budget there; empty: the budget is enough for
// all.
struct BudgetEnd {
    std::optional<std::uint32_t> last;
    std::uint64_t left;
};
BudgetEnd findEnd(const std::map<std::uint32_t, std::uint64_t, std::greater<>>& cost_of_price,
                  std::uint64_t budget_cost) {
    std::uint64_t left = budget_cost;
    for (const auto& [price, cost] : cost_of_price) {
        if (cost > left) { return {price, left}; }
        left -= cost;
    }
    return {std::nullopt, left};
}

}  // namespace

void select(std::vector<TileKind>& kinds, std::span<const std::optional<std::uint32_t>> prices,
            std::span<const std::uint64_t> costs, std::uint64_t budget_cost,
            std::span<const std::optional<std::uint32_t>> whole_prices) {
    const std::span<const std::optional<std::uint32_t>> whole = whole_prices.empty() ? prices : whole_prices;
    std::map<std::uint32_t, std::uint64_t, std::greater<>> cost_of_price;
    for (std::size_t tile = 0; tile < whole.size(); ++tile) {
        if (whole[tile]) { cost_of_price[*whole[tile]] += costs[tile]; }
    }
    auto [last, left] = findEnd(cost_of_price, budget_cost);
    bool goes_on = true;
    for (std::size_t tile = 0; tile < prices.size(); ++tile) {
        if (!prices[tile] || (last && *prices[tile] < *last)) { continue; }
        if (last && *prices[tile] == *last) {
            if (*whole[tile] != *last) { continue; }  // it would have been chosen already
            goes_on = goes_on && costs[tile] <= left;
            if (!goes_on) { continue; }
            left -= costs[tile];
        }
        kinds[tile] = TileKind::kPredicted;
    }
}

std::uint64_t budgetUnderBound(std::span<const PricedTiles> pictures, std::uint64_t budget_cost,
                               std::uint64_t picture_cost) {
    std::uint64_t over = 0, unseen = 0;
    for (const PricedTiles& picture : pictures) {
        for (std::size_t t = 0; t < picture.prices.size(); ++t) {
            over += picture.prices[t] >= kOverPrice ? picture.costs[t] : 0;
            unseen += picture.prices[t] == kNewPrice ? picture.costs[t] : 0;
        }
    }
    return std::max(std::min(budget_cost, over + picture_cost / 20), unseen);
}

void selectTogether(std::span<const PricedTiles> pictures, std::uint64_t budget_cost) {
    std::map<std::uint32_t, std::uint64_t, std::greater<>> cost_of_price;
    for (const PricedTiles& picture : pictures) {
        for (std::size_t t = 0; t < picture.prices.size(); ++t) {
            if (const auto& price = picture.prices[t]) { cost_of_price[*price] += picture.costs[t]; }
        }
    }
    const auto [last, left] = findEnd(cost_of_price, budget_cost);
    std::uint64_t spent = 0;
    for (const PricedTiles& picture : pictures) {
        for (std::size_t t = 0; t < picture.prices.size(); ++t) {
            const auto& price = picture.prices[t];
            if (!price || (last && *price < *last)) { continue; }
            if (last && *price == *last) {
                if (spent >= left) { continue; }
                spent += picture.costs[t];
            }
            picture.kinds[t] = TileKind::kPredicted;
        }
    }
}

}  // namespace binosplat::reference
