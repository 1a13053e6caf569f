// Facts about the passes that reproject an eye from its history: warp_history and warp_pixels, what rasterize
// measures (price and select: selection_test.cpp), and what changes of the scene do. Each is compared with
// its twin, which continues from the device's previous pass. Where a depth or a place lies on a threshold,
// float32 may fall on the other side: there is a budget for such flips.
#include "engine/frame/changes.h"
#include "tests/engine/gpu/compiled_shader.h"
#include "tests/engine/passes/history_stages.h"
#include "tests/engine/passes/pass_stages.h"

SUITE(history_passes) {

using reference::TileKind;

constexpr glm::uvec2 kSizePx(150, 110);
// Rows of a multiple of four pixels are written four at a time, and with half floats a block's whole row at
// once.
constexpr glm::uvec2 kEvenPx(160, 112);
ViewedScene viewFence(glm::uvec2 size_px = kSizePx) { return viewBuiltin("builtin:fence", size_px); }

// A pixel's D is its alpha over its inverse depth, or 0 if that is infinitely far.
void checkDepths(const Image& depths, const reference::History& history) {
    for (std::size_t i = 0; i < history.rgba.size(); ++i) {
        const double inverse_depth = history.pixels[i] ? history.pixels[i]->inverse_depth : 0.0;
        const double expected = inverse_depth > 0.0 ? history.rgba[i].a / inverse_depth : 0.0;
        // Depths are half floats.
        REQUIRE(isNear(static_cast<double>(depths.values[i]), expected, 1e-3, 1e-6));
    }
}

// Boxes around an eye: in front of it, beside it and behind it, from a speck to a hall, and some that contain
// it.
std::vector<SceneChange> boxesAbout(const Eye& eye, int count, unsigned seed) {
    std::mt19937 random(seed);
    const auto draw = [&](double low, double high) { return drawBetween(random, low, high); };
    std::vector<SceneChange> boxes;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 middle =
            eye.world_from_camera.position + glm::dvec3(draw(-3, 3), draw(-3, 3), draw(-3, 3));
        const glm::dvec3 half =
            std::pow(10.0, draw(-3.0, 0.5)) * glm::dvec3(draw(0, 1), draw(0, 1), draw(0, 1));
        boxes.push_back(
            {glm::vec3(middle - half), glm::vec3(middle + half), static_cast<float>(draw(0.01, 1.0))});
    }
    return boxes;
}

// A scene, and how its pictures are kept.
struct Way {
    ViewedScene view;
    bool half_floats, hides;
    double cant = 0.0;
    std::array<std::vector<std::uint8_t>, 2> hidden = {};  // must live as long as the settings

    FrameSettings settings() {
        FrameSettings settings = walkSettings(half_floats);
        for (std::size_t e = 0; e < 2 && hides; ++e) {
            hidden[e].assign(tileCount(view.eye.size_px), 0);
            hidden[e][0] = hidden[e][9] = hidden[e][33] = hidden[e][34] = 1;
            settings.hidden_tiles[e] = hidden[e];
        }
        return settings;
    }
};

// How far the device's warp is from the twin's.
struct WarpDifferences {
    std::map<std::string, std::array<std::size_t, 2>> counts;  // how many differ, and how many there are
    double grown = 0.0, twin_grown = 0.0, squares = 0.0;

    void note(const char* what, bool is_same) {
        counts[what][0] += !is_same;
        ++counts[what][1];
    }
    // What the device made of the frame before, with nothing rendered again.
    void compare(const EyeOnDevice& made, reference::History twin) {
        for (std::size_t i = 0; i < twin.rgba.size(); ++i) {
            const glm::dvec4 off = made.history.rgba[i] - twin.rgba[i];
            squares += glm::dot(off, off) / 4.0;
            const auto &a = made.history.pixels[i], &b = twin.pixels[i];
            // All depths of a block change by the ratio of its middle's.
            note("depth", a.has_value() == b.has_value() &&
                              (!a || isNear(a->inverse_depth, b->inverse_depth, 1e-3, 1e-6)));
            note("spread", !a || !b || a->spread == b->spread);
        }
        auto grown_twin = twin.tiles;
        reference::growErrors(grown_twin);
        for (std::size_t t = 0; t < twin.tiles.size(); ++t) {
            const reference::HistoryTile &a = made.history.tiles[t], &b = twin.tiles[t];
            for (std::size_t q = 0; q < 4; ++q) {
                note("growth", isNear(a.growth[q], b.growth[q], 1e-5, 1e-8));
                // A pixel's error is rounded down to steps.
                note("grown", isNear(a.grown[q], b.grown[q], 0.02, 66.0 / kErrorSteps));
                note("errors", isNear(a.errors[q], grown_twin[t].errors[q], 0.02, 6e-4));
                grown += a.grown[q];
                twin_grown += b.grown[q];
            }
            note("gradient", isNear(a.squared_gradient, b.squared_gradient, 0.02, 264.0 / kErrorSteps));
            note("tile", a.cost == b.cost && a.age == b.age && a.unseen == b.unseen);
        }
    }
};

// Pictures that are reprojected only from the previous ones.
void checkWarped(Gpu& gpu, Way way) {
    INFO(way.view.name, ", hides ", way.hides);
    const FrameSettings settings = way.settings();
    HistoryWalk walk(gpu, way.view, settings);
    walk.go(0.0, 0.0);
    std::array<EyeOnDevice, 2> before{walk.read(kLeft), walk.read(kRight)};
    WarpDifferences all;
    std::size_t one_by_one = 0, blocks = 0;
    // The last is so large that the blocks of a cell come from two.
    for (const double step : {1.0, 2.0, 10.0}) {
        walk.go(step, 0.0);
        for (const std::size_t e : {0, 1}) {
            EyeOnDevice made = walk.read(e);
            before[e].history.hidden = way.hidden[e];
            reference::WarpedHistory warped =
                reference::warpHistory(before[e].history, walk.eyes()[e], way.hidden[e], settings.background);
            one_by_one += static_cast<std::size_t>(std::ranges::count(warped.one_by_one, 1));
            blocks += warped.one_by_one.size();
            all.compare(made, std::move(warped.picture));
            if (e == 0) { checkDepths(walk.frame().readDominantDepth(), made.history); }
            before[e] = std::move(made);
        }
    }
    CHECK(one_by_one == between(blocks / 20, blocks - blocks / 20));
    const double pixels = static_cast<double>(all.counts["depth"][1]);
    CHECK(-10.0 * std::log10(all.squares / pixels) >= 55.0);
    for (const auto& [what, counts] : all.counts) {
        CAPTURE(what);
        CHECK(share(counts[0], counts[1]) <= (what == "depth" || what == "spread" ? 0.001 : 0.005));
    }
    CHECK(isNear(all.grown, all.twin_grown, 0.001, 0.0));
}

// Pictures without a history. For the words that they leave see tile_passes_test.cpp.
void checkFirst(Gpu& gpu, Way way) {
    INFO(way.view.name, ", half floats ", way.half_floats, ", cant ", way.cant, ", hides ", way.hides);
    HistoryWalk walk(gpu, way.view, way.settings(), way.cant);
    const FrameResult result = walk.go(0.0, 0.2);
    const std::array<Image, 2> full = walk.full();
    for (const std::size_t e : {0, 1}) {
        const reference::History made = walk.read(e).history;
        CHECK(toImage(full[e].size_px, made.rgba).values == full[e].values);
        std::uint64_t pairs = 0;
        for (std::size_t t = 0; t < made.tiles.size(); ++t) {
            const reference::HistoryTile& tile = made.tiles[t];
            pairs += tile.cost;
            if (way.hides && way.hidden[e][t] != 0) { continue; }
            CHECK(these(tile.age, tile.growth, tile.errors) ==
                  these(0u, std::array<double, 4>{}, std::array<double, 4>{}));
        }
        CHECK(pairs == countOf(result, e == 0 ? "tile_pairs_left" : "tile_pairs_right"));
    }
}

TEST_CASE_FIXTURE(Gpu, "warp_history and warp_pixels make the twin's picture, and expect the twin's errors") {
    checkWarped(*this, {viewAtelier(kSizePx), false, true});
    checkWarped(*this, {viewFence(kEvenPx), true, false});
}

TEST_CASE_FIXTURE(Gpu, "pixels are the same whether they are moved as addresses or as what they are") {
    const auto walk = [](HistoryWalk& of) {
        for (int step = 0; step < 3; ++step) { of.go(step, 0.0); }
        return of.read(kRight).history.rgba;
    };
    for (const bool half_floats : {false, true}) {
        const ViewedScene view = half_floats ? viewFence(kEvenPx) : viewAtelier(kSizePx);
        HistoryWalk own(*this, view, walkSettings(half_floats));
        const auto expected = walk(own);
        for (const auto& [name, last_constant] :
             {std::pair("warp_history", 4u), std::pair("warp_pixels", 3u)}) {
            constexpr std::uint32_t kDecorate = 71, kSpecId = 1;
            changeShader(context(), name, [last = last_constant](std::span<std::uint32_t> whole) {
                if ((whole[0] & 0xffff) == kDecorate && whole[2] == kSpecId && whole[3] == last) {
                    whole[3] = 99;  // an id that nobody sets, so by_address keeps its default
                }
            });
        }
        HistoryWalk other(*this, view, walkSettings(half_floats));
        CHECK(walk(other) == expected);
        context().replacedShaders().clear();
    }
}

TEST_CASE_FIXTURE(Gpu, "without a history pictures are rendered in full, and no error is expected of them") {
    checkFirst(*this, {viewAtelier(kSizePx), false, false});
    checkFirst(*this, {viewFence(), true, true});
    checkFirst(*this, {viewAtelier(kSizePx), false, true, 0.05});
}

TEST_CASE_FIXTURE(Gpu, "pictures are so in floats and halves, whatever lenses hide" * nightly()) {
    for (const bool hides : {false, true}) {
        checkWarped(*this, {viewAtelier(kSizePx), false, hides});
        checkWarped(*this, {viewFence(kEvenPx), true, hides});
        checkFirst(*this, {viewAtelier(kSizePx), true, hides});
        checkFirst(*this, {viewAtelier(kSizePx), false, hides});
        checkFirst(*this, {viewAtelier(kSizePx), false, hides, 0.05});
        checkFirst(*this, {viewFence(), true, hides});
    }
}

// What pixels twice as wide lose in a tile, with splats sampled as the tile's own pixels would see them.
double widerSquares(const ViewedScene& view, const Eye& eye, const reference::HistoryTile& tile,
                    std::size_t index) {
    const reference::Settings settings{.background = {0.1, 0.2, 0.3}};
    TwinStages stages({view.name, view.scene, eye}, settings);
    const auto picture = [&] {
        return reference::rasterize(stages.splats, stages.sorted_pairs, stages.ranges, eye, settings);
    };
    const reference::Picture full = picture();
    for (reference::ProjectedSplat& splat : stages.splats) {
        splat = reference::asSeenWider(splat, eye.size_px, view.scene.antialiased);
    }
    return reference::widerSquares(tile, full, picture(), index, eye.size_px);
}

TEST_CASE_FIXTURE(Gpu, "what a frame measures of the tiles that it renders again is the twin's") {
    for (const ViewedScene& view : {viewAtelier(kSizePx), viewFence(), viewGaussians({200, 150}, false),
                                    viewGaussians({200, 150}, true)}) {
        CAPTURE(view.name);
        // The last of some frames renders tiles again.
        const auto go = [](HistoryWalk& walk, double budget, std::uint32_t measured = gpu::kMeasuredParts) {
            for (int step = 0; step < 3; ++step) { walk.go(step, 0.0, measured); }
            return walk.go(3.0, budget, measured);
        };
        HistoryWalk before(*this, view), walk(*this, view), only_warps(*this, view);
        go(before, 0.5);
        const std::vector<gpu::uint> chosen = before.read(kLeft).kinds;
        const auto measured = static_cast<std::uint32_t>(
            std::find(chosen.begin() + 6, chosen.end(), gpu::kTilePredicted) - chosen.begin());
        REQUIRE(measured < gpu::kMeasuredParts);
        const FrameResult result = go(walk, 0.5, measured);
        go(only_warps, 0.0);
        std::size_t rendered = 0, chosen_cost = 0, all_cost = 0;
        double left = 0.0, wider = 0.0;
        reference::SquaresOfTiles sums;
        for (const std::size_t e : {0, 1}) {
            const EyeOnDevice made = walk.read(e);
            const reference::History warped = only_warps.read(e).history;
            const std::vector<TileKind> kinds = kindsOf(made.kinds);
            // The full render is the device's own, so the twin's measurement is exact.
            reference::Picture full{walk.eyes()[e].size_px, made.history.rgba, {}, {}, {}};
            full.inverse_depth = full.inverse_depth_squared = std::vector<double>(full.rgba.size(), 0.0);
            std::vector<std::uint64_t> pairs;
            for (const reference::HistoryTile& tile : made.history.tiles) { pairs.push_back(tile.cost); }
            reference::History twin = warped;
            const reference::SquaresOfTiles its = reference::renderTiles(twin, full, pairs, kinds);
            sums = {sums.expected + its.expected, sums.found + its.found};
            left += reference::leftSquares(warped.tiles, kinds);
            if (kinds[measured] == TileKind::kPredicted) {
                wider += widerSquares(view, walk.eyes()[e], warped.tiles[measured], measured);
            }
            for (std::size_t t = 0; t < kinds.size(); ++t) {
                const reference::HistoryTile &a = made.history.tiles[t], &b = twin.tiles[t];
                all_cost += made.costs[t];
                chosen_cost += kinds[t] == TileKind::kPredicted ? made.costs[t] : 0;
                CHECK(a.age == b.age);
                for (std::size_t q = 0; q < 4; ++q) {
                    // Up to a step for each thread's sum.
                    CHECK(std::abs(a.growth[q] - b.growth[q]) <= 1e-3 * b.growth[q] + 2e-4);
                    CHECK(isNear(a.errors[q], b.errors[q], 1e-6, 0.0));
                    rendered += kinds[t] == TileKind::kPredicted && a.growth[q] > 1e-3;
                }
            }
            CHECK(twin.rgba == made.history.rgba);
        }
        CHECK(share(chosen_cost, all_cost) == within(0.5, 0.6));  // the budget, and the tile in which it ends
        CHECK(rendered > 40);
        CHECK(wider > 0.0);
        const double all = 2.0 * 768.0 * static_cast<double>(chosen.size());
        CHECK(isNear(result.half_loss, wider * gpu::kMeasuredParts / all, 0.01, 1e-6));
        CHECK(isNear(result.warp_error, left / all * std::min(sums.found / sums.expected, 1.0), 0.01, 1e-6));
    }
}

TEST_CASE_FIXTURE(Gpu, "every tile of a picture that moves has its turn, even where nothing looks wrong") {
    // Bars across the view, alternately near and far, in the background's colour: no block has a single
    // depth, and none looks wrong.
    std::vector<Splat> splats;
    for (int bar = -7; bar <= 7; ++bar) {
        const float z = bar % 2 == 0 ? 1.0f : 1.5f;
        splats.push_back({.position = {0.0f, 0.06f * z * static_cast<float>(bar), z},
                          .scale = z * glm::vec2(3.0f, 0.02f),
                          .opacity = 0.99f});
    }
    const ViewedScene view{"bars", makeScene(splats), makeEye({96, 64})};
    HistoryWalk walk(*this, view, walkSettings(false, glm::dvec3(0.5)));
    walk.go(0.0, 0.0);
    walk.go(5.0, 0.0);
    for (const int eye : {kLeft, kRight}) { CHECK(std::ranges::count(walk.read(eye).errors, 0u) == 0); }
}

TEST_CASE("what lies in a box is seen in its rectangle, also where the box reaches through the near plane") {
    const Eye eye = makeOddEye({200, 150});
    const glm::dmat3 camera_from_world = glm::mat3_cast(glm::conjugate(eye.world_from_camera.orientation));
    std::mt19937 random(11);
    const auto draw = [&] { return drawUnit(random); };
    std::size_t seen = 0, unseen_boxes = 0, through = 0;
    for (const SceneChange& box : boxesAbout(eye, 400, 1)) {
        const std::vector<gpu::ChangedRect> rects = rectsOf({&box, 1}, eye, 0.2);
        unseen_boxes += rects.empty();
        if (!rects.empty()) { CHECK(rects[0].error == gpu::kChangedError * box.amount); }
        bool is_before = false, is_behind = false;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 at =
                glm::mix(glm::dvec3(box.low), glm::dvec3(box.high), glm::dvec3(draw(), draw(), draw()));
            const glm::dvec3 c = camera_from_world * (at - eye.world_from_camera.position);
            (c.z < 0.2 ? is_behind : is_before) = true;
            const double x = eye.intrinsics.fx * c.x / c.z + eye.intrinsics.cx,
                         y = eye.intrinsics.fy * c.y / c.z + eye.intrinsics.cy;
            if (c.z < 0.2 || x < 0.0 || y < 0.0 || x >= 200.0 || y >= 150.0) { continue; }
            REQUIRE(rects.size() == 1);
            REQUIRE(x == within(rects[0].begin_px.x, rects[0].end_px.x));
            REQUIRE(y == within(rects[0].begin_px.y, rects[0].end_px.y));
            ++seen;
        }
        through += is_before && is_behind;
    }
    CHECK(seen > 1000);
    CHECK(unseen_boxes > 100);
    CHECK(through > 20);
}

TEST_CASE("a box before the eye has a rectangle of its size and the low-pass, others have none") {
    const Eye eye = makeEye({101, 101});
    const auto rectOf = [&](const glm::vec3& low, const glm::vec3& high) {
        const SceneChange box{low, high, 1.0f};
        return rectsOf({&box, 1}, eye, 0.2);
    };
    // A focal length of 100 px, centred on (50.5, 50.5).
    const auto rects = rectOf({-0.2f, 0.1f, 2.0f}, {0.1f, 0.2f, 2.0f});
    REQUIRE(rects.size() == 1);
    CHECK(these(rects[0].begin_px, rects[0].end_px) == these(glm::uvec2(37, 52), glm::uvec2(59, 64)));
    CHECK(rectOf({2.0f, 0.0f, 2.0f}, {3.0f, 1.0f, 2.0f}).empty());
    CHECK(rectOf({-1.0f, -1.0f, -3.0f}, {1.0f, 1.0f, 0.1f}).empty());
}

TEST_CASE("more changes than a picture takes are joined, and none is lost") {
    const Eye eye = makeEye({256, 256});
    std::vector<SceneChange> boxes;
    for (int i = 0; i < 1000; ++i) {
        const float x = -2.0f + 0.004f * static_cast<float>(i);
        boxes.push_back({{x, -0.1f, 2.0f}, {x + 0.001f, 0.1f, 2.0f}, i % 7 == 0 ? 1.0f : 0.5f});
    }
    const auto rects = rectsOf(boxes, eye, 0.2);
    CHECK(rects.size() <= kMostChanges);
    for (const SceneChange& box : boxes) {
        const auto alone = rectsOf({&box, 1}, eye, 0.2);
        if (alone.empty()) { continue; }
        CHECK(std::ranges::any_of(rects, [&](const gpu::ChangedRect& rect) {
            return glm::all(glm::lessThanEqual(rect.begin_px, alone[0].begin_px)) &&
                   glm::all(glm::greaterThanEqual(rect.end_px, alone[0].end_px)) &&
                   rect.error >= alone[0].error;
        }));
    }
}

TEST_CASE_FIXTURE(Gpu, "mark_changed gives the twin's errors") {
    for (const glm::uvec2 size_px : {glm::uvec2(16, 16), glm::uvec2(200, 150), glm::uvec2(333, 47)}) {
        Eye eye = makeOddEye(size_px);
        std::mt19937 random(2);
        std::vector<gpu::HistoryTile> tiles(tileCount(size_px));
        std::vector<reference::HistoryTile> twin;
        for (gpu::HistoryTile& tile : tiles) {
            tile.cost = static_cast<gpu::uint>(random() % 100);
            tile.age = static_cast<gpu::uint>(random() % 10);
            tile.growth = gpu::vec4(0.25f);
            for (int q = 0; q < 4; ++q) { tile.errors[q] = static_cast<float>(random() % 512) / 2048.0f; }
            twin.push_back(tileOf(tile));
        }
        const std::vector<gpu::ChangedRect> rects = rectsOf(boxesAbout(eye, 60, 3), eye, 0.2);
        REQUIRE(rects.size() >= 3);
        std::vector<reference::ChangedRect> twin_rects;
        for (const gpu::ChangedRect& rect : rects) {
            twin_rects.push_back({rect.begin_px, rect.end_px, static_cast<double>(rect.error)});
        }
        reference::markChanged(twin, size_px, twin_rects);
        const Buffer tile_buffer = upload("tiles", tiles), rect_buffer = upload("rects", rects);
        const gpu::MarkChangedPass pass{at(tile_buffer), at(rect_buffer), tilesOf(size_px),
                                        static_cast<gpu::uint>(rects.size())};
        dispatchOver(kernel(MarkChangedKernel{}), pass, tiles.size(), gpu::kWarpGroup);
        const auto marked = readBack<gpu::HistoryTile>(tile_buffer, tiles.size());
        std::size_t changed = 0;
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            const reference::HistoryTile got = tileOf(marked[t]);
            CHECK(these(got.cost, got.age) == these(twin[t].cost, twin[t].age));
            for (std::size_t q = 0; q < 4; ++q) {
                REQUIRE(std::abs(got.errors[q] - twin[t].errors[q]) < 1e-5);
            }
            changed += marked[t].errors != tiles[t].errors;
        }
        CHECK(changed > 0);
    }
}

}  // SUITE(history_passes)
