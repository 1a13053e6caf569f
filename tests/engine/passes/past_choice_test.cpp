// Facts about price and select where tiles have a past: the twin's tiles of both eyes, under one budget.
#include "engine/passes/past_passes.h"
#include "tests/engine/passes/past_stages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

TEST_SUITE_BEGIN("past_choice");

namespace past_choice_test {

using namespace binosplat;
using reference::TileKind;
using test::Gpu;

namespace {

constexpr double kSteps = test::kErrorSteps;

// What the choice reads of the tiles of an eye.
struct Tiles {
    glm::uvec2 size{0, 0};
    std::vector<gpu::PastTile> tiles;
    std::vector<gpu::uint> kinds;
};

Tiles drawTiles(glm::uvec2 size, std::mt19937& random) {
    Tiles drawn{size, {}, {}};
    const auto draw = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
    for (std::uint32_t t = 0; t < size.x * size.y; ++t) {
        gpu::PastTile tile{};
        tile.cost = static_cast<gpu::uint>(random() % 3 == 0 ? random() % 5000 : random() % 40);
        tile.age = static_cast<gpu::uint>(random() % (random() % 4 == 0 ? 500 : 6));
        tile.growth = random() % 3 == 0 ? 0.0f : 0.02f * draw();
        for (int q = 0; q < 4; ++q) {
            tile.errors[q] = random() % 4 == 0 ? 0.0f : 0.2f * std::pow(draw(), 6.0f);
            tile.grown[q] = random() % 4 == 0 ? 0 : static_cast<gpu::uint>(random()) >> (4 + random() % 28);
        }
        if (random() % 8 == 0) {  // as it is before a still head
            tile.growth = 0.0f;
            tile.errors = gpu::vec4(0.0f);
            tile.grown = gpu::uvec4(0);
        }
        drawn.tiles.push_back(tile);
        drawn.kinds.push_back(random() % 12 == 0 ? gpu::kTileHidden : 0);
    }
    return drawn;
}

// price and select on the device, of one or two eyes.
struct Choice {
    std::vector<std::vector<gpu::uint>> kinds, errors, costs, lists, masks;
    std::vector<std::vector<gpu::PastTile>> tiles;
    std::vector<gpu::WarpCounters> counters;
};

Choice chooseOnDevice(Gpu& gpu, const std::vector<Tiles>& eyes, float budget, const std::vector<Eye>& seen,
                      const std::optional<Gaze>& gaze) {
    struct Buffers {
        Buffer view, kinds, costs, errors, prices, list, mask, lists, counters, tiles;
        std::size_t count, mask_words;
    };
    std::vector<Buffers> buffers;
    for (const Tiles& eye : eyes) {
        const std::size_t count = eye.tiles.size(), mask_words = std::size_t{(eye.size.x + 31) / 32} * eye.size.y;
        gpu::WarpView view{};
        view.size_tiles = eye.size;
        view.budget = budget;
        buffers.push_back({gpu.upload("view", std::vector{view}), gpu.upload("kinds", eye.kinds), gpu.allocate<gpu::uint>("costs", count),
                           gpu.allocate<gpu::uint>("errors", count), gpu.allocate<gpu::uint>("prices", count),
                           gpu.allocate<gpu::uint>("list", count), gpu.upload("mask", std::vector<gpu::uint>(mask_words, 0)),
                           gpu.upload("lists", std::vector{test::makeList(777), gpu::ListState{}, gpu::ListState{}}),
                           gpu.upload("counters", std::vector{gpu::WarpCounters{}}), gpu.upload("tiles", eye.tiles), count, mask_words});
    }
    const Buffer bins = gpu.upload("bins", std::vector<gpu::uint>(gpu::kPriceBins, 0));
    const auto listAt = [](const Buffers& of, std::uint64_t i) { return of.lists.address<gpu::ListState>(i * sizeof(gpu::ListState)); };
    const auto groups = [](const Buffers& of) { return static_cast<std::uint32_t>((of.count + gpu::kWarpGroup - 1) / gpu::kWarpGroup); };
    const Kernel &price = gpu.kernel(PriceKernel{.foveated = gaze.has_value(), .past = true}),
                 &select = gpu.kernel(SelectKernel{.predicted = true, .past = true});
    gpu.run([&](Commands& commands) {
        for (std::size_t e = 0; e < buffers.size(); ++e) {
            const Buffers& of = buffers[e];
            commands.dispatch(price,
                              gpu::PricePass{.warp = of.view.address<gpu::WarpView>(),
                                             .tile_kinds = of.kinds.address<gpu::uint>(),
                                             .tile_costs = of.costs.address<gpu::uint>(),
                                             .tile_errors = of.errors.address<gpu::uint>(),
                                             .tile_prices = of.prices.address<gpu::uint>(),
                                             .price_bins = bins.address<gpu::uint>(),
                                             .masked_tiles = listAt(of, 1),
                                             .counters = of.counters.address<gpu::WarpCounters>(),
                                             .budget = buffers[0].counters.address<gpu::WarpCounters>(),
                                             .past_tiles = of.tiles.address<gpu::PastTile>(),
                                             .is_last = e + 1 == buffers.size() ? 1u : 0u,
                                             .area = 1.0f,
                                             .gaze = gaze ? eyeGazeOf(*gaze, seen[e].intrinsics) : gpu::EyeGaze{}},
                              groups(of), 1);
        }
        for (const Buffers& of : buffers) {
            commands.dispatch(select,
                              gpu::SelectPass{.warp = of.view.address<gpu::WarpView>(),
                                              .tile_kinds = of.kinds.address<gpu::uint>(),
                                              .tile_prices = of.prices.address<gpu::uint>(),
                                              .tile_list = of.list.address<gpu::uint>(),
                                              .tile_mask = of.mask.address<gpu::uint>(),
                                              .tile_costs = of.costs.address<gpu::uint>(),
                                              .visible = listAt(of, 0),
                                              .masked_tiles = listAt(of, 1),
                                              .masked_visible = listAt(of, 2),
                                              .counters = of.counters.address<gpu::WarpCounters>(),
                                              .budget = buffers[0].counters.address<gpu::WarpCounters>()},
                              groups(of), 1);
        }
    });
    Choice choice;
    for (const Buffers& of : buffers) {
        choice.kinds.push_back(gpu.readBack<gpu::uint>(of.kinds, of.count));
        choice.errors.push_back(gpu.readBack<gpu::uint>(of.errors, of.count));
        choice.costs.push_back(gpu.readBack<gpu::uint>(of.costs, of.count));
        choice.tiles.push_back(gpu.readBack<gpu::PastTile>(of.tiles, of.count));
        choice.masks.push_back(gpu.readBack<gpu::uint>(of.mask, of.mask_words));
        choice.counters.push_back(gpu.readBack<gpu::WarpCounters>(of.counters, 1)[0]);
        const std::size_t listed = gpu.readBack<gpu::ListState>(of.lists, 3)[1].count;
        choice.lists.push_back(gpu.readBack<gpu::uint>(of.list, std::min(listed, of.count)));
        std::ranges::sort(choice.lists.back());
    }
    return choice;
}

// A quotient on the border of two prices may be rounded to either.
bool isOnBorder(double error, double cost) {
    const double steps = std::floor(error * kSteps);
    if (steps <= 0.0) { return false; }
    const double sixteenths = std::ldexp(steps / cost, 4 - std::ilogb(steps / cost));
    return std::abs(sixteenths - std::round(sixteenths)) < 1e-4;
}

// price, and then select from the errors that the device's price had.
void checkChoice(Gpu& gpu, std::vector<Tiles> eyes, float budget, const std::vector<Eye>& seen = {}, const std::optional<Gaze>& gaze = {}) {
    CAPTURE(budget);
    CAPTURE(eyes.size());
    const Choice got = chooseOnDevice(gpu, eyes, budget, seen, gaze);
    std::vector<std::vector<TileKind>> kinds;
    std::vector<std::vector<std::optional<std::uint32_t>>> prices;
    std::vector<std::vector<std::uint64_t>> costs;
    std::uint64_t picture_cost = 0;
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        std::vector<reference::PastTile> twin;
        for (const gpu::PastTile& tile : eyes[e].tiles) { twin.push_back(test::tileOf(tile)); }
        reference::growErrors(twin);
        kinds.push_back(test::kindsOf(eyes[e].kinds));
        costs.emplace_back();
        std::vector<double> errors;
        std::size_t other = 0;
        for (std::size_t t = 0; t < twin.size(); ++t) {
            const bool hidden = kinds[e][t] == TileKind::kHidden;
            const double error = hidden ? 0.0 : reference::worthOf(twin[t]);
            costs[e].push_back(hidden ? 0 : reference::costOf(twin[t]));
            picture_cost += costs[e][t];
            for (std::size_t q = 0; q < 4; ++q) {
                other +=
                    test::isNear(static_cast<double>(got.tiles[e][t].errors[static_cast<int>(q)]), twin[t].errors[q], 1e-6, 0.0) ? 0 : 1;
            }
            const bool coarse = got.errors[e][t] == gpu::kSeenCoarsely;
            other += coarse || test::isNear(got.errors[e][t] / kSteps, error, 1e-5, 1.0 / kSteps) ? 0 : 1;
            other += (got.errors[e][t] == 0) == (error == 0.0) ? 0 : 1;
            other += got.costs[e][t] == costs[e][t] ? 0 : 1;
            errors.push_back(coarse ? error : got.errors[e][t] / kSteps);
            // A tile that is as good as on a border of prices is nobody's test.
            if (isOnBorder(errors[t], static_cast<double>(std::max<std::uint64_t>(costs[e][t], 1)))) { return; }
        }
        CHECK(other == 0);
        prices.push_back(
            gaze ? reference::price(kinds[e], errors, costs[e], reference::findSeenShares(seen[e], {gaze->direction, gaze->clear_rad}))
                 : reference::price(kinds[e], errors, costs[e]));
    }
    CHECK(got.counters[0].picture_cost == picture_cost);
    std::vector<reference::PricedTiles> priced;
    for (std::size_t e = 0; e < eyes.size(); ++e) { priced.push_back({kinds[e], prices[e], costs[e]}); }
    reference::selectTogether(priced, static_cast<std::uint64_t>(budget * static_cast<float>(picture_cost)));
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const std::vector<gpu::uint> expected = test::kindsOf(kinds[e]);
        if (!gaze) { CHECK(got.kinds[e] == expected); }
        std::size_t other = 0;
        std::vector<gpu::uint> list;
        std::vector<std::uint8_t> marked;
        std::uint64_t spent = 0;
        for (std::size_t t = 0; t < expected.size(); ++t) {
            other += got.kinds[e][t] == expected[t] ? 0 : 1;
            marked.push_back(got.kinds[e][t] == gpu::kTilePredicted ? 1 : 0);
            if (marked.back() == 0) { continue; }
            list.push_back(static_cast<gpu::uint>(t));
            spent += got.costs[e][t];
        }
        CHECK(other <= (gaze ? 1 + expected.size() / 100 : 0));  // what is seen of an error is not known to the last digit
        CHECK(got.lists[e] == list);
        CHECK(got.masks[e] == test::maskOf(marked, eyes[e].size));
        CHECK(got.counters[e].chosen_cost == spent);
        CHECK(got.counters[e].predicted_tiles == list.size());
    }
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "price and select take the twin's tiles of both eyes, for any budget and number of tiles") {
    std::mt19937 random(11);
    for (const auto& [left, right] : {std::pair(glm::uvec2(1, 1), glm::uvec2(1, 1)), std::pair(glm::uvec2(16, 8), glm::uvec2(16, 8)),
                                      std::pair(glm::uvec2(43, 9), glm::uvec2(43, 9)), std::pair(glm::uvec2(20, 17), glm::uvec2(5, 3))}) {
        for (const float budget : {0.0f, 0.001f, 0.1f, 0.3f, 0.9f, 1.0f}) {
            checkChoice(*this, {drawTiles(left, random), drawTiles(right, random)}, budget);
            checkChoice(*this, {drawTiles(left, random)}, budget);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "of equal tiles the first eye's are first, and a tile dearer than the budget has its turn") {
    gpu::PastTile plain{};
    plain.cost = 84;  // 100 with what a tile costs
    plain.age = 1;
    plain.errors = gpu::vec4(0.1f);
    const std::vector<Tiles> equal(2, {{20, 10}, std::vector(200, plain), std::vector<gpu::uint>(200, 0)});
    for (const float budget : {0.0f, 0.01f, 0.4975f, 0.51f, 0.75f, 1.0f}) { checkChoice(*this, equal, budget); }
    const Choice half = chooseOnDevice(*this, equal, 0.75f, {}, {});
    CHECK(half.lists[0].size() == 200);
    CHECK(half.lists[1].size() == 100);
    std::vector<Tiles> dear = equal;
    dear[1].tiles[150].cost = 10000;
    dear[1].tiles[150].age = 60000;
    checkChoice(*this, dear, 0.001f);
    const Choice turn = chooseOnDevice(*this, dear, 0.001f, {}, {});
    CHECK(turn.lists[0].empty());
    CHECK(turn.lists[1] == std::vector<gpu::uint>{150});
}

TEST_CASE_FIXTURE(Gpu, "where it is known where the eyes look, the twin's tiles are those that these see") {
    std::mt19937 random(12);
    Eye eye = test::makeEye({43 * 16, 20 * 16});
    eye.intrinsics = intrinsicsFromFovX(glm::radians(90.0), eye.size_px);
    const Gaze gaze{glm::normalize(glm::dvec3(0.3, -0.1, 1.0)), 0.05};
    for (const float budget : {0.02f, 0.2f, 0.6f, 1.0f}) {
        checkChoice(*this, {drawTiles({43, 20}, random), drawTiles({43, 20}, random)}, budget, {eye, eye}, gaze);
    }
}

}  // namespace past_choice_test
