// Facts about weigh: what a tile costs, which tiles are not worth reprojecting, and whether reprojecting pays
// at all.
#include "tests/engine/passes/stereo_stages.h"

SUITE(weigh) {

using reference::TileKind;
using reference::TileRange;

constexpr std::size_t kVisible = 5000;

std::vector<TileRange> drawRanges(std::size_t tiles, unsigned most_pairs, std::mt19937& random) {
    std::vector<TileRange> ranges;
    std::uint32_t end = 0;
    for (std::size_t t = 0; t < tiles; ++t) {
        const auto pairs = static_cast<std::uint32_t>(random() % (most_pairs + 1));
        ranges.push_back({end, end + pairs});
        end += pairs;
    }
    return ranges;
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
    std::size_t other = 0, wrong_kinds = 0, wrong_depths = 0;
    std::uint64_t picture_cost = 0, saved_cost = 0, moved = 0;
    for (std::size_t t = 0; t < costs.size(); ++t) {
        const bool hidden = expected.kinds[t] == TileKind::kHidden;
        const bool same = hidden || costs[t] == expected.costs[t];
        other += same ? 0 : 1;
        wrong_depths += hidden || depths[t] == expected_depths[t] ? 0 : 1;
        // Where nothing is worth moving, select says so of each tile.
        const auto expected_kind = static_cast<gpu::uint>(expected.kinds[t]);
        wrong_kinds += !same || kinds[t] == expected_kind ||
                               (!expected.moves && kinds[t] == 0 && expected_kind == gpu::kTileCheap)
                           ? 0
                           : 1;
        picture_cost += hidden ? 0 : costs[t];
        moved += kinds[t] == 0 ? 1 : 0;
        if (kinds[t] == 0) { saved_cost += costs[t] - gpu::kTilePairs - c.settings.move_cost; }
    }
    CHECK(wrong_kinds == 0);
    CHECK(wrong_depths == 0);
    CHECK(counters.picture_cost == picture_cost);
    CHECK(counters.saved_cost == saved_cost);
    if (other == 0) {
        CHECK(counters.picture_cost == expected.picture_cost);
        CHECK(counters.saved_cost == expected.saved_cost);
        CHECK((counters.moves == 1) == expected.moves);
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
    const auto isZero = [](gpu::uint value) { return value == 0; };
    CHECK(std::ranges::all_of(device.read(device.tile_errors), isZero));
    CHECK(std::ranges::all_of(device.read(device.tile_mask), isZero));
    CHECK(std::ranges::all_of(device.read(device.bins), isZero));
    return other;
}

// Identical eyes, and a picture that is infinitely far: every tile weighs its own pairs.
StereoCase makeStill(glm::uvec2 size_px) {
    const Eye eye = makeEye(size_px);
    StereoCase c{"still", {}, {eye, eye}, {}, {}};
    const std::size_t pixels = std::size_t{size_px.x} * size_px.y;
    c.dominant = {size_px, std::vector(pixels, glm::dvec4(0.0)), std::vector(pixels, 0.0),
                  std::vector(pixels, 0.0), std::vector(pixels, 0.0)};
    return c;
}

TEST_CASE_FIXTURE(
    Gpu, "weigh finds the twin's costs and kinds, for eyes of every kind and whatever moving costs") {
    std::size_t other = 0;
    std::mt19937 random(5);
    for (StereoCase c : makeStereoCases()) {
        const std::size_t count = tileCount(c.sizePx());
        for (unsigned way = 0; way < 8; ++way) {
            const bool hidden = way % 2 != 0;
            c.settings.move_cost = std::array{0u, 30u, 90u, 200u}[way / 2];
            INFO(c.name, ", move cost ", c.settings.move_cost, ", hidden ", hidden);
            c.settings.source_hidden = c.settings.target_hidden = {};
            for (std::size_t t = 0; hidden && t < count; ++t) {
                c.settings.source_hidden.push_back(random() % 8 == 0 ? 1 : 0);
                c.settings.target_hidden.push_back(random() % 8 == 0 ? 1 : 0);
            }
            const std::size_t differ =
                checkWeighing(*this, c, drawRanges(count, 200, random), hidden ? Rows::kShared : Rows::kOwn);
            CHECK(differ <= 1);
            other += differ;
        }
    }
    CHECK(other <= 2);
}

void checkCounts(Gpu& gpu, const std::vector<glm::uvec2>& sizes_tiles) {
    std::mt19937 random(6);
    for (const glm::uvec2 size_tiles : sizes_tiles) {
        StereoCase c = makeStill(16u * size_tiles - 7u);
        const std::size_t tiles = tileCount(c.sizePx());
        CAPTURE(tiles);
        for (const std::uint32_t move_cost : {0u, 50u, 100u, 70000u}) {
            c.settings.move_cost = move_cost;
            for (const unsigned most_pairs : {0u, 120u}) {
                CHECK(checkWeighing(gpu, c, drawRanges(tiles, most_pairs, random), Rows::kOwn) == 0);
            }
        }
        c.settings.target_hidden.assign(tiles, 1);
        CHECK(checkWeighing(gpu, c, drawRanges(tiles, 120, random), Rows::kOwn) == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "weigh counts exactly over any number of tiles, from one to many workgroups") {
    checkCounts(*this, {{1, 1}, {127, 1}, {1, 128}, {43, 3}, {33, 31}});
}
TEST_CASE_FIXTURE(Gpu, "weigh counts exactly over as many tiles as a headset has" * nightly()) {
    checkCounts(*this, {{100, 50}});
}

TEST_CASE_FIXTURE(Gpu,
                  "weigh moves nothing where that saves no more than the shared part of moving all, as the "
                  "twin, and holds costs to "
                  "what a word has room for") {
    // Four tiles that cost 40 each to move: more than a part of 160 must be saved.
    StereoCase c = makeStill({64, 16});
    c.settings.move_cost = 40;
    c.settings.budget = 0.0;
    const gpu::uint least = 40 + 4 * 40 / gpu::kMoveSharedPart;
    for (const auto& [pairs, moves] : {std::pair(least, false), std::pair(least + 1, true)}) {
        const std::vector<TileRange> ranges{{0, pairs}, {0, 40}, {0, 0}, {0, 3}};
        CHECK(reference::weigh(c.dominant, ranges, c.eyes, c.settings).moves == moves);
        StereoOnDevice device = toDevice(*this, c);
        device.weigh(ranges, false, kVisible);
        CHECK(device.readCounters().moves == (moves ? 1u : 0u));
        CHECK(device.read(device.tile_costs) == std::vector<gpu::uint>{pairs + 16, 56, 16, 19});
    }
    // Where nothing was moved before, an eighth of the saving is held back, and nothing is moved yet.
    const auto counted = [](gpu::uint saved) { return saved - saved / gpu::kResumePart; };
    gpu::uint more = least;
    while (counted(more - 40) <= least - 40) { ++more; }
    for (const auto& [pairs, pays] : {std::pair(more - 1, false), std::pair(more, true)}) {
        StereoOnDevice still = toDevice(*this, c);
        still.weigh({{0, pairs}, {0, 40}, {0, 0}, {0, 3}}, false, kVisible, /*may_move=*/false);
        CHECK(still.readCounters().pays == (pays ? 1u : 0u));
        CHECK(still.readCounters().moves == 0);
        CHECK(still.readCounters().saved_cost == pairs - 40);
    }
    StereoOnDevice device = toDevice(*this, c);
    device.weigh({{0, 5000000}, {7, 4194294}, {0, 4194288}, {0, 100}}, false, kVisible);
    CHECK(device.read(device.tile_costs) ==
          std::vector<gpu::uint>{gpu::kMaxTileCost, gpu::kMaxTileCost, gpu::kMaxTileCost, 116});
}

TEST_CASE_FIXTURE(Gpu, "weigh renders what the dominant eye cannot see, as a headset's outer columns") {
    // 10 degrees wider outwards than inwards, or canted by 8, or neither.
    const glm::uvec2 size_px(160, 96);
    const double inwards = std::tan(0.6), outwards = std::tan(0.6 + 10.0 * glm::pi<double>() / 180.0);
    const double focal_px = size_px.x / (inwards + outwards);
    const auto eyeOf = [&](double principal_px, double cant_rad, double x) {
        return Eye{{glm::angleAxis(cant_rad, glm::dvec3(0.0, 1.0, 0.0)), {x, 0.0, 0.0}},
                   {focal_px, focal_px, principal_px, 48.0},
                   size_px};
    };
    const double left_px = focal_px * outwards, right_px = focal_px * inwards;
    const reference::EyePair pairs[] = {{eyeOf(left_px, 0.0, 0.0), eyeOf(right_px, 0.0, 0.064)},
                                        {eyeOf(80.0, -0.07, 0.0), eyeOf(80.0, 0.07, 0.064)},
                                        {eyeOf(80.0, 0.0, 0.0), eyeOf(80.0, 0.0, 0.064)}};
    const std::ptrdiff_t least_unseen[] = {6, 6, 0};
    std::mt19937 random(11);
    for (std::size_t p = 0; p < 3; ++p) {
        CAPTURE(p);
        StereoCase c = makeStill(size_px);
        c.eyes = pairs[p];
        const auto ranges = drawRanges(60, 500, random);
        CHECK(checkWeighing(*this, c, ranges, Rows::kOwn) == 0);
        const auto unseen = std::ranges::count(reference::weigh(c.dominant, ranges, c.eyes, c.settings).kinds,
                                               TileKind::kEdge);
        // The affiliated eye's outer columns, and not all of its tiles.
        CHECK(unseen >= least_unseen[p]);
        CHECK(unseen <= (p == 2 ? 0 : 30));
    }
}

}  // SUITE(weigh)
