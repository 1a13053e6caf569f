// Facts about 8g: the worst tiles up to a budget, held to std::sort, and the lists and prefix sums that patching goes by.
#include "tests/stereo_cases.h"
#include "tests/stereo_stages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace binosplat;
using reference::TileKind;
using test::Gpu;
using test::StereoOnDevice;

namespace {

constexpr std::size_t kVisible = 12345;

// A strip of `tiles` tiles, of which at most `budget_tiles` may be chosen.
StereoOnDevice makeStrip(Gpu& gpu, std::size_t tiles, std::size_t budget_tiles) {
    gpu::StereoView view{};
    view.size_px = {16 * tiles, 1};
    view.size_tiles = {tiles, 1};
    view.budget_tiles = static_cast<gpu::uint>(budget_tiles);
    return StereoOnDevice(gpu, view, {}, {}, {});
}

// That the lists say what the kinds say.
void checkLists(const StereoOnDevice::Selected& selected, const std::vector<gpu::uint>& kinds) {
    std::vector<gpu::uint> list, before;
    for (std::size_t t = 0; t < kinds.size(); ++t) {
        before.push_back(static_cast<gpu::uint>(list.size()));
        if (kinds[t] != 0) { list.push_back(static_cast<gpu::uint>(t)); }
    }
    before.push_back(static_cast<gpu::uint>(list.size()));
    CHECK(selected.tile_list == list);
    CHECK(selected.tiles_before == before);
    CHECK(selected.masked_tiles.count == list.size());
    CHECK(selected.masked_tiles.per_tile.x * selected.masked_tiles.per_tile.y >= list.size());
    // Where no tile is rendered again, no splat is looked at.
    CHECK(selected.masked_visible.count == (list.empty() ? 0 : kVisible));
    CHECK(selected.masked_visible.per_item.x == (list.empty() ? 0 : (kVisible + gpu::kGroupSize - 1) / gpu::kGroupSize));
}

void checkSelection(Gpu& gpu, const std::vector<gpu::uint>& errors, std::size_t budget_tiles) {
    CAPTURE(errors.size());
    CAPTURE(budget_tiles);
    StereoOnDevice device = makeStrip(gpu, errors.size(), budget_tiles);
    device.writeTileErrors(errors);
    const auto selected = device.select(true, kVisible);
    const auto kinds = device.readTileKinds();

    std::vector<std::size_t> order(errors.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto limited = [&](std::size_t t) { return std::min(errors[t], 0x7fffffffu); };  // where sums stop growing
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return limited(a) != limited(b) ? limited(a) > limited(b) : a < b; });
    std::vector<gpu::uint> expected(errors.size(), 0);
    for (std::size_t i = 0; i < std::min(budget_tiles, order.size()); ++i) {
        expected[order[i]] = errors[order[i]] > 0 ? gpu::kTilePredicted : 0;
    }
    CHECK(kinds == expected);
    checkLists(selected, expected);
    CHECK(device.readCounters().predicted_tiles == std::count(expected.begin(), expected.end(), gpu::kTilePredicted));

    std::vector<double> twin_errors;
    for (std::size_t t = 0; t < errors.size(); ++t) { twin_errors.push_back(limited(t)); }
    std::vector<TileKind> twin_kinds(errors.size(), TileKind::kNone);
    reference::select(twin_kinds, twin_errors, budget_tiles);
    CHECK(test::kindsOf(twin_kinds) == expected);
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "8g_select chooses as a sort does, whatever the number of tiles, with budgets of none, one and all") {
    std::mt19937 random(7);
    for (const std::size_t tiles : {1, 2, 31, 255, 256, 257, 512, 513, 1000}) {
        std::vector<gpu::uint> errors(tiles);
        for (gpu::uint& error : errors) { error = static_cast<gpu::uint>(random()) >> (1 + random() % 31); }
        for (const std::size_t budget : {std::size_t{0}, std::size_t{1}, tiles / 7, tiles - 1, tiles, 2 * tiles}) {
            checkSelection(*this, errors, budget);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "8g_select takes the first of equal tiles, and none without an error") {
    std::mt19937 random(8);
    for (const unsigned values : {1u, 2u, 5u}) {
        std::vector<gpu::uint> errors(600);
        for (gpu::uint& error : errors) { error = static_cast<gpu::uint>(random() % (values + 1)) << 13; }
        for (const std::size_t budget : {1, 90, 255, 256, 257, 599, 600}) { checkSelection(*this, errors, budget); }
    }
    checkSelection(*this, std::vector<gpu::uint>(300, 0), 100);
    checkSelection(*this, std::vector<gpu::uint>(300, 42), 100);
}

TEST_CASE_FIXTURE(Gpu, "8g_select tells errors apart in every byte, and takes sums that stopped growing for equal") {
    std::vector<gpu::uint> errors;
    for (unsigned bit = 0; bit < 31; ++bit) { errors.insert(errors.end(), {1u << bit, (1u << bit) + 1, (2u << bit) - 1}); }
    std::shuffle(errors.begin(), errors.end(), std::mt19937(9));
    for (const std::size_t budget : {1, 7, 46, 93}) { checkSelection(*this, errors, budget); }
    checkSelection(*this, {5, 0x7fffffffu, 0xffffffffu, 0x80000000u, 0x7ffffffeu, 0x90000000u}, 3);
}

TEST_CASE_FIXTURE(Gpu, "8g_select lists the tiles that others have marked, and forgets no kind") {
    std::mt19937 random(10);
    for (const std::size_t tiles : {1, 256, 700}) {
        for (const unsigned share : {0u, 3u, 50u, 100u}) {
            std::vector<gpu::uint> kinds(tiles, 0);
            for (gpu::uint& kind : kinds) { kind = random() % 100 < share ? 1 + static_cast<gpu::uint>(random() % 2) : 0; }
            StereoOnDevice device = makeStrip(*this, tiles, 1);
            device.writeTileKinds(kinds);
            const auto selected = device.select(false, kVisible);
            CHECK(device.readTileKinds() == kinds);
            checkLists(selected, kinds);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "8g_select renders what the dominant eye cannot see whatever the budget, and spends the budget on the rest") {
    // Eyes of a headset: 10 degrees wider outwards than inwards, or canted by 8.
    const glm::uvec2 size_px(160, 96);
    const double inwards = std::tan(0.6), outwards = std::tan(0.6 + 10.0 * glm::pi<double>() / 180.0);
    const double focal_px = size_px.x / (inwards + outwards);
    const auto eyeOf = [&](double principal_px, double cant_rad, double x) {
        return Eye{{glm::angleAxis(cant_rad, glm::dvec3(0.0, 1.0, 0.0)), {x, 0.0, 0.0}}, {focal_px, focal_px, principal_px, 48.0}, size_px};
    };
    const double left_px = focal_px * outwards, right_px = focal_px * inwards;
    const reference::EyePair pairs[] = {{eyeOf(left_px, 0.0, 0.0), eyeOf(right_px, 0.0, 0.064)},
                                        {eyeOf(80.0, -0.07, 0.0), eyeOf(80.0, 0.07, 0.064)},
                                        {eyeOf(80.0, 0.0, 0.0), eyeOf(80.0, 0.0, 0.064)}};
    const std::size_t least_unseen[] = {6, 6, 0};
    std::mt19937 random(11);
    for (std::size_t p = 0; p < 3; ++p) {
        CAPTURE(p);
        std::vector<gpu::uint> errors(60);
        for (gpu::uint& error : errors) { error = 1 + static_cast<gpu::uint>(random() % 100000); }
        for (const std::size_t budget : {std::size_t{0}, std::size_t{9}, std::size_t{60}}) {
            StereoSettings settings;
            settings.budget = static_cast<double>(budget) / 60.0 + 1e-9;
            StereoOnDevice device(*this, stereoViewOf(pairs[p].source, pairs[p].target, settings), {}, {}, {});
            device.writeTileErrors(errors);
            const auto selected = device.select(true, kVisible);
            const std::vector<gpu::uint> kinds = device.readTileKinds();
            std::vector<TileKind> expected = reference::markUnseen(pairs[p], static_cast<int>(settings.gap_px));
            const auto unseen = static_cast<std::size_t>(std::count(expected.begin(), expected.end(), TileKind::kEdge));
            reference::select(expected, std::vector<double>(errors.begin(), errors.end()), budget);
            CHECK(kinds == test::kindsOf(expected));
            checkLists(selected, kinds);
            // The affiliated eye's outer columns, and not all of its tiles.
            CHECK(unseen >= least_unseen[p]);
            CHECK(unseen <= (p == 2 ? 0u : 30u));
            CHECK(device.readCounters().edge_tiles == unseen);
            CHECK(device.readCounters().predicted_tiles == std::min(budget, 60 - unseen));
        }
    }
}
