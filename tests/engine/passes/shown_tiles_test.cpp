// Facts about frames of which the lenses hide a part: what is hidden costs nothing and stays background, and nothing else changes.
#include "engine/picture/metrics.h"
#include "engine/reference/splat.h"
#include "tests/engine/frame/affiliated_frames.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_cases.h"

#include <doctest/doctest.h>

#include <algorithm>

TEST_SUITE_BEGIN("shown_tiles");

namespace shown_tiles_test {

using namespace binosplat;
using reference::TileKind;
using test::Gpu;
using test::ViewedScene;

namespace {

constexpr glm::uvec2 kSizePx(200, 152);  // 13 x 10 tiles, the last ones cut
constexpr glm::uvec2 kTiles(13, 10);
constexpr glm::dvec3 kBackground(0.125, 0.25, 0.5);

using Tiles = std::vector<std::uint8_t>;

// What a round lens leaves of a picture; the middle of what is shown lies a little towards the nose.
Tiles roundLens(Side side) {
    Tiles hidden;
    for (std::uint32_t y = 0; y < kTiles.y; ++y) {
        for (std::uint32_t x = 0; x < kTiles.x; ++x) {
            const glm::dvec2 middle(side == kLeft ? 0.54 : 0.46, 0.5);
            const glm::dvec2 near =
                glm::clamp(middle, glm::dvec2(x, y) / glm::dvec2(kTiles), glm::dvec2(x + 1, y + 1) / glm::dvec2(kTiles));
            hidden.push_back(glm::length(near - middle) > 0.45 ? 1 : 0);
        }
    }
    return hidden;
}

// Both lenses; stays as long as the settings that refer to it.
const std::array<Tiles, 2>& lenses() {
    static const std::array<Tiles, 2> both{roundLens(kLeft), roundLens(kRight)};
    return both;
}

std::uint64_t countHidden(Side side) { return static_cast<std::uint64_t>(std::ranges::count(lenses()[side], 1)); }

FrameSettings makeSettings(Mode mode, Side dominant, bool masked) {
    FrameSettings settings;
    settings.mode = mode;
    settings.dominant = dominant;
    settings.background = kBackground;
    settings.keep_both_depths = true;
    settings.stereo.center_rois = true;
    settings.stereo.margin_px = 8;
    if (masked) { settings.hidden_tiles = {lenses()[kLeft], lenses()[kRight]}; }
    return settings;
}

std::size_t tileOf(std::size_t pixel) { return pixel / kSizePx.x / 16 * kTiles.x + pixel % kSizePx.x / 16; }

bool samePixel(const Image& a, const Image& b, std::size_t i) {
    const auto channels = static_cast<std::size_t>(a.channels);
    return std::equal(&a.values[channels * i], &a.values[channels * i] + channels, &b.values[channels * i]);
}

// That hidden tiles are background and the others `whole`, byte for byte, or, where a tile's kind is listed, those of that kind.
void checkPicture(const Image& picture, const Image& whole, const Image& depth, Side side) {
    std::size_t not_background = 0, other = 0;
    for (std::size_t i = 0; i < picture.pixelCount(); ++i) {
        if (lenses()[side][tileOf(i)] == 0) {
            other += samePixel(picture, whole, i) ? 0 : 1;
        } else {
            const float* pixel = &picture.values[4 * i];
            const bool background = std::equal(pixel, pixel + 4, std::array{0.125f, 0.25f, 0.5f, 0.0f}.begin());
            not_background += background && depth.values[i] == 0.0f ? 0 : 1;
        }
    }
    CHECK(not_background == 0);
    CHECK(other == 0);
}

ViewedScene room() { return test::viewBuiltin("builtin:atelier", kSizePx, 20000); }

}  // namespace

TEST_CASE_FIXTURE(Gpu, "eyes in full lose their hidden tiles and the pairs of these, and no byte of the others") {
    const ViewedScene view = room();
    const auto eyes = test::headsetEyes(view.eye, glm::radians(4.0));
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared}) {
        for (const Side dominant : {kLeft, kRight}) {
            CAPTURE(static_cast<int>(dominant));
            const FrameResult whole = frame.render(eyes, makeSettings(mode, dominant, false));
            const std::array<Image, 2> expected{frame.readPicture(kLeft), frame.readPicture(kRight)};
            CHECK_FALSE(whole.counters.named().contains("tiles_hidden_left"));
            const FrameResult masked = frame.render(eyes, makeSettings(mode, dominant, true));
            for (const Side side : {kLeft, kRight}) {
                CHECK(countHidden(side) > 20);
                checkPicture(frame.readPicture(side), expected[side], frame.readDepth(side), side);
                const std::string suffix = side == kLeft ? "_left" : "_right";
                CHECK(masked.counters.named().at("tiles_hidden" + suffix) == countHidden(side));
                CHECK(masked.counters.named().at("tile_pairs" + suffix) <
                      0.95 * static_cast<double>(whole.counters.named().at("tile_pairs" + suffix)));
            }
            const auto& left_out = masked.left_out;
            CHECK(std::ranges::count_if(left_out, [](const std::string& s) { return s.find("its lens never shows them") != s.npos; }) == 2);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a masked eye is the twin's, pair for pair but for what lies within rounding of the cut") {
    const ViewedScene view = room();
    const reference::Settings twin_settings{.background = kBackground};
    const auto visible =
        reference::compact(view.scene, reference::cull(view.scene, {&view.eye, 1}, twin_settings), view.eye, twin_settings);
    const auto splats = reference::project(view.scene, reference::sortDepth(visible), view.eye, twin_settings);
    auto pairs = reference::bin(splats, kSizePx, twin_settings);
    reference::hidePairs(pairs, lenses()[kLeft]);
    reference::sortTiles(pairs);
    const auto twin = reference::rasterize(splats, pairs, reference::tileRanges(pairs, kSizePx), view.eye, twin_settings);

    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    const FrameResult result = frame.render({&view.eye, 1}, makeSettings(Mode::kMono, kLeft, true));
    CHECK(static_cast<double>(result.counters.named().at("tile_pairs")) ==
          doctest::Approx(static_cast<double>(pairs.size())).epsilon(0.02));
    CHECK(compare(frame.readPicture(0), test::toImage(twin), 4).psnrDb() >= 80.0);
}

TEST_CASE_FIXTURE(Gpu, "an eye made from the other under masks is the twin's, in kind, colour and depth") {
    const ViewedScene view = room(), fence = test::viewBuiltin("builtin:fence", kSizePx);
    struct Setting {
        const ViewedScene* view;
        std::array<Eye, 2> eyes;
    };
    for (const Setting& setting :
         {Setting{&view, test::headsetEyes(view.eye, 0.0)}, Setting{&view, test::headsetEyes(view.eye, glm::radians(4.0))},
          Setting{&fence, stereoPair(fence.eye, 0.12)}}) {
        Scene host_scene = setting.view->scene;
        test::hideWhatMeetsTheNearPlane(host_scene, setting.eyes);
        const GpuScene scene(context(), host_scene);
        StereoFrame frame(context(), scene);
        const test::KeptKernels kept(context(), frame);
        for (const TileChoice method : {TileChoice::kNone, TileChoice::kPaper, TileChoice::kPredicted}) {
            const Side dominant = method == TileChoice::kPaper ? kRight : kLeft, other = dominant == kLeft ? kRight : kLeft;
            const reference::StereoSettings twin_settings{.choice = method,
                                                          .margin_px = 8,
                                                          .center_rois = true,
                                                          .source_hidden = lenses()[dominant],
                                                          .target_hidden = lenses()[other]};
            const auto twin = reference::renderStereo(host_scene, {setting.eyes[dominant], setting.eyes[other]}, twin_settings,
                                                      {.background = kBackground});
            const Mode mode = method == TileChoice::kNone    ? Mode::kReproject
                              : method == TileChoice::kPaper ? Mode::kPaper
                                                             : Mode::kPredicted;
            const auto made = test::makeAffiliated(frame, setting.eyes, makeSettings(mode, dominant, true));
            const Image depth = frame.readDepth(other);
            CAPTURE(setting.view->name);
            CAPTURE(static_cast<int>(method));
            std::vector<std::uint32_t> same_kind;
            std::uint64_t hidden = 0, again = 0;
            for (std::size_t t = 0; t < twin.tile_kinds.size(); ++t) {
                same_kind.push_back(made.tile_kinds[t] == static_cast<std::uint32_t>(twin.tile_kinds[t]) ? 1 : 0);
                CHECK((made.tile_kinds[t] == gpu::kTileHidden) == (lenses()[other][t] != 0));
                hidden += made.tile_kinds[t] == gpu::kTileHidden ? 1 : 0;
                again += made.tile_kinds[t] != 0 && made.tile_kinds[t] != gpu::kTileHidden ? 1 : 0;
            }
            // Measured: five in one frame, where a splat that is large for its tiles is seen by the dominant eye within a hair, or is not.
            CHECK(std::ranges::count(same_kind, 0u) <= (method == TileChoice::kPredicted ? 6 : 0));
            CHECK(made.result.counters.named().at("tiles_patched") == again);
            // The budget is a share of what is shown. The device's pairs are the twin's and few more.
            const auto& counters = made.result.counters.named();
            std::uint64_t predicted_cost = 0;
            for (std::size_t t = 0; t < twin.tile_costs.size(); ++t) {
                predicted_cost += made.tile_kinds[t] == gpu::kTilePredicted ? twin.tile_costs[t] : 0;
            }
            if (method == TileChoice::kPredicted) {
                CHECK(static_cast<double>(predicted_cost) <= twin_settings.budget * static_cast<double>(counters.at("work_full")));
            }
            // Only pixels that were moved are counted, before any tile is rendered for what is wrong with them.
            std::uint64_t moved_px = 0;
            for (std::size_t i = 0; i < depth.pixelCount(); ++i) {
                const std::uint32_t kind = made.tile_kinds[tileOf(i)];
                moved_px += kind == 0 || kind == gpu::kTileCenter || kind == gpu::kTilePredicted ? 1 : 0;
            }
            CHECK(counters.at("pixels_covered") + counters.at("pixels_gap") + counters.at("pixels_hole") == moved_px);

            reference::Picture expected;
            expected.size_px = kSizePx;
            expected.rgba = twin.affiliated;
            CHECK(compare(test::keepTiles(made.pictures[other], same_kind), test::keepTiles(test::toImage(expected), same_kind), 4)
                      .psnrDb() >= 80.0);
            std::size_t other_depth = 0;
            for (std::size_t i = 0; i < depth.pixelCount(); ++i) {
                const double d = static_cast<double>(depth.values[i]), e = twin.affiliated_depth[i];
                other_depth += same_kind[tileOf(i)] != 0 && !(std::abs(d - e) <= 1e-3 * std::abs(e) + 1e-4) ? 1 : 0;
            }
            CHECK(other_depth * 200 <= depth.pixelCount());
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "what one lens hides and the other shows is rendered for that other") {
    const ViewedScene view = room();
    // Canted, where patches follow their own order and so are the full picture bit for bit.
    const auto eyes = test::headsetEyes(view.eye, glm::radians(4.0));
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    frame.render(eyes, makeSettings(Mode::kShared, kLeft, false));
    const Image whole = frame.readPicture(kRight);
    // The left lens hides all of the right half: what is made of the other half reaches nowhere near.
    Tiles right_half;
    for (std::uint32_t t = 0; t < kTiles.x * kTiles.y; ++t) { right_half.push_back(t % kTiles.x >= 6 ? 1 : 0); }
    for (const Mode mode : {Mode::kPaper, Mode::kPredicted}) {
        FrameSettings settings = makeSettings(mode, kLeft, false);
        settings.stereo.center_rois = false;
        settings.hidden_tiles[kLeft] = right_half;
        const auto made = test::makeAffiliated(frame, eyes, settings);
        std::size_t wrong = 0, beyond = 0;
        for (std::size_t i = 0; i < whole.pixelCount(); ++i) {
            // The right eye looks further out, so that even its middle looks at what the left one hides.
            if (i % kSizePx.x < 8 * 16) { continue; }
            ++beyond;
            wrong += samePixel(made.pictures[kRight], whole, i) ? 0 : 1;
        }
        CHECK(beyond > 0);
        CHECK(wrong == 0);
        CHECK(made.result.counters.named().at("tiles_edge") >= 5 * kTiles.y);
    }
}

TEST_CASE_FIXTURE(Gpu, "masks come, change and go between frames") {
    const ViewedScene view = room();
    const auto eyes = test::headsetEyes(view.eye, 0.0);
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    for (const Mode mode : {Mode::kPredicted, Mode::kPaper, Mode::kShared}) {
        const auto read = [&] { return std::array{frame.readPicture(kLeft).values, frame.readPicture(kRight).values}; };
        const FrameSettings without = makeSettings(mode, kLeft, false), with = makeSettings(mode, kLeft, true);
        FrameSettings swapped = with;
        swapped.hidden_tiles = {lenses()[kRight], lenses()[kLeft]};
        frame.render(eyes, without);
        const auto whole = read();
        frame.render(eyes, with);
        const auto masked = read();
        CHECK(masked != whole);
        frame.render(eyes, swapped);
        CHECK(read() != masked);
        frame.render(eyes, with);
        CHECK(read() == masked);
        frame.render(eyes, without);
        CHECK(read() == whole);
    }
    // Lists that grow in the first frame that has the mask.
    StereoFrame small(context(), scene, {.first_capacity = {1, 1}, .threads_per_cell = 0});
    small.render(eyes, makeSettings(Mode::kPredicted, kLeft, true));
    frame.render(eyes, makeSettings(Mode::kPredicted, kLeft, true));
    for (const int e : {kLeft, kRight}) { CHECK(small.readPicture(e).values == frame.readPicture(e).values); }
    // And all of it hidden.
    const Tiles all(kTiles.x * kTiles.y, 1);
    FrameSettings settings = makeSettings(Mode::kPredicted, kLeft, false);
    settings.hidden_tiles = {all, all};
    const FrameResult nothing = frame.render(eyes, settings);
    CHECK(nothing.counters.named().at("tile_pairs_left") + nothing.counters.named().at("tile_pairs_right") == 0);
    CHECK(nothing.counters.named().at("tiles_patched") == 0);
}

TEST_CASE_FIXTURE(Gpu, "the affiliated eye's depth is there in every mode, the rendered one's where tiles are rendered again") {
    // A wall has one depth a pixel; the room's pixels blend many, whose mean is not what moves them.
    const ViewedScene wall = test::viewBuiltin("builtin:slanted-wall", kSizePx), many = room();
    for (const ViewedScene* view : {&wall, &many}) {
        CAPTURE(view->name);
        const auto eyes = test::headsetEyes(view->eye, glm::radians(4.0));
        const GpuScene scene(context(), view->scene);
        StereoFrame frame(context(), scene);
        const test::KeptKernels kept(context(), frame);
        frame.render(eyes, makeSettings(Mode::kShared, kLeft, false));
        const Image full = frame.readPicture(kRight), full_depth = frame.readDepth(kRight);
        for (const Mode mode : {Mode::kReproject, Mode::kPaper, Mode::kPredicted}) {
            CAPTURE(static_cast<int>(mode));
            const auto made = test::makeAffiliated(frame, eyes, makeSettings(mode, kLeft, false));
            const Image depth = frame.readDepth(kRight);
            std::size_t wrong_again = 0, again = 0, near = 0, rest = 0;
            for (std::size_t i = 0; i < depth.pixelCount(); ++i) {
                if (made.tile_kinds[tileOf(i)] != 0) {
                    ++again;
                    wrong_again += depth.values[i] == full_depth.values[i] ? 0 : 1;
                } else if (made.pixel_classes[i] == gpu::kCovered && full.values[4 * i + 3] > 0.5f) {
                    ++rest;
                    const float mean = depth.values[i] / made.pictures[kRight].values[4 * i + 3];
                    near += std::abs(mean / (full_depth.values[i] / full.values[4 * i + 3]) - 1.0f) < 0.02f ? 1 : 0;
                }
            }
            CHECK((mode == Mode::kReproject) == (again == 0));
            CHECK(wrong_again == 0);
            CHECK(static_cast<double>(near) > (view == &wall ? 0.95 : 0.1) * static_cast<double>(rest));
        }
        FrameSettings without = makeSettings(Mode::kPredicted, kLeft, false);
        without.keep_both_depths = false;
        frame.render(eyes, without);
        CHECK(frame.picture(kRight).depths.bytes() == 0);
    }
}

}  // namespace shown_tiles_test
