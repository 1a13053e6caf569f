// Facts about weigh: what a tile costs, which tiles are not worth reprojecting, and whether reprojecting pays
// at all.
#include "tests/engine/passes/stereo_stages.h"

SUITE(weigh) {

using reference::TileKind;
using reference::TileRange;

constexpr std::size_t kVisible = 5000;

std::vector<TileRange> rangesOf(const std::vector<std::uint32_t>& pairs) {
    std::vector<TileRange> ranges;
    std::uint32_t end = 0;
    for (const std::uint32_t count : pairs) {
        ranges.push_back({end, end + count});
        end += count;
    }
    return ranges;
}
std::vector<TileRange> drawRanges(std::size_t tiles, unsigned most_pairs, std::mt19937& random) {
    std::vector<std::uint32_t> pairs(tiles);
    for (std::uint32_t& count : pairs) { count = static_cast<std::uint32_t>(random() % (most_pairs + 1)); }
    return rangesOf(pairs);
}

// The tiles of a case whose costs differ: their middle comes from close to the border of a tile, and rounding
// may put it on either side.
std::size_t checkWeighing(Gpu& gpu, const StereoCase& c, const std::vector<TileRange>& ranges, Rows rows) {
    StereoOnDevice device = toDevice(gpu, c, rows);
    std::vector<TileKind> before(device.tileCount(), TileKind::kNone);
    reference::markHidden(before, c.settings);
    // What the previous frame left does not matter, except for hidden tiles.
    std::vector<gpu::uint> stale = kindsOf(before);
    for (std::size_t t = 0; t < stale.size(); t += 7) {
        stale[t] = stale[t] == gpu::kTileHidden ? stale[t] : gpu::kTilePredicted;
    }
    device.write(device.tile_kinds, stale);
    device.weigh(ranges, !c.settings.source_hidden.empty(), kVisible);
    const reference::Weighed expected = reference::weigh(c.dominant, ranges, c.eyes, c.settings);
    const auto costs = device.read(device.tile_costs), kinds = device.read(device.tile_kinds);
    const gpu::WarpCounters counters = device.readCounters();
    const auto depths = device.read(device.tile_depths), expected_depths = depthsOfTiles(c);
    std::size_t other = 0;
    std::uint64_t picture_cost = 0, saved_cost = 0, moved = 0;
    for (std::size_t t = 0; t < costs.size(); ++t) {
        const bool hidden = expected.kinds[t] == TileKind::kHidden;
        const bool same = hidden || costs[t] == expected.costs[t];
        other += !same;
        if (!hidden) { REQUIRE(depths[t] == expected_depths[t]); }
        // Where nothing is worth moving, select says so of each tile.
        const bool is_left = !expected.moves && kinds[t] == 0 && expected.kinds[t] == TileKind::kCheap;
        if (same && !is_left) { REQUIRE(kinds[t] == static_cast<gpu::uint>(expected.kinds[t])); }
        picture_cost += hidden ? 0 : costs[t];
        moved += kinds[t] == 0;
        if (kinds[t] == 0) { saved_cost += costs[t] - gpu::kTilePairs - c.settings.move_cost; }
    }
    CHECK(these(counters.picture_cost, counters.saved_cost) == these(picture_cost, saved_cost));
    if (other == 0) {
        CHECK(these(counters.picture_cost, counters.saved_cost, (counters.moves == 1)) ==
              these(expected.picture_cost, expected.saved_cost, expected.moves));
    }
    // The passes that move pixels are as large as the picture, or empty.
    const bool moves = counters.moves != 0;
    const glm::uvec2 size_px = c.sizePx(), tiles = tilesOf(size_px);
    const auto sizeOf = [](const gpu::DispatchSize& size) { return glm::uvec3(size.x, size.y, size.z); };
    CHECK(counters.reprojected_tiles == (moves ? moved : 0));
    CHECK(sizeOf(counters.per_pixel_block) == (moves ? glm::uvec3(tiles.x, 2 * tiles.y, 1) : glm::uvec3(0)));
    const bool rows_wanted = moves || std::ranges::count(expected.kinds, TileKind::kHidden) > 0;
    CHECK(sizeOf(counters.per_row) == (rows_wanted ? glm::uvec3(size_px.y, 1, 1) : glm::uvec3(0)));
    const gpu::DispatchSize& visible = counters.per_visible;
    CHECK(visible.x * visible.y * visible.z ==
          (moves ? (kVisible + gpu::kNewcomersBlock - 1) / gpu::kNewcomersBlock : 0));
    // Values to which others add start at zero.
    for (const Buffer* sums : {&device.tile_errors, &device.tile_mask, &device.bins}) {
        CHECK(std::ranges::max(device.read(*sums)) == 0);
    }
    return other;
}

// Identical eyes, and a picture that is infinitely far: every tile weighs its own pairs.
StereoCase makeStill(glm::uvec2 size_px) {
    const Eye eye = makeEye(size_px);
    return computeEmpty({eye, eye});
}

TEST_CASE_FIXTURE(Gpu, "weigh finds the twin's costs and kinds, for any eyes and whatever moving costs") {
    std::size_t other = 0;
    std::mt19937 random(5);
    for (StereoCase c : makeStereoCases()) {
        const std::size_t count = tileCount(c.sizePx());
        const bool looks_outwards =
            c.name.find("canted") != c.name.npos || c.name.find("asym") != c.name.npos;
        for (unsigned way = 0; way < 8; ++way) {
            const bool hidden = way % 2 != 0;
            c.settings.move_cost = std::array{0u, 30u, 90u, 200u}[way / 2];
            INFO(c.name, ", move cost ", c.settings.move_cost, ", hidden ", hidden);
            c.settings.source_hidden = c.settings.target_hidden = {};
            for (std::size_t t = 0; hidden && t < count; ++t) {
                c.settings.source_hidden.push_back(random() % 8 == 0 ? 1 : 0);
                c.settings.target_hidden.push_back(random() % 8 == 0 ? 1 : 0);
            }
            const auto ranges = drawRanges(count, 200, random);
            const std::size_t differ = checkWeighing(*this, c, ranges, hidden ? Rows::kShared : Rows::kOwn);
            // The dominant eye cannot see the outer columns of eyes that look outwards.
            const auto kinds = reference::weigh(c.dominant, ranges, c.eyes, c.settings).kinds;
            const auto unseen = std::ranges::count(kinds, TileKind::kEdge);
            if (!hidden) {
                CHECK((unseen > 0) == looks_outwards);
                if (c.sizePx().x > 100) { CHECK(2 * unseen <= std::ssize(kinds)); }
            }
            CHECK(differ <= 1);
            other += differ;
        }
    }
    CHECK(other <= 2);
}

TEST_CASE_FIXTURE(Gpu, "weigh counts exactly over any number of tiles, from one to many workgroups") {
    std::mt19937 random(6);
    for (const glm::uvec2 size_tiles :
         {glm::uvec2(1, 1), glm::uvec2(127, 1), glm::uvec2(1, 128), glm::uvec2(43, 3), glm::uvec2(33, 31)}) {
        StereoCase c = makeStill(16u * size_tiles - 7u);
        const std::size_t tiles = tileCount(c.sizePx());
        CAPTURE(tiles);
        for (const std::uint32_t move_cost : {0u, 50u, 100u, 70000u}) {
            c.settings.move_cost = move_cost;
            for (const unsigned most_pairs : {0u, 120u}) {
                CHECK(checkWeighing(*this, c, drawRanges(tiles, most_pairs, random), Rows::kOwn) == 0);
            }
        }
        c.settings.target_hidden.assign(tiles, 1);
        CHECK(checkWeighing(*this, c, drawRanges(tiles, 120, random), Rows::kOwn) == 0);
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "weigh moves nothing where that saves no more than half of moving all, and the budget") {
    // Eight tiles that cost 40 each to move: 160 must be saved; with seven that are shown, 140.
    struct Strip {
        std::vector<std::uint32_t> pairs;
        double budget;
        std::vector<std::uint8_t> hidden;
        bool moves;
    };
    const std::vector<std::uint8_t> none, fourth{0, 0, 0, 1, 0, 0, 0, 0};
    for (const Strip& strip :
         {Strip{{200, 1, 1, 1, 1, 1, 1, 1}, 0.0, none, false},
          Strip{{201, 1, 1, 1, 1, 1, 1, 1}, 0.0, none, true},
          Strip{{180, 1, 1, 1, 1, 1, 1, 1}, 0.0, fourth, false},
          Strip{{181, 1, 1, 1, 1, 1, 1, 1}, 0.0, fourth, true},
          // Hidden tiles count for nothing.
          Strip{{180, 1, 1, 9999, 1, 1, 1, 1}, 0.0, fourth, false},
          Strip{{500, 500, 0, 0, 0, 0, 0, 0}, 0.0, {1, 1, 1, 1, 1, 1, 1, 1}, false},
          // 477 in all, of which 309 are saved: more than 160 and 143 for mending, but not than 160 and 190.
          Strip{{349, 0, 0, 0, 0, 0, 0, 0}, 0.3, none, true},
          Strip{{349, 0, 0, 0, 0, 0, 0, 0}, 0.4, none, false}}) {
        INFO(strip.pairs[0], " pairs, budget ", strip.budget);
        StereoCase c = makeStill({128, 16});
        c.settings.move_cost = 40;
        c.settings.budget = strip.budget;
        c.settings.target_hidden = strip.hidden;
        const auto ranges = rangesOf(strip.pairs);
        CHECK(checkWeighing(*this, c, ranges, Rows::kOwn) == 0);
        CHECK(reference::weigh(c.dominant, ranges, c.eyes, c.settings).moves == strip.moves);
    }
}

TEST_CASE_FIXTURE(Gpu, "weigh says where moving would pay again, and holds costs to what a word holds") {
    StereoCase c = makeStill({64, 16});
    c.settings.move_cost = 40;
    c.settings.budget = 0.0;
    // Where nothing was moved before, an eighth of the saving is held back, and nothing is moved yet.
    const gpu::uint least = 40 + 4 * 40 / gpu::kMoveSharedPart;
    const auto counted = [](gpu::uint saved) { return saved - saved / gpu::kResumePart; };
    gpu::uint more = least;
    while (counted(more - 40) <= least - 40) { ++more; }
    for (const auto& [pairs, pays] : {std::pair(more - 1, 0u), std::pair(more, 1u)}) {
        StereoOnDevice still = toDevice(*this, c);
        still.weigh({{0, pairs}, {0, 40}, {0, 0}, {0, 3}}, false, kVisible, /*may_move=*/false);
        const gpu::WarpCounters counters = still.readCounters();
        CHECK(these(counters.pays, counters.moves, counters.saved_cost) == these(pays, 0u, pairs - 40));
    }
    StereoOnDevice device = toDevice(*this, c);
    device.weigh({{0, 5000000}, {7, 4194294}, {0, 4194288}, {0, 100}}, false, kVisible);
    CHECK(device.read(device.tile_costs) ==
          std::vector<gpu::uint>{gpu::kMaxTileCost, gpu::kMaxTileCost, gpu::kMaxTileCost, 116});
}

}  // SUITE(weigh)
