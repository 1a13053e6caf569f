// Facts about the paper's choice of tiles, by depth_bounds, edge_rois and components: compared with the twin,
// and computed by hand.
#include "tests/engine/passes/stereo_stages.h"

SUITE(tile_choice) {

using reference::Borders;
using reference::DepthChoice;
using reference::PixelClass;
using reference::Resolved;
using reference::TileKind;

StereoCase makePlainCase(glm::uvec2 size_px, Side dominant = kLeft) {
    StereoCase c = computeEmpty(pairOf(parallelEyes(size_px), dominant));
    c.settings.choice = TileChoice::kPaper;
    return c;
}

using Mask = std::vector<std::uint8_t>;

Mask drawMask(glm::uvec2 size_px, const auto& isHole) {
    Mask mask;
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        for (std::uint32_t x = 0; x < size_px.x; ++x) { mask.push_back(isHole(x, y) ? 1 : 0); }
    }
    return mask;
}

// Compares components with the twin's flood fill, on a mask of holes, none of them in tiles that were marked
// before. Returns how many there are.
std::size_t checkComponents(Gpu& gpu, glm::uvec2 size_px, const Mask& mask, int margin_px,
                            std::uint32_t boxes, bool edges) {
    // Half floats and floats in turn.
    const Rows rows = margin_px % 2 == 0 ? Rows::kSharedHalves : Rows::kShared;
    const std::size_t words_per_pixel = areHalves(rows) ? 2 : 4;
    StereoCase c = makePlainCase(size_px);
    c.settings.margin_px = margin_px;
    std::vector<TileKind> kinds = reference::markEdges(edges ? Borders{17, 0, 1, 20} : Borders{}, size_px);
    std::vector<Resolved> resolved;
    std::vector<std::uint8_t> classes;
    // In the state in which resample leaves them: holes are their own parents, and everything else is a
    // colour.
    std::vector<gpu::uint> words(words_per_pixel * mask.size(), 0x3f000000u);
    for (std::size_t i = 0; i < mask.size(); ++i) {
        const PixelClass pixel_class = mask[i] != 0 ? PixelClass::kHole
                                       : i % 5 == 0 ? PixelClass::kGap
                                                    : PixelClass::kCovered;
        resolved.push_back({pixel_class, static_cast<std::uint32_t>(i % size_px.x), 0.5, 0});
        const bool moved = kinds[tileOf(i, size_px)] == TileKind::kNone;
        classes.push_back(moved ? static_cast<std::uint8_t>(pixel_class) : 0);
        if (moved && mask[i] != 0) { words[words_per_pixel * i] = static_cast<gpu::uint>(i); }
    }
    StereoOnDevice device(gpu, viewOfCase(c), {}, {}, rows, boxes);
    device.write(device.tile_kinds, kindsOf(kinds));
    device.writeClasses(classes);
    device.write(device.affiliated, words);
    device.findComponents();
    const std::size_t components = reference::markComponents(resolved, kinds, size_px, margin_px, boxes);
    const gpu::WarpCounters counters = device.readCounters();
    CHECK(these(counters.components, counters.center_tiles) ==
          these(components, std::ranges::count(kinds, TileKind::kCenter)));
    CHECK(these(device.read(device.tile_kinds), device.readClasses()) == these(kindsOf(kinds), classes));
    // Except for the holes, nothing has changed.
    auto after = device.read(device.affiliated);
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (classes[i / words_per_pixel] == static_cast<std::uint8_t>(PixelClass::kHole)) {
            after[i] = words[i];
        }
    }
    CHECK(after == words);
    return components;
}

TEST_CASE_FIXTURE(Gpu, "depth_bounds counts what is out of range as the last, and faint pixels not at all") {
    StereoCase c = makePlainCase({20, 10});
    const std::array<double, 5> inverse_depths{1.0, 1e-9, 1e9, 0.25, -1.0};
    for (std::size_t i = 0; i < c.dominant.rgba.size(); ++i) {
        c.dominant.rgba[i].w = i % 2 == 0 ? 1.0 : 0.5;
        c.dominant.inverse_depth[i] = c.dominant.rgba[i].w * inverse_depths[i / 2 % 5];
    }
    StereoOnDevice device = toDevice(*this, c);
    device.boundDepths();
    std::vector<gpu::uint> expected(gpu::kDepthBins, 0);
    // These come from five rows.
    expected[16 * 32] = expected[gpu::kDepthBins - 1] = expected[0] = expected[18 * 32] = 10;
    CHECK(device.read(device.bins) == expected);
    CHECK(reference::boundDepths(c.dominant, DepthChoice::kInverse) == expected);
}

TEST_CASE("edge ROIs of parallel eyes, by hand") {
    struct Roi {
        Side dominant;
        int margin_px;
        bool tight_edges;
        Borders borders;
    };
    // At depths 1 and 4, pixels move to the left by 10 and by 2.5 px. The right edge's last pixel, 127 in the
    // paper's count, is at 117 and 124.5, so u_max = 124.5 and right_w = 127 - 124 + 32. Left, top and
    // bottom: u_min = -10, v_min = 0, v_max = H - 1, so nothing. Tight: what near content uncovers, from 117
    // on. In the other direction u_min = 2.5 and at most 10: left_w = 3, or 10, plus the margin; never more
    // than half of the width.
    for (const Roi& roi : {Roi{kLeft, 32, false, {0, 0, 35, 0}}, Roi{kLeft, 0, true, {0, 0, 10, 0}},
                           Roi{kRight, 32, false, {35, 0, 0, 0}}, Roi{kRight, 62, false, {64, 0, 0, 0}},
                           Roi{kRight, 0, false, {3, 0, 0, 0}}, Roi{kRight, 0, true, {10, 0, 0, 0}}}) {
        StereoCase c = makePlainCase({128, 96}, roi.dominant);
        c.settings.margin_px = roi.margin_px;
        c.settings.tight_edges = roi.tight_edges;
        CHECK(reference::findBorders({0.25, 1.0}, c.eyes, c.settings) == roi.borders);
    }
}

TEST_CASE_FIXTURE(Gpu, "depth_bounds counts the twin's depths, and edge_rois finds its borders and tiles") {
    std::uint32_t all_flips = 0;
    for (StereoCase c : makeStereoCases()) {
        // What is seen; nothing; 1000 pixels, of which the five nearest and the five farthest are specks; the
        // same with six near ones, which are none.
        std::vector<std::vector<gpu::uint>> bins(4, std::vector<gpu::uint>(gpu::kDepthBins, 0));
        for (const std::size_t i : {2, 3}) {
            bins[i][100] = i == 2 ? 5 : 6;
            bins[i][512] = bins[i][512 + 4 * 32 - 1] = 495;
            bins[i][900] = 5;
        }
        for (const Rows rows : {Rows::kOwn, Rows::kShared, Rows::kSharedHalves}) {
            if (areHalves(rows)) { roundToHalves(c.dominant); }
            INFO(c.name, ", rows ", static_cast<int>(rows));
            StereoOnDevice device = toDevice(*this, c, rows);
            device.boundDepths();
            bins[0] = device.read(device.bins);
            const auto expected = reference::boundDepths(c.dominant, c.settings.depth_choice);
            std::uint32_t flips = 0;
            for (std::size_t b = 0; b < expected.size(); ++b) {
                flips += std::max(bins[0][b], expected[b]) - std::min(bins[0][b], expected[b]);
            }
            CHECK(std::accumulate(bins[0].begin(), bins[0].end(), 0u) ==
                  std::accumulate(expected.begin(), expected.end(), 0u));
            CHECK(flips <= 2);
            all_flips += flips;
        }
        for (unsigned way = 0; way < 18; ++way) {
            const std::vector<gpu::uint>& counted = bins[way < 12 ? 0 : 1 + way % 3];
            c.settings.margin_px = way % 2 == 0 ? 0 : 32;
            c.settings.tight_edges = way / 2 % 2 != 0;
            c.settings.edge_samples = std::array{1, 64, 300}[way / 4 % 3];
            INFO(c.name, ", way ", way);
            StereoOnDevice device = toDevice(*this, c);
            device.write(device.bins, counted);
            device.findEdgeRois();
            const Borders expected =
                reference::findBorders(reference::findInverseDepthBounds(counted), c.eyes, c.settings);
            const auto kinds = kindsOf(reference::markEdges(expected, c.sizePx()));
            const gpu::WarpCounters counters = device.readCounters();
            CHECK(counters.borders_px ==
                  glm::uvec4(expected.left, expected.top, expected.right, expected.bottom));
            CHECK(device.read(device.tile_kinds) == kinds);
            CHECK(counters.edge_tiles == std::ranges::count(kinds, gpu::kTileEdge));
        }
    }
    CHECK(all_flips <= 4);  // measured: none
}

TEST_CASE_FIXTURE(Gpu, "edge_rois marks what the dominant lens hides, and leaves hidden tiles as they are") {
    for (const glm::uvec2 size_tiles : {glm::uvec2(8, 6), glm::uvec2(43, 3), glm::uvec2(33, 31)}) {
        for (const Side dominant : {kLeft, kRight}) {
            StereoCase c = makePlainCase(16u * size_tiles - 3u, dominant);
            c.settings.margin_px = 5;
            std::mt19937 random(3);
            for (std::uint32_t t = 0; t < size_tiles.x * size_tiles.y; ++t) {
                c.settings.source_hidden.push_back(random() % 10 == 0 ? 1 : 0);
                c.settings.target_hidden.push_back(random() % 10 == 0 ? 1 : 0);
            }
            std::vector<gpu::uint> bins(gpu::kDepthBins, 0);
            bins[500] = bins[600] = 1000;
            StereoOnDevice device = toDevice(*this, c);
            std::vector<TileKind> before(device.tileCount(), TileKind::kNone);
            reference::markHidden(before, c.settings);
            device.write(device.tile_kinds, kindsOf(before));
            device.write(device.bins, bins);
            device.findEdgeRois(/*hidden_tiles=*/true);
            const Borders borders =
                reference::findBorders(reference::findInverseDepthBounds(bins), c.eyes, c.settings);
            auto expected = reference::markEdges(borders, c.sizePx());
            const auto without_lens = std::ranges::count(expected, TileKind::kEdge);
            reference::markHidden(expected, c.settings);
            reference::markBehindHidden(expected, c.eyes, c.settings);
            CHECK(device.read(device.tile_kinds) == kindsOf(expected));
            CHECK(device.readCounters().edge_tiles == std::ranges::count(expected, TileKind::kEdge));
            CHECK(std::ranges::count(expected, TileKind::kEdge) > without_lens);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "components groups holes as a flood fill does, whatever their shape") {
    std::mt19937 random(1);
    for (const glm::uvec2 size_px : {glm::uvec2(1, 1), glm::uvec2(17, 33), glm::uvec2(128, 96)}) {
        CAPTURE(size_px.x);
        // A path that winds from row to row, two pixels apart from itself: the longest a component can take.
        const Mask winding = drawMask(
            size_px, [&](auto x, auto y) { return y % 2 == 0 || x == (y % 4 == 1 ? size_px.x - 1 : 0); });
        std::vector<Mask> masks{
            drawMask(size_px, [](auto, auto) { return false; }),
            drawMask(size_px, [](auto, auto) { return true; }),
            drawMask(size_px, [](auto x, auto y) { return (x + y) % 2 == 0; }),
            drawMask(size_px, [&](auto x, auto y) { return x == size_px.x - 1 && y == size_px.y - 1; }),
            drawMask(size_px, [](auto x, auto) { return x % 2 == 0; }),
            drawMask(size_px, [](auto x, auto y) { return x % 3 == 0 && y % 3 == 0; }),
            winding};
        for (const unsigned share : {2u, 20u, 45u, 70u}) {
            masks.push_back(drawMask(size_px, [&](auto, auto) { return random() % 100 < share; }));
        }
        for (std::size_t m = 0; m < masks.size(); ++m) {
            CAPTURE(m);
            for (const int margin_px : {5, 32}) {
                checkComponents(*this, size_px, masks[m], margin_px, 4096, m % 2 == 1);
            }
            const std::size_t components = checkComponents(*this, size_px, masks[m], 0, 4096, false);
            if (m == 1 || m == 6) { CHECK(components == 1); }
        }
    }
    // With more groups than boxes, the tiles of each pixel are marked, the same ones in every run. Scattered
    // pixels; and an L, whose box contains tiles that its pixels do not touch, and two specks.
    const glm::uvec2 size_px(128, 96);
    for (const Mask& mask : {drawMask(size_px, [&](auto, auto) { return random() % 1000 < 4; }),
                             drawMask(size_px, [](auto x, auto y) {
                                 return (x == 2 && y < 90) || (y == 90 && x > 1 && x < 120) ||
                                        (y == 10 && (x == 60 || x == 100));
                             })}) {
        for (const std::uint32_t boxes : {1u, 1u, 2u, 3u, 8u, 8u}) {
            CAPTURE(boxes);
            checkComponents(*this, size_px, mask, 4, boxes, false);
        }
    }
}

}  // SUITE(tile_choice)
