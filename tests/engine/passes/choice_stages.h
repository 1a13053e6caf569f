// price and select on the device, with made-up tiles.
#pragma once

#include "tests/engine/passes/history_stages.h"

namespace binosplat::test {

inline constexpr std::size_t kVisible = 12345;
// A picture large enough that a budget of any number of pairs is exact in single precision.
inline constexpr gpu::uint kPictureCost = 1u << 24;

// What the choice reads about an eye's tiles: errors and costs as left by resample and weigh, or the
// history's.
struct Tiles {
    glm::uvec2 size{0, 0};
    std::vector<gpu::uint> kinds, errors, costs;
    std::vector<gpu::HistoryTile> history;

    explicit Tiles(glm::uvec2 size_tiles)
        : size(size_tiles), kinds(std::size_t{size.x} * size.y, 0), errors(count(), 0), costs(count(), 100) {}
    [[nodiscard]] std::size_t count() const { return kinds.size(); }
};

struct How {
    double budget = 0.0;                    // a share of the cost
    gpu::uint picture_cost = kPictureCost;  // if it has no history
    bool predicted = true, moves = true;
    Eye seen = {};  // every eye, if its gaze is known
    std::optional<Gaze> gaze = {};
    double error_bound = 0.0;
    gpu::uint most_cost = gpu::kMaxItems;
};
inline How withCost(std::uint64_t budget_cost) {
    return {.budget = static_cast<double>(budget_cost) / kPictureCost};
}

// What the device makes of an eye's tiles, with the list sorted.
struct Chosen {
    std::vector<gpu::uint> kinds, errors, costs, prices, bins, list, mask;
    std::vector<gpu::HistoryTile> history;
    gpu::WarpCounters counters;
    gpu::ListState masked_tiles, masked_visible;
};

// price and select, for one eye, or for two that share a budget.
inline std::vector<Chosen> chooseOnDevice(Gpu& gpu, const std::vector<Tiles>& eyes, const How& how) {
    struct Buffers {
        Buffer kinds, costs, errors, prices, list, mask, history;
    };
    const bool has_history = !eyes[0].history.empty();
    std::vector<Buffers> buffers;
    std::vector<gpu::TargetState> targets;
    std::size_t most_tiles = 0;
    for (const Tiles& eye : eyes) {
        most_tiles = std::max(most_tiles, eye.count());
        const std::vector<gpu::uint> zeros(eye.count(), 0);
        const Buffers& of = buffers.emplace_back(Buffers{
            gpu.upload("kinds", eye.kinds), gpu.upload("costs", eye.costs), gpu.upload("errors", eye.errors),
            gpu.upload("prices", zeros), gpu.upload("list", zeros),
            gpu.upload("mask", std::vector<gpu::uint>(std::size_t{(eye.size.x + 31) / 32} * eye.size.y, 0)),
            gpu.upload("history", eye.history)});
        gpu::TargetState& target = targets.emplace_back();
        target.tile_kinds = at(of.kinds);
        target.tile_costs = at(of.costs);
        target.tile_errors = at(of.errors);
        target.tile_prices = at(of.prices);
        target.tile_list = at(of.list);
        target.tile_mask = at(of.mask);
        target.history_tiles = at(of.history);
        target.area = 1.0f;
        target.warp.size_px = how.gaze ? how.seen.size_px : 16u * eye.size;
        target.warp.size_tiles = eye.size;
        target.warp.budget = static_cast<float>(how.budget);
        target.warp.error_bound = static_cast<float>(how.error_bound);
        target.warp_counters.moves = how.moves && !has_history ? 1 : 0;
        target.warp_counters.picture_cost = how.moves && !has_history ? how.picture_cost : 0;
        if (how.gaze) { target.counters.gaze = eyeGazeOf(*how.gaze, how.seen.intrinsics); }
    }
    const Buffer bins = gpu.upload("bins", std::vector<gpu::uint>(gpu::kPriceBins, 0)),
                 states = gpu.upload("targets", targets),
                 visible = gpu.upload("visible", std::vector{makeList(kVisible)});
    const auto first = states.address<gpu::TargetState>();
    const auto first_list = states.address<gpu::ListState>(offsetof(gpu::TargetState, chosen_tiles));
    const Kernel &price = gpu.kernel(PriceKernel{.foveated = how.gaze.has_value(), .history = has_history}),
                 &select = gpu.kernel(SelectKernel{.predicted = how.predicted, .history = has_history});
    gpu.run([&](Commands& commands) {
        const auto groups = static_cast<std::uint32_t>((most_tiles + gpu::kWarpGroup - 1) / gpu::kWarpGroup),
                   count = static_cast<std::uint32_t>(eyes.size());
        if (how.predicted) {
            commands.dispatch(price, gpu::PricePass{first, first_list, at(bins), how.most_cost}, groups, 1,
                              count);
        }
        commands.dispatch(select, gpu::SelectPass{first, first_list, at(visible), 1}, groups, 1, count);
    });
    targets = gpu.readBack<gpu::TargetState>(states, eyes.size());
    std::vector<Chosen> chosen;
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const Buffers& of = buffers[e];
        const std::size_t count = eyes[e].count();
        const auto read = [&](const Buffer& buffer) { return gpu.readBack<gpu::uint>(buffer, count); };
        chosen.push_back(
            {read(of.kinds), read(of.errors), read(of.costs), read(of.prices),
             gpu.readBack<gpu::uint>(bins, gpu::kPriceBins),
             gpu.readBack<gpu::uint>(of.list, std::min<std::size_t>(targets[e].chosen_tiles.count, count)),
             gpu.readBack<gpu::uint>(of.mask, std::size_t{(eyes[e].size.x + 31) / 32} * eyes[e].size.y),
             gpu.readBack<gpu::HistoryTile>(of.history, eyes[e].history.size()), targets[e].warp_counters,
             targets[e].chosen_tiles, targets[e].chosen_visible});
        std::ranges::sort(chosen.back().list);
    }
    return chosen;
}

}  // namespace binosplat::test
