// Facts about the passes that reproject one eye's picture from the other's, reproject and newcomers
// (resample: resample_test.cpp), each started from the output of the twin's previous pass. Where a place lies
// on the border of a pixel, float32 may round to either side: there is a budget for such flips.
#include "tests/engine/passes/stereo_stages.h"

SUITE(stereo_passes) {

using reference::Arrival;
using reference::TileKind;

// Steps of the depth's 26 bits between two words.
gpu::uint stepsApart(gpu::uint a, gpu::uint b) { return std::max(a >> 6, b >> 6) - std::min(a >> 6, b >> 6); }

struct Newcomers {
    std::size_t found, expected;
    double error, expected_error, difference;  // sums over the tiles; the last of absolute differences
    std::size_t in_marked;                     // marked tiles that got an error
    std::size_t tiles, other_tiles;            // given one by the twin, and by only one of the two
    gpu::uint most;                            // steps of a tile
};

Newcomers findNewcomers(Gpu& gpu, const StereoCase& c, const std::vector<TileKind>& kinds) {
    const reference::Settings settings;
    const auto visible = reference::cull(c.scene, std::array{c.eyes.source, c.eyes.target}, settings);
    const auto order =
        reference::sortDepth(reference::compact(c.scene, visible, c.eyes.source, settings), settings);
    const auto source = reference::project(c.scene, order, c.eyes.source, settings),
               target = reference::project(c.scene, order, c.eyes.target, settings);
    const auto source_pairs = reference::bin(source, c.sizePx(), settings),
               target_pairs = reference::bin(target, c.sizePx(), settings);
    StereoOnDevice device = toDevice(gpu, c);
    std::vector<double> expected(device.tileCount(), 0.0);
    Newcomers newcomers{};
    newcomers.expected =
        reference::addNewcomers(expected, target, target_pairs, source_pairs, c.dominant, kinds, c.settings);
    device.write(device.tile_depths, depthsOfTiles(c));
    device.write(device.tile_kinds, kindsOf(kinds));
    std::vector<gpu::uint> source_tiles(order.size(), 0);
    for (const reference::TilePair& pair : source_pairs) { ++source_tiles[pair.splat]; }
    device.addNewcomers(SceneOnDevice(gpu, c.scene, {c.eyes.source, c.eyes.target}, settings.near), order,
                        source_tiles);
    newcomers.found = device.readCounters().newcomers;
    const auto errors = device.read(device.tile_errors);
    for (std::size_t t = 0; t < errors.size(); ++t) {
        const double error = errors[t] / static_cast<double>(gpu::kErrorSteps);
        newcomers.error += error;
        newcomers.expected_error += expected[t];
        newcomers.difference += std::abs(error - expected[t]);
        newcomers.tiles += expected[t] > 0.0;
        newcomers.other_tiles += (expected[t] > 0.0) != (errors[t] > 0);
        newcomers.most = std::max(newcomers.most, errors[t]);
        newcomers.in_marked += kinds[t] != TileKind::kNone && errors[t] != 0;
    }
    return newcomers;
}

// The number of newcomers among these splats, for an eye and one in its place, and the tiles' errors
// including what they add.
std::pair<gpu::uint, std::vector<gpu::uint>> addTo(Gpu& gpu, glm::uvec2 size_px,
                                                   const std::vector<Splat>& splats,
                                                   const std::vector<gpu::uint>& depths,
                                                   const std::vector<gpu::uint>& kinds,
                                                   const std::vector<gpu::uint>& errors) {
    const Eye eye = makeEye(size_px);
    const StereoCase c = computeEmpty({eye, eye});
    StereoOnDevice device = toDevice(gpu, c);
    device.write(device.tile_depths, depths);
    device.write(device.tile_kinds, kinds);
    device.write(device.tile_errors, errors);
    device.addNewcomers(SceneOnDevice(gpu, makeScene(splats), {eye, eye}, 0.2), numbersUpTo(splats.size()),
                        std::vector<gpu::uint>(splats.size(), 0));
    return {device.readCounters().newcomers, device.read(device.tile_errors)};
}

// Eyes side by side move pixels along rows, whatever their angles; canted ones do not.
TEST_CASE_FIXTURE(Gpu, "reproject brings what the twin brings, and nothing from beside what a lens hides") {
    struct Way {
        int gap_px;
        bool forward;
        Rows rows;
        bool hides = false;  // a lens hides some tiles, and nothing is moved from next to these
    };
    const std::array ways{Way{0, false, Rows::kOwn}, Way{2, false, Rows::kShared, true},
                          Way{5, false, Rows::kSharedHalves}, Way{20, false, Rows::kOwn},
                          Way{2, true, Rows::kShared}};
    std::size_t pixels = 0, all_other = 0, all_off_by_step = 0, held_back = 0;
    for (StereoCase c : makeStereoCases()) {
        const bool along_rows = c.name.find("canted") == std::string::npos;
        CHECK(relate(c.eyes.source, c.eyes.target).rectified == along_rows);
        for (const auto& [gap_px, forward, rows, hides] : ways) {
            INFO(c.name, ", gap px ", gap_px, ", forward ", forward, ", hides ", hides);
            c.settings.gap_px = gap_px;
            c.settings.forward = forward;
            c.settings.source_hidden.assign(hides ? tileCount(c.sizePx()) : 0, 0);
            for (std::size_t t = 1; t < c.settings.source_hidden.size(); t += 5) {
                c.settings.source_hidden[t] = 1;
            }
            StereoOnDevice device = toDevice(*this, c, rows);
            device.reproject(hides, forward);
            const auto expected = reference::reproject(c.dominant, c.eyes, c.settings);
            const auto words = device.readArrivals();
            std::size_t other = 0, off_by_step = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                // float32's interpolation may round a depth to the next step.
                const gpu::uint word = packArrival(expected[i]);
                const bool same = ((words[i] ^ word) & 63) == 0 && stepsApart(words[i], word) <= 1;
                other += !same;
                off_by_step += same && words[i] != word;
            }
            CHECK(other <= 3 + (hides ? 0 : words.size() / 2000));
            // Along rows depths are copied, so only interpolated ones can be rounded.
            if (along_rows && (gap_px == 0 || forward)) { CHECK(off_by_step == 0); }
            // What moved is unchanged.
            CHECK(device.readMoving() == movingOf(c.dominant, c.settings));
            pixels += words.size();
            all_other += other;
            all_off_by_step += off_by_step;
            if (!hides) { continue; }
            c.settings.source_hidden.clear();
            const auto unhidden = reference::reproject(c.dominant, c.eyes, c.settings);
            for (std::size_t i = 0; i < expected.size(); ++i) {
                held_back += expected[i].way == Arrival::kNone && unhidden[i].way != Arrival::kNone;
            }
        }
    }
    CHECK(held_back > 10000);
    CHECK(share(all_other, pixels) <= 0.0001);
    CHECK(share(all_off_by_step, pixels) <= 0.01);
}

TEST_CASE_FIXTURE(Gpu, "reproject fills a stretch that begins beyond the border") {
    // 10 px of disparity per unit of inverse depth: pixel 5 goes to -12, pixel 6 to 6.2, and all others out
    // of view to the left.
    const glm::uvec2 size_px(40, 1);
    StereoCase c = computeCase(pairOf(parallelEyes(size_px)), [](auto x, auto) {
        const double inverse_depth = x == 5 ? 1.75 : x == 6 ? 0.03 : 9.0;
        return ComputedPixel{glm::dvec4(1.0), inverse_depth, x == 6 ? 0x1p-4 : 0.0};
    });
    for (const auto& [gap_px, filled] : {std::pair(20, 6), std::pair(2, 0)}) {
        c.settings.gap_px = gap_px;
        StereoOnDevice device = toDevice(*this, c);
        device.reproject();
        const auto words = device.readArrivals();
        const auto expected = reference::reproject(c.dominant, c.eyes, c.settings);
        int between = 0;
        for (std::size_t x = 0; x < 40; ++x) {
            const Arrival arrival = unpackArrival(words[x]);
            CHECK(these(arrival.way, arrival.spread) == these(expected[x].way, expected[x].spread));
            between += arrival.way == Arrival::kBetween;
        }
        CHECK(between == filled);
    }
}

TEST_CASE_FIXTURE(Gpu, "newcomers finds the twin's splats and adds the twin's errors") {
    const ViewedScene room = viewBuiltin("builtin:atelier", {128, 96}, 20000), cloud = viewCloud({128, 96});
    const ViewedScene gaussians = viewGaussians({128, 96}, false), dimmed = viewGaussians({128, 96}, true);
    for (const auto& [view, eyes] : {std::pair(&room, headsetEyes(room.eye, 0.0)),
                                     std::pair(&room, headsetEyes(room.eye, glm::radians(5.0))),
                                     std::pair(&cloud, stereoPair(cloud.eye, 0.2)),
                                     std::pair(&gaussians, stereoPair(gaussians.eye, 0.2)),
                                     std::pair(&dimmed, stereoPair(dimmed.eye, 0.2))}) {
        for (const Side dominant : {kLeft, kRight}) {
            for (const bool whole : {false, true}) {
                Scene scene = view->scene;
                if (!whole) { hideWhatMeetsTheNearPlane(scene, eyes); }
                const StereoCase c = makeCase(view->name, scene, eyes, dominant);
                INFO(c.name, ", whole ", whole);
                const std::size_t tiles = tileCount(c.sizePx());
                const auto kinds = whole ? markSome(tiles) : std::vector(tiles, TileKind::kNone);
                const Newcomers newcomers = findNewcomers(*this, c, kinds);
                CHECK(newcomers.expected > 2);
                CHECK(newcomers.in_marked == 0);
                // No newcomer is lost. The device's outlines are slightly wider and it does not test pixel by
                // pixel, so splats that just miss the picture or fall between its pixels count, and boxes of
                // discs that meet the near plane are coarse (measured: 5 %; with such discs 1.3 times the
                // twin's error in the room, and 30 times in the cloud).
                CHECK(newcomers.found >= newcomers.expected);
                CHECK(newcomers.error >= 0.95 * newcomers.expected_error);
                if (whole) { continue; }
                CHECK(10 * newcomers.found <= 11 * newcomers.expected + 20);
                CHECK(newcomers.difference <= 0.08 * newcomers.expected_error + 0.1);
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "newcomers adds what a large splat brings to every tile, up to what a sum holds") {
    // Eyes that look past each other, and in front of one of them discs over nearly all of its 40x35 tiles.
    const glm::uvec2 size_px(640, 560);
    const auto eyeAt = [&](double x, double degrees) {
        const Eye eye{{.position = {x, 0.0, 0.0}}, intrinsicsFromFovX(glm::radians(20.0), size_px), size_px};
        return turned(eye, glm::radians(degrees));
    };
    const std::array eyes{eyeAt(-0.03, -12.0), eyeAt(0.03, 12.0)};
    const Pose& before = eyes[kRight].world_from_camera;
    struct Large {
        float scale;
        std::size_t splats;
        double newcomer_error;
        std::size_t least_tiles, most_tiles;
    };
    // About as many tiles as one thread still handles, and nearly all.
    for (const Large& large :
         {Large{0.004f, 1, 0.3, 30, 64}, Large{0.006f, 2, 0.3, 65, 150}, Large{0.03f, 1, 0.3, 1025, 1400},
          Large{0.03f, 1, 8.0, 1025, 1400}, Large{0.03f, 3, 8.0, 1025, 1400}}) {
        INFO("large.scale ", large.scale, ", large.newcomer error ", large.newcomer_error);
        const Splat splat{.position = glm::vec3(transform(before, {0.0, 0.0, 0.5})),
                          .rotation = glm::quat(before.orientation),
                          .scale = glm::vec2(large.scale)};
        StereoCase c = makeCase("large", makeScene(std::vector(large.splats, splat)), eyes, kLeft);
        c.settings.newcomer_error = large.newcomer_error;
        const Newcomers newcomers =
            findNewcomers(*this, c, std::vector(std::size_t{40} * 35, TileKind::kNone));
        CHECK(these(newcomers.found, newcomers.expected) == these(large.splats, large.splats));
        CHECK(these(newcomers.tiles, newcomers.other_tiles) ==
              these(within(large.least_tiles, large.most_tiles), 0));
        // Fractions of steps are cut off.
        CHECK(newcomers.difference <= 1e-4 * newcomers.expected_error);
        if (large.splats == 3) { CHECK(newcomers.most == 0x7fffffffu); }
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "newcomers compares with the middle of a tile, or with nothing if that does not move") {
    // Small discs of inverse depth 1/3 along the middle row. The first two share a tile, and the second
    // reaches beyond it.
    const glm::uvec2 size_px(64, 16);
    std::vector<Splat> splats;
    for (const double column : {6.5, 14.5, 24.5, 33.5, 56.5}) {
        splats.push_back(
            {.position = {(column - 32.0) * 3.0 / 100.0, 0.0f, 3.0f}, .scale = glm::vec2(0.02f)});
    }
    const gpu::uint near = packMoving(0.5, true, 0), far = packMoving(0.25, true, 0), nothing = 0;
    const auto found = [&](const std::vector<gpu::uint>& depths, const std::vector<gpu::uint>& kinds) {
        const auto [count, errors] =
            addTo(*this, size_px, splats, depths, kinds, std::vector<gpu::uint>(4, 0));
        std::string tiles = std::to_string(count);
        for (const gpu::uint error : errors) { tiles += error > 0 ? 'x' : '.'; }
        return tiles;
    };
    CHECK(found({near, far, far, far}, {0, 0, 0, 0}) == "3.xxx");
    CHECK(found({near, near, near, near}, {0, 0, 0, 0}) == "0....");
    CHECK(found({near, near, near, near}, {gpu::kTileCheap, 0, gpu::kTileEdge, 0}) == "3.x..");
    CHECK(found({nothing, nothing, nothing, nothing}, {0, 0, 0, 0}) == "5xxxx");
}

TEST_CASE_FIXTURE(Gpu, "newcomers stops a tile's error at what half a word holds, however many add to it") {
    // A thousand discs in front of one tile, each of which alone adds more than remains.
    const std::vector<Splat> splats(1000, {.position = {0.0f, 0.0f, 3.0f}, .scale = glm::vec2(0.2f)});
    for (const gpu::uint before : {0x7ffffff0u, 0x7fffffffu, 0x7fff0000u}) {
        const auto [count, errors] = addTo(*this, {16, 16}, splats, {0}, {0}, {before});
        CHECK(count == splats.size());
        CHECK(errors == std::vector{0x7fffffffu});
    }
}

}  // SUITE(stereo_passes)
