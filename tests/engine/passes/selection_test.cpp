// Facts about price and select: prices, the dearest errors up to a budget, held to a plain sort, and the lists and masks that patching goes
// by.
#include "tests/engine/passes/stereo_cases.h"
#include "tests/engine/passes/stereo_stages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <random>

TEST_SUITE_BEGIN("selection");

namespace selection_test {

using namespace binosplat;
using reference::TileKind;
using test::Gpu;
using test::StereoOnDevice;

namespace {

constexpr std::size_t kVisible = 12345;
// Of a whole picture, so that a budget of any number of pairs is exact in single precision.
constexpr gpu::uint kPictureCost = 1u << 24;

// Tiles as resample and weigh leave them.
struct Tiles {
    glm::uvec2 size{0, 0};
    std::vector<gpu::uint> kinds, errors, costs;

    explicit Tiles(glm::uvec2 size_tiles) : size(size_tiles), kinds(count(), 0), errors(count(), 0), costs(count(), 100) {}
    [[nodiscard]] std::size_t count() const { return std::size_t{size.x} * size.y; }
    // Above this, newcomers's sums stop growing.
    [[nodiscard]] gpu::uint errorOf(std::size_t t) const { return kinds[t] == 0 ? std::min(errors[t], 0x7fffffffu) : 0; }
    // -1: none. Plainly as the device does it: a float's exponent and four bits.
    [[nodiscard]] int binOf(std::size_t t) const {
        if (errorOf(t) == 0) { return -1; }
        const float per_pair = static_cast<float>(errorOf(t)) / static_cast<float>(costs[t]);
        return std::clamp(static_cast<int>(std::bit_cast<gpu::uint>(per_pair) >> 19) - (104 << 4), 0, 1023);
    }
    [[nodiscard]] std::uint64_t costOfErrors() const {
        std::uint64_t cost = 0;
        for (std::size_t t = 0; t < count(); ++t) { cost += errorOf(t) > 0 ? costs[t] : 0; }
        return cost;
    }
};

// Division may be off by a few roundings, so that prices are not as good as on the border of two bins.
bool isOnBorder(gpu::uint error, gpu::uint cost) {
    if (error == 0) { return false; }
    const double per_pair = static_cast<double>(error) / cost;
    const double sixteenths = std::ldexp(per_pair, 4 - std::ilogb(per_pair));
    return std::abs(sixteenths - std::round(sixteenths)) < 1e-4;
}

// Random errors and costs of all sizes, some tiles marked.
Tiles drawTiles(glm::uvec2 size, std::mt19937& random, unsigned marked_percent = 10) {
    Tiles tiles(size);
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        if (random() % 100 < marked_percent) { tiles.kinds[t] = 1 + static_cast<gpu::uint>(random() % 5); }
        do {
            tiles.errors[t] = random() % 8 == 0 ? 0 : static_cast<gpu::uint>(random()) >> (1 + random() % 30);
            tiles.costs[t] = 16 + static_cast<gpu::uint>(random() % (random() % 2 == 0 ? 50 : 5000));
        } while (isOnBorder(tiles.errors[t], tiles.costs[t]));
    }
    return tiles;
}

StereoOnDevice toDevice(Gpu& gpu, const Tiles& tiles, std::uint64_t budget_cost, gpu::uint picture_cost = kPictureCost) {
    gpu::WarpView view{};
    view.size_px = {16 * tiles.size.x, 1};
    view.size_tiles = tiles.size;
    view.budget = static_cast<float>(static_cast<double>(budget_cost) / kPictureCost);
    StereoOnDevice device(gpu, view, {}, {});
    device.writeTileKinds(tiles.kinds);
    device.writeTileErrors(tiles.errors);
    device.writeTileCosts(tiles.costs);
    gpu::WarpCounters counters{};
    counters.moves = 1;
    counters.picture_cost = picture_cost;
    device.writeCounters(counters);
    return device;
}

// That the lists and the mask say what the kinds say.
void checkLists(const StereoOnDevice::Selected& selected, const std::vector<gpu::uint>& kinds, glm::uvec2 size) {
    std::vector<gpu::uint> list;
    std::vector<std::uint8_t> marked;
    for (std::size_t t = 0; t < kinds.size(); ++t) {
        marked.push_back(kinds[t] != 0 && kinds[t] != gpu::kTileHidden ? 1 : 0);
        if (marked.back() != 0) { list.push_back(static_cast<gpu::uint>(t)); }
    }
    CHECK(selected.tile_list == list);
    CHECK(selected.tile_mask == test::maskOf(marked, size));
    CHECK(selected.masked_tiles.needed == list.size());
    CHECK(selected.masked_tiles.count == list.size());
    CHECK(selected.masked_tiles.per_item.x * selected.masked_tiles.per_item.y * gpu::kGroupSize >= list.size());
    // Where no tile is rendered, no splat is looked at.
    CHECK(selected.masked_visible.count == (list.empty() ? 0 : kVisible));
    CHECK(selected.masked_visible.per_item.x == (list.empty() ? 0 : (kVisible + gpu::kGroupSize - 1) / gpu::kGroupSize));
}

void checkPrices(StereoOnDevice& device, const Tiles& tiles) {
    const auto prices = device.readTilePrices(), bins = device.readBins();
    std::vector<gpu::uint> expected, expected_bins(gpu::kPriceBins, 0);
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        const int bin = tiles.binOf(t);
        expected.push_back(bin < 0 ? 0 : static_cast<gpu::uint>(bin) << 22 | tiles.costs[t]);
        if (bin >= 0) { expected_bins[static_cast<std::size_t>(bin)] += tiles.costs[t]; }
    }
    CHECK(prices == expected);
    CHECK(bins == expected_bins);
}

// Passes price and select against a sort, and against the twin.
void checkSelection(Gpu& gpu, const Tiles& tiles, std::uint64_t budget_cost) {
    CAPTURE(tiles.count());
    CAPTURE(budget_cost);
    StereoOnDevice device = toDevice(gpu, tiles, budget_cost);
    device.price();
    checkPrices(device, tiles);
    const auto selected = device.select(true, kVisible);

    std::vector<std::size_t> order(tiles.count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(
        order, [&](std::size_t a, std::size_t b) { return tiles.binOf(a) != tiles.binOf(b) ? tiles.binOf(a) > tiles.binOf(b) : a < b; });
    std::vector<gpu::uint> expected = tiles.kinds;
    std::uint64_t spent = 0;
    for (const std::size_t t : order) {
        if (tiles.binOf(t) < 0) { break; }
        spent += tiles.costs[t];
        if (spent > budget_cost) { break; }
        expected[t] = gpu::kTilePredicted;
    }
    CHECK(device.readTileKinds() == expected);
    checkLists(selected, expected, tiles.size);
    const gpu::WarpCounters counters = device.readCounters();
    CHECK(counters.predicted_tiles == std::ranges::count(expected, gpu::kTilePredicted));
    CHECK(counters.edge_tiles == std::ranges::count(expected, gpu::kTileEdge));
    CHECK(counters.cheap_tiles == std::ranges::count(expected, gpu::kTileCheap));
    CHECK(selected.masked_tiles.groups_done == 0);
    std::uint64_t chosen_cost = 0;
    for (const gpu::uint t : selected.tile_list) { chosen_cost += tiles.costs[t]; }
    CHECK(counters.chosen_cost == chosen_cost);

    std::vector<double> twin_errors;
    for (const gpu::uint error : tiles.errors) { twin_errors.push_back(error / static_cast<double>(gpu::kErrorSteps)); }
    const std::vector<std::uint64_t> twin_costs(tiles.costs.begin(), tiles.costs.end());
    std::vector<TileKind> twin_kinds = test::kindsOf(tiles.kinds);
    reference::select(twin_kinds, reference::price(twin_kinds, twin_errors, twin_costs), twin_costs, budget_cost);
    CHECK(test::kindsOf(twin_kinds) == expected);
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "price and select choose as a sort does, over any number of tiles, with budgets of none, one and all") {
    std::mt19937 random(7);
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(31, 1), glm::uvec2(127, 1), glm::uvec2(32, 4), glm::uvec2(3, 43),
                                  glm::uvec2(33, 31), glm::uvec2(100, 50)}) {
        const Tiles tiles = drawTiles(size, random);
        const std::uint64_t all = tiles.costOfErrors();
        for (const std::uint64_t budget :
             {std::uint64_t{0}, std::uint64_t{15}, std::uint64_t{40}, all / 7, all / 2, all - 1, all, all + 1, 2 * all + 1000}) {
            if (all > 0) { checkSelection(*this, tiles, std::min<std::uint64_t>(budget, kPictureCost - 1)); }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "select takes the first of tiles of one price, to the last pair of the budget, and none without an error") {
    std::mt19937 random(8);
    for (const glm::uvec2 size : {glm::uvec2(20, 1), glm::uvec2(30, 20)}) {
        for (const unsigned values : {1u, 2u, 5u}) {
            Tiles tiles(size);
            // A hundred and one steps a pair, however many pairs: all in one bin.
            for (std::size_t t = 0; t < tiles.count(); ++t) {
                tiles.costs[t] = 16 + static_cast<gpu::uint>(random() % 40);
                tiles.errors[t] = static_cast<gpu::uint>(random() % (values + 1)) * 101 * tiles.costs[t];
            }
            const std::uint64_t all = tiles.costOfErrors();
            for (std::uint64_t budget = 0; budget <= all; budget += 1 + all / 13) { checkSelection(*this, tiles, budget); }
            // To each side of where one more fits.
            std::uint64_t first_three = 0;
            for (std::size_t t = 0, n = 0; n < 3; ++t) {
                if (tiles.errors[t] > 0) { first_three += tiles.costs[t], ++n; }
            }
            for (const std::uint64_t budget : {first_three - 1, first_three, first_three + 1, all - 1, all}) {
                checkSelection(*this, tiles, budget);
            }
        }
    }
    Tiles none({300, 1});
    checkSelection(*this, none, 1000);
    none.errors.assign(300, 4300);
    checkSelection(*this, none, 1999);
    checkSelection(*this, none, 2000);
}

TEST_CASE_FIXTURE(Gpu, "price tells prices apart from the least to the greatest, and takes sums that stopped growing for equal") {
    Tiles tiles({31, 8});
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        const std::size_t bit = t % 31;
        tiles.errors[t] = (1u << bit) | (t / 31 % 2 == 0 ? 0u : (1u << bit) / 3);
        tiles.costs[t] = t / 62 == 0 ? 17 : t / 62 == 1 ? 300 : t / 62 == 2 ? 70001 : gpu::kMaxTileCost - 123456;
        while (isOnBorder(tiles.errors[t], tiles.costs[t])) { ++tiles.errors[t]; }
    }
    for (const std::uint64_t budget : {std::uint64_t{17}, std::uint64_t{1000}, std::uint64_t{200000}, std::uint64_t{10000000}}) {
        checkSelection(*this, tiles, budget);
    }
    Tiles full({6, 1});
    full.errors = {5, 0x7fffffffu, 0xffffffffu, 0x80000000u, 0x7ffffffeu, 0x90000000u};
    for (const std::uint64_t budget : {100, 250, 300, 499, 600}) { checkSelection(*this, full, budget); }
}

TEST_CASE_FIXTURE(Gpu, "select pays from a share of the picture's cost, rounded down") {
    Tiles tiles({10, 1});
    tiles.errors.assign(10, 1000);
    for (const auto& [share, picture_cost, chosen] :
         {std::tuple(0.15, 2000u, 3), std::tuple(0.15, 1999u, 2), std::tuple(0.5, 2000u, 10), std::tuple(1.0, 1000u, 10),
          std::tuple(1.0, 999u, 9), std::tuple(0.0, 2000u, 0), std::tuple(1.0, 4000000000u, 10)}) {
        CAPTURE(share);
        CAPTURE(picture_cost);
        // 0.15 in single precision is a little more than that.
        StereoOnDevice device = toDevice(*this, tiles, 0, picture_cost);
        gpu::WarpView view{};
        view.size_px = {160, 1};
        view.size_tiles = {10, 1};
        view.budget = static_cast<float>(share);
        device.writeView(view);
        device.price();
        device.select(true, kVisible);
        CHECK(device.readCounters().predicted_tiles == static_cast<gpu::uint>(chosen));
    }
}

TEST_CASE_FIXTURE(Gpu, "select lists the tiles that others have marked, and forgets no kind") {
    std::mt19937 random(10);
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(64, 4), glm::uvec2(65, 40)}) {
        for (const unsigned percent : {0u, 3u, 50u, 100u}) {
            const Tiles tiles = drawTiles(size, random, percent);
            StereoOnDevice device = toDevice(*this, tiles, kPictureCost);
            const auto selected = device.select(false, kVisible);
            CHECK(device.readTileKinds() == tiles.kinds);
            checkLists(selected, tiles.kinds, size);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "select renders everything that is shown where nothing is worth moving") {
    std::mt19937 random(12);
    const Tiles tiles = drawTiles({40, 9}, random);
    StereoOnDevice device = toDevice(*this, tiles, 0);
    device.writeCounters({});
    device.price();
    const auto selected = device.select(true, kVisible);
    std::vector<gpu::uint> expected = tiles.kinds;
    std::ranges::replace(expected, 0u, gpu::kTileCheap);
    CHECK(device.readTileKinds() == expected);
    checkLists(selected, expected, tiles.size);
    CHECK(device.readCounters().predicted_tiles == std::ranges::count(expected, gpu::kTilePredicted));
    CHECK(device.readCounters().cheap_tiles == std::ranges::count(expected, gpu::kTileCheap));
}

}  // namespace selection_test
