// Facts about the passes that make an eye from its past, each held to its twin, which goes on from what the device had one pass before:
// warp_past and warp_pixels, and what rasterize measures (price and select: past_choice_test.cpp). Where a depth or a place lies on a
// threshold, float32 may come to the other side: such flips have a budget.
#include "tests/engine/passes/past_stages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

TEST_SUITE_BEGIN("past_passes");

namespace past_passes_test {

using namespace binosplat;
using reference::TileKind;
using test::EyeOnDevice;
using test::Gpu;
using test::ViewedScene;
using Walk = test::PastWalk;

namespace {

constexpr double kSteps = test::kErrorSteps;

ViewedScene viewAtelier() { return test::viewBuiltin("builtin:atelier", {150, 110}, 20000); }
ViewedScene viewFence() { return test::viewBuiltin("builtin:fence", {150, 110}); }

struct Differences {
    std::size_t pixels = 0, other_depths = 0, other_spreads = 0, quarters = 0, other_grown = 0, tiles = 0, other_tiles = 0,
                other_errors = 0;
    double grown = 0.0, twin_grown = 0.0, squares = 0.0;
};

// Of what the device made of `before`, nothing of which was rendered again, and what the twin makes of it.
void compareWarped(Differences& differences, const EyeOnDevice& made, reference::Past twin) {
    for (std::size_t i = 0; i < twin.rgba.size(); ++i) {
        const glm::dvec4 off = made.past.rgba[i] - twin.rgba[i];
        differences.squares += glm::dot(off, off) / 4.0;
        const auto &a = made.past.pixels[i], &b = twin.pixels[i];
        // A block's depths change by the ratio of its middle's.
        const bool same = a.has_value() == b.has_value() && (!a || test::isNear(a->inverse_depth, b->inverse_depth, 1e-3, 1e-6));
        differences.other_depths += same ? 0 : 1;
        differences.other_spreads += a && b && a->spread != b->spread ? 1 : 0;
    }
    differences.pixels += twin.rgba.size();
    for (std::size_t t = 0; t < twin.tiles.size(); ++t) {
        const reference::PastTile &a = made.past.tiles[t], &b = twin.tiles[t];
        for (std::size_t q = 0; q < 4; ++q) {
            // A pixel's error is cut off to steps.
            differences.other_grown += test::isNear(a.grown[q], b.grown[q], 0.02, 66.0 / kSteps) ? 0 : 1;
            differences.grown += a.grown[q];
            differences.twin_grown += b.grown[q];
        }
        differences.other_tiles += a.cost == b.cost && a.age == b.age && test::isNear(a.growth, b.growth, 1e-6, 0.0) ? 0 : 1;
    }
    reference::growErrors(twin.tiles);
    for (std::size_t t = 0; t < twin.tiles.size(); ++t) {
        for (std::size_t q = 0; q < 4; ++q) {
            differences.other_errors += test::isNear(made.past.tiles[t].errors[q], twin.tiles[t].errors[q], 0.02, 6e-4) ? 0 : 1;
        }
    }
    differences.tiles += twin.tiles.size();
    differences.quarters += 4 * twin.tiles.size();
}

// D of a pixel is its alpha over its inverse depth, 0 where that is infinitely far.
std::size_t countOtherDepths(const Image& depths, const reference::Past& past) {
    std::size_t other = 0;
    for (std::size_t i = 0; i < past.rgba.size(); ++i) {
        const double inverse_depth = past.pixels[i] ? past.pixels[i]->inverse_depth : 0.0;
        const double expected = inverse_depth > 0.0 ? past.rgba[i].a / inverse_depth : 0.0;
        other += test::isNear(static_cast<double>(depths.values[i]), expected, 1e-3, 1e-6) ? 0 : 1;  // half floats
    }
    return other;
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "warp_past and warp_pixels make the twin's picture, and expect the twin's errors") {
    // Rows of a multiple of four pixels are written four at a time, and in half floats all of a block's row.
    for (const auto& [view, half_floats] :
         {std::pair(viewAtelier(), false), std::pair(test::viewBuiltin("builtin:fence", {160, 112}), true)}) {
        for (const bool hides : {false, true}) {
            test::WalkSettings settings{.half_floats = half_floats};
            auto& hidden = settings.hidden;
            if (hides) {
                hidden.fill(std::vector<std::uint8_t>(70, 0));
                for (auto& tiles : hidden) { tiles[0] = tiles[9] = tiles[33] = tiles[34] = 1; }
            }
            CAPTURE(view.name);
            CAPTURE(hides);
            Walk walk(*this, view, settings);
            walk.go(0.0, 0.0);
            std::array<EyeOnDevice, 2> before{walk.read(kLeft), walk.read(kRight)};
            Differences all;
            std::size_t one_by_one = 0, blocks = 0;
            for (const double step : {1.0, 2.0, 10.0}) {  // the last so far that blocks of a cell come from two
                walk.go(step, 0.0);
                for (const int eye : {kLeft, kRight}) {
                    EyeOnDevice made = walk.read(eye);
                    const auto e = static_cast<std::size_t>(eye);
                    reference::WarpedPast warped = reference::warpPast(before[e].past, walk.eyes()[e], hidden[e], settings.background);
                    one_by_one += static_cast<std::size_t>(std::ranges::count(warped.one_by_one, 1));
                    blocks += warped.one_by_one.size();
                    compareWarped(all, made, std::move(warped.picture));
                    if (eye == kLeft) { CHECK(countOtherDepths(walk.readDepth(), made.past) == 0); }
                    before[e] = std::move(made);
                }
            }
            const double psnr_db = -10.0 * std::log10(all.squares / static_cast<double>(all.pixels));
            MESSAGE(view.name << ": " << psnr_db << " dB to the twin; one by one " << test::share(one_by_one, blocks)
                              << " of the blocks; other: depths " << test::share(all.other_depths, all.pixels) << ", spreads "
                              << test::share(all.other_spreads, all.pixels) << ", tiles " << test::share(all.other_tiles, all.tiles)
                              << ", growth of errors " << test::share(all.other_grown, all.quarters) << ", errors "
                              << test::share(all.other_errors, all.quarters) << "; sum of growth " << all.grown << " and "
                              << all.twin_grown);
            CHECK(one_by_one > blocks / 20);
            CHECK(one_by_one < blocks - blocks / 20);
            CHECK(psnr_db >= 55.0);
            CHECK(test::share(all.other_depths, all.pixels) <= 0.001);
            CHECK(test::share(all.other_spreads, all.pixels) <= 0.001);
            CHECK(test::share(all.other_tiles, all.tiles) <= 0.005);
            CHECK(test::share(all.other_grown, all.quarters) <= 0.005);
            CHECK(test::share(all.other_errors, all.quarters) <= 0.005);
            CHECK(test::isNear(all.grown, all.twin_grown, 0.001, 0.0));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "where there is no past both pictures are predicted's, and what they leave for later is the twin's") {
    for (const auto& [view, half_floats, cant] : {std::tuple(viewAtelier(), false, 0.0), std::tuple(viewFence(), true, 0.0),
                                                  std::tuple(viewAtelier(), false, 0.05), std::tuple(viewAtelier(), true, 0.0)}) {
        for (const bool hides : {false, true}) {
            CAPTURE(view.name);
            CAPTURE(half_floats);
            CAPTURE(cant);
            CAPTURE(hides);
            test::WalkSettings settings{.half_floats = half_floats, .cant = cant};
            auto& hidden = settings.hidden;
            if (hides) {
                hidden.fill(std::vector<std::uint8_t>(70, 0));
                for (auto& tiles : hidden) { tiles[0] = tiles[9] = tiles[33] = tiles[34] = 1; }
            }
            Walk walk(*this, view, settings);
            walk.go(0.0, 0.2);
            const EyeOnDevice left = walk.read(kLeft), right = walk.read(kRight);
            const std::array<Image, 2> predicted = walk.predicted(0.2);
            for (const auto& [eye, made] : {std::pair(kLeft, &left), std::pair(kRight, &right)}) {
                for (std::size_t i = 0; i < made->past.rgba.size(); ++i) {
                    for (int channel = 0; channel < 4; ++channel) {
                        REQUIRE(made->past.rgba[i][channel] ==
                                static_cast<double>(predicted[eye].values[4 * i + static_cast<std::size_t>(channel)]));
                    }
                }
            }

            reference::StereoSettings stereo;
            stereo.source_hidden = hidden[0];
            stereo.target_hidden = hidden[1];
            const reference::StereoPictures pictures =
                reference::renderStereo(view.scene, {walk.eyes()[0], walk.eyes()[1]}, stereo, {.background = settings.background});
            const reference::Past twin = reference::pastOf(walk.eyes()[1], pictures);
            std::size_t moved = 0, other_tiles = 0, pixels = 0, other_depths = 0, other_spreads = 0, hidden_tiles = 0;
            const std::size_t columns = tilesOf(twin.eye.size_px).x;
            for (std::size_t t = 0; t < twin.tiles.size(); ++t) {
                const reference::PastTile& a = right.past.tiles[t];
                CHECK(a.age == 0);
                CHECK(a.growth == 0.0);
                if (right.kinds[t] == gpu::kTileHidden) {
                    ++hidden_tiles;
                    CHECK(a.cost == 0);
                    CHECK(a.errors == std::array<double, 4>{});
                } else if (right.kinds[t] != 0) {
                    CHECK(a.errors == std::array<double, 4>{});  // rendered
                } else {
                    ++moved;
                    // What it is told by, as the twin goes on from it. That the device expects the twin's errors: selection_test.cpp.
                    reference::StereoPictures told;
                    told.tile_kinds = {TileKind::kNone};
                    told.tile_errors = {right.errors[t] / kSteps};
                    told.tile_costs = {right.costs[t]};
                    const reference::PastTile expected = reference::pastOf(walk.eyes()[1], told).tiles[0];
                    CHECK(a.cost == expected.cost);
                    CHECK(test::isNear(a.errors[0], expected.errors[0], 1e-5, 0.0));
                    other_tiles += test::isNear(a.errors[0], twin.tiles[t].errors[0], 0.02, 1e-4) ? 0 : 1;
                    CHECK(a.errors == std::array{a.errors[0], a.errors[0], a.errors[0], a.errors[0]});
                }
            }
            for (std::size_t i = 0; i < twin.pixels.size(); ++i) {
                const std::size_t x = i % twin.eye.size_px.x, y = i / twin.eye.size_px.x;
                const gpu::uint kind = right.kinds[y / gpu::kTileSize * columns + x / gpu::kTileSize];
                const auto &a = right.past.pixels[i], &b = twin.pixels[i];
                if (kind == gpu::kTileHidden) { CHECK(!a.has_value()); }
                if (kind != 0) { continue; }
                ++pixels;
                REQUIRE(a.has_value());
                other_depths += b && test::isNear(a->inverse_depth, b->inverse_depth, 1e-3, 1e-5) ? 0 : 1;
                // Of a single surface it is rounding that spreads.
                constexpr std::uint32_t kRounding = 12;
                other_spreads += b && std::max(a->spread, kRounding) == std::max(b->spread, kRounding) ? 0 : 1;
            }
            MESSAGE(view.name << ": " << moved << " tiles moved; other tiles " << test::share(other_tiles, moved) << ", depths "
                              << test::share(other_depths, pixels) << ", spreads " << test::share(other_spreads, pixels));
            CHECK(hidden_tiles == (hides ? 4u : 0u));
            CHECK(moved > 10);
            CHECK(test::share(other_tiles, moved) <= 0.25);  // a splat that only just meets a tile of the source is no newcomer
            CHECK(test::share(other_depths, pixels) <= 0.01);
            CHECK(test::share(other_spreads, pixels) <= 0.02);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a frame's choice is the twin's, and tiles that were rendered again say what they had been off by") {
    for (const ViewedScene& view : {viewAtelier(), viewFence()}) {
        CAPTURE(view.name);
        // Of two walks that are alike so far one renders tiles again in the last frame.
        Walk walk(*this, view), only_warps(*this, view);
        constexpr int kFrames = 3;
        for (int step = 0; step <= kFrames; ++step) {
            walk.go(step, step == kFrames ? 0.3 : 0.0);
            only_warps.go(step, 0.0);
        }
        std::vector<std::vector<TileKind>> kinds;
        std::vector<std::vector<std::optional<std::uint32_t>>> prices;
        std::vector<std::vector<std::uint64_t>> costs;
        std::uint64_t picture_cost = 0;
        std::array<EyeOnDevice, 2> made{walk.read(kLeft), walk.read(kRight)}, warped{only_warps.read(kLeft), only_warps.read(kRight)};
        for (std::size_t e = 0; e < 2; ++e) {
            std::vector<double> errors;
            costs.emplace_back(made[e].costs.begin(), made[e].costs.end());
            for (std::size_t t = 0; t < costs[e].size(); ++t) {
                errors.push_back(made[e].errors[t] / kSteps);
                picture_cost += costs[e][t];
                CHECK(costs[e][t] == reference::costOf(warped[e].past.tiles[t]));
                CHECK(test::isNear(errors[t], reference::worthOf(warped[e].past.tiles[t]), 1e-5, 1.0 / kSteps));
            }
            kinds.emplace_back(costs[e].size(), TileKind::kNone);
            prices.push_back(reference::price(kinds[e], errors, costs[e]));
        }
        reference::selectTogether(
            std::array{reference::PricedTiles{kinds[0], prices[0], costs[0]}, reference::PricedTiles{kinds[1], prices[1], costs[1]}},
            static_cast<std::uint64_t>(0.3f * static_cast<float>(picture_cost)));
        std::size_t rendered = 0;
        for (std::size_t e = 0; e < 2; ++e) {
            CHECK(made[e].kinds == test::kindsOf(kinds[e]));
            // What is rendered is the device's own, so that what the twin measures is exact.
            reference::Picture full{walk.eyes()[e].size_px, made[e].past.rgba, {}, {}, {}};
            full.inverse_depth = full.inverse_depth_squared = std::vector<double>(full.rgba.size(), 0.0);
            std::vector<std::uint64_t> pairs;
            for (const reference::PastTile& tile : made[e].past.tiles) { pairs.push_back(tile.cost); }
            reference::Past twin = warped[e].past;
            reference::renderTiles(twin, full, pairs, kinds[e]);
            for (std::size_t t = 0; t < kinds[e].size(); ++t) {
                const reference::PastTile &a = made[e].past.tiles[t], &b = twin.tiles[t];
                CHECK(a.age == b.age);
                // Up to a step for each thread's sum.
                CHECK(std::abs(a.growth - b.growth) <= 1e-3 * b.growth + 2e-4);
                for (std::size_t q = 0; q < 4; ++q) { CHECK(test::isNear(a.errors[q], b.errors[q], 1e-6, 0.0)); }
                rendered += kinds[e][t] == TileKind::kPredicted && a.growth > 1e-3 ? 1 : 0;
            }
            for (std::size_t i = 0; i < twin.rgba.size(); ++i) { REQUIRE(twin.rgba[i] == made[e].past.rgba[i]); }
        }
        CHECK(rendered > 10);
    }
}

TEST_CASE_FIXTURE(Gpu, "every tile of a picture that moves has its turn, also where nothing is expected to go wrong") {
    // Bars across the view, near and far in turn and of the background's colour: no block is of one depth, and none looks wrong.
    std::vector<test::Splat> splats;
    for (int bar = -7; bar <= 7; ++bar) {
        const float z = bar % 2 == 0 ? 1.0f : 1.5f;
        splats.push_back(
            {{0.0f, 0.06f * z * static_cast<float>(bar), z}, {1, 0, 0, 0}, z * glm::vec2(3.0f, 0.02f), 0.99f, glm::vec3(0.5f)});
    }
    const ViewedScene view{"bars", test::makeScene(splats), test::makeEye({96, 64})};
    Walk walk(*this, view, {.background = glm::dvec3(0.5)});
    walk.go(0.0, 0.0);
    walk.go(5.0, 0.0);
    for (const int eye : {kLeft, kRight}) { CHECK(std::ranges::count(walk.read(eye).errors, 0u) == 0); }
}

}  // namespace past_passes_test
