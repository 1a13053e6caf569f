// price and select on the device, of tiles that a test makes up.
#pragma once

#include "engine/passes/past_passes.h"
#include "tests/engine/passes/past_stages.h"

namespace binosplat::test {

inline constexpr std::size_t kVisible = 12345;
// Of a whole picture, so that a budget of any number of pairs is exact in single precision.
inline constexpr gpu::uint kPictureCost = 1u << 24;

// What the choice reads of an eye's tiles: errors and costs as resample and weigh leave them, or their past.
struct Tiles {
    glm::uvec2 size{0, 0};
    std::vector<gpu::uint> kinds, errors, costs;
    std::vector<gpu::PastTile> past;

    explicit Tiles(glm::uvec2 size_tiles)
        : size(size_tiles), kinds(std::size_t{size.x} * size.y, 0), errors(count(), 0), costs(count(), 100) {}
    [[nodiscard]] std::size_t count() const { return kinds.size(); }
};

struct How {
    double budget = 0.0;                    // a share of the cost
    gpu::uint picture_cost = kPictureCost;  // without a past
    bool predicted = true, moves = true;
    Eye seen = {};  // all eyes are like this one, if it is known where they look
    std::optional<Gaze> gaze = {};
    double error_bound = 0.0;
    gpu::uint most_cost = gpu::kMaxItems;
};
inline How withCost(std::uint64_t budget_cost) { return {.budget = static_cast<double>(budget_cost) / kPictureCost}; }

// What the device makes of an eye's tiles, those of the list sorted.
struct Chosen {
    std::vector<gpu::uint> kinds, errors, costs, prices, bins, list, mask;
    std::vector<gpu::PastTile> past;
    gpu::WarpCounters counters;
    gpu::ListState masked_tiles, masked_visible;
};

// price and select, of one eye or of two under one budget.
inline std::vector<Chosen> chooseOnDevice(Gpu& gpu, const std::vector<Tiles>& eyes, const How& how) {
    struct Buffers {
        Buffer view, kinds, costs, errors, prices, list, mask, lists, counters, past;
        std::uint32_t groups;
    };
    const bool has_past = !eyes[0].past.empty();
    std::vector<Buffers> buffers;
    for (const Tiles& eye : eyes) {
        gpu::WarpView view{};
        view.size_px = how.gaze ? how.seen.size_px : 16u * eye.size;
        view.size_tiles = eye.size;
        view.budget = static_cast<float>(how.budget);
        view.error_bound = static_cast<float>(how.error_bound);
        gpu::WarpCounters counters{};
        counters.moves = how.moves && !has_past ? 1 : 0;
        counters.picture_cost = how.moves && !has_past ? how.picture_cost : 0;
        const std::vector<gpu::uint> zeros(eye.count(), 0);
        buffers.push_back({gpu.upload("view", std::vector{view}), gpu.upload("kinds", eye.kinds), gpu.upload("costs", eye.costs),
                           gpu.upload("errors", eye.errors), gpu.upload("prices", zeros), gpu.upload("list", zeros),
                           gpu.upload("mask", std::vector<gpu::uint>(std::size_t{(eye.size.x + 31) / 32} * eye.size.y, 0)),
                           gpu.upload("lists", std::vector{makeList(kVisible), gpu::ListState{}, gpu::ListState{}}),
                           gpu.upload("counters", std::vector{counters}), gpu.upload("past", eye.past),
                           static_cast<std::uint32_t>((eye.count() + gpu::kWarpGroup - 1) / gpu::kWarpGroup)});
    }
    const Buffer bins = gpu.upload("bins", std::vector<gpu::uint>(gpu::kPriceBins, 0));
    const auto listAt = [](const Buffers& of, std::uint64_t i) { return of.lists.address<gpu::ListState>(i * sizeof(gpu::ListState)); };
    const Kernel &price = gpu.kernel(PriceKernel{.foveated = how.gaze.has_value(), .past = has_past}),
                 &select = gpu.kernel(SelectKernel{.predicted = how.predicted, .past = has_past});
    const auto budget = buffers[0].counters.address<gpu::WarpCounters>();
    gpu.run([&](Commands& commands) {
        for (std::size_t e = 0; e < buffers.size() && how.predicted; ++e) {
            const Buffers& of = buffers[e];
            const gpu::PricePass pass{.warp = of.view.address<gpu::WarpView>(),
                                      .tile_kinds = of.kinds.address<gpu::uint>(),
                                      .tile_costs = of.costs.address<gpu::uint>(),
                                      .tile_errors = of.errors.address<gpu::uint>(),
                                      .tile_prices = of.prices.address<gpu::uint>(),
                                      .price_bins = bins.address<gpu::uint>(),
                                      .masked_tiles = listAt(of, 1),
                                      .counters = of.counters.address<gpu::WarpCounters>(),
                                      .budget = budget,
                                      .past_tiles = has_past ? of.past.address<gpu::PastTile>() : gpu::DeviceAddress<gpu::PastTile>{},
                                      .is_last = e + 1 == buffers.size() ? 1u : 0u,
                                      .area = 1.0f,
                                      .most_cost = how.most_cost,
                                      .gaze = how.gaze ? eyeGazeOf(*how.gaze, how.seen.intrinsics) : gpu::EyeGaze{}};
            commands.dispatch(price, pass, of.groups, 1);
        }
        for (const Buffers& of : buffers) {
            const gpu::SelectPass pass{.warp = of.view.address<gpu::WarpView>(),
                                       .tile_kinds = of.kinds.address<gpu::uint>(),
                                       .tile_prices = of.prices.address<gpu::uint>(),
                                       .tile_list = of.list.address<gpu::uint>(),
                                       .tile_mask = of.mask.address<gpu::uint>(),
                                       .tile_costs = of.costs.address<gpu::uint>(),
                                       .visible = listAt(of, 0),
                                       .masked_tiles = listAt(of, 1),
                                       .masked_visible = listAt(of, 2),
                                       .counters = of.counters.address<gpu::WarpCounters>(),
                                       .budget = budget};
            commands.dispatch(select, pass, of.groups, 1);
        }
    });
    std::vector<Chosen> chosen;
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const Buffers& of = buffers[e];
        const std::size_t count = eyes[e].count();
        const auto read = [&](const Buffer& buffer) { return gpu.readBack<gpu::uint>(buffer, count); };
        const auto states = gpu.readBack<gpu::ListState>(of.lists, 3);
        chosen.push_back({read(of.kinds), read(of.errors), read(of.costs), read(of.prices), gpu.readBack<gpu::uint>(bins, gpu::kPriceBins),
                          gpu.readBack<gpu::uint>(of.list, std::min<std::size_t>(states[1].count, count)),
                          gpu.readBack<gpu::uint>(of.mask, std::size_t{(eyes[e].size.x + 31) / 32} * eyes[e].size.y),
                          gpu.readBack<gpu::PastTile>(of.past, eyes[e].past.size()), gpu.readBack<gpu::WarpCounters>(of.counters, 1)[0],
                          states[1], states[2]});
        std::ranges::sort(chosen.back().list);
    }
    return chosen;
}

}  // namespace binosplat::test
