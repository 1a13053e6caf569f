// Facts about frames of which lenses hide a part, which costs nothing and changes nothing else, and about
// gazes in such frames.
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_cases.h"

SUITE(shown_tiles) {

constexpr glm::uvec2 kSizePx(200, 152);  // 13 x 10 tiles, the last ones cut
constexpr glm::uvec2 kTiles(13, 10);
constexpr glm::dvec3 kBackground(0.125, 0.25, 0.5);

using Tiles = std::vector<std::uint8_t>;

// What a round lens leaves of a picture; the middle of the visible part lies slightly towards the nose.
Tiles roundLens(Side side) {
    Tiles hidden;
    for (std::uint32_t y = 0; y < kTiles.y; ++y) {
        for (std::uint32_t x = 0; x < kTiles.x; ++x) {
            const glm::dvec2 middle(side == kLeft ? 0.54 : 0.46, 0.5);
            const glm::dvec2 near = glm::clamp(middle, glm::dvec2(x, y) / glm::dvec2(kTiles),
                                               glm::dvec2(x + 1, y + 1) / glm::dvec2(kTiles));
            hidden.push_back(glm::length(near - middle) > 0.45 ? 1 : 0);
        }
    }
    return hidden;
}

// Both lenses; must live as long as the settings that refer to it.
const std::array<Tiles, 2>& lenses() {
    static const std::array<Tiles, 2> both{roundLens(kLeft), roundLens(kRight)};
    return both;
}

std::uint64_t countHidden(Side side) {
    return static_cast<std::uint64_t>(std::ranges::count(lenses()[side], 1));
}

FrameSettings makeSettings(Mode mode, Side dominant, bool masked) {
    FrameSettings settings = test::makeSettings(mode, dominant);
    settings.background = kBackground;
    settings.keep_both_depths = true;
    settings.stereo.center_rois = true;
    settings.stereo.margin_px = 8;
    if (masked) { settings.hidden_tiles = {lenses()[kLeft], lenses()[kRight]}; }
    return settings;
}

// Hidden tiles must be background and the others `whole`, byte for byte.
void checkPicture(const Image& picture, const Image& whole, const Image& depth, Side side) {
    std::size_t not_background = 0, other = 0;
    for (std::size_t i = 0; i < picture.pixelCount(); ++i) {
        const float* pixel = &picture.values[4 * i];
        if (lenses()[side][tileOf(i, kSizePx)] == 0) {
            other += !std::equal(pixel, pixel + 4, &whole.values[4 * i]);
        } else {
            not_background += depth.values[i] != 0.0f ||
                              !std::equal(pixel, pixel + 4, std::array{0.125f, 0.25f, 0.5f, 0.0f}.begin());
        }
    }
    CHECK(these(not_background, other) == these(0u, 0u));
}

TEST_CASE_FIXTURE(Gpu, "eyes in full lose their hidden tiles and the pairs of these, and nothing else") {
    const ViewedScene view = viewAtelier(kSizePx);
    const auto eyes = headsetEyes(view.eye, glm::radians(4.0));
    KeptFrame frame(context(), view.scene);
    for (const auto& [mode, dominant] : {std::pair(Mode::kMono, kLeft), std::pair(Mode::kTwoPass, kRight),
                                         std::pair(Mode::kShared, kLeft), std::pair(Mode::kShared, kRight)}) {
        INFO("mode ", static_cast<int>(mode), ", dominant ", static_cast<int>(dominant));
        const auto seen = std::span(eyes).first(mode == Mode::kMono ? 1 : 2);
        const FrameResult whole = frame.render(seen, makeSettings(mode, dominant, false));
        std::vector<Image> expected;
        for (std::size_t e = 0; e < seen.size(); ++e) {
            expected.push_back(frame.readPicture(static_cast<int>(e)));
        }
        CHECK_FALSE(
            whole.counters.named().contains(mode == Mode::kMono ? "tiles_hidden" : "tiles_hidden_left"));
        const FrameResult masked = frame.render(seen, makeSettings(mode, dominant, true));
        for (std::size_t e = 0; e < seen.size(); ++e) {
            const Side side = e == 0 ? kLeft : kRight;
            CHECK(countHidden(side) > 20);
            checkPicture(frame.readPicture(side), expected[e], frame.readDepth(side), side);
            const std::string suffix = mode == Mode::kMono ? "" : side == kLeft ? "_left" : "_right";
            CHECK(masked.counters.named().at("tiles_hidden" + suffix) == countHidden(side));
            CHECK(100 * masked.counters.named().at("tile_pairs" + suffix) <
                  95 * whole.counters.named().at("tile_pairs" + suffix));
        }
        CHECK(std::ranges::count_if(masked.left_out, [](const std::string& line) {
                  return contains(line, "its lens never shows them");
              }) == std::ssize(seen));
    }
}

TEST_CASE_FIXTURE(Gpu, "an eye made from the other under masks is the twin's, in kind, colour and depth") {
    const ViewedScene view = viewAtelier(kSizePx), fence = viewBuiltin("builtin:fence", kSizePx);
    const auto straight = headsetEyes(view.eye, 0.0), canted = headsetEyes(view.eye, glm::radians(4.0)),
               before_fence = stereoPair(fence.eye, 0.12);
    const std::array seen_by{std::pair(&view, &straight), std::pair(&view, &canted),
                             std::pair(&fence, &before_fence)};
    for (std::size_t way = 0; way < 9; ++way) {
        const auto& [seen, eyes] = seen_by[way / 3];
        const Mode mode = std::array{Mode::kReproject, Mode::kPaper, Mode::kPredicted}[way % 3];
        INFO(seen->name, ", way ", way);
        Scene scene = seen->scene;
        hideWhatMeetsTheNearPlane(scene, *eyes);
        KeptFrame frame(context(), scene);
        const Side dominant = mode == Mode::kPaper ? kRight : kLeft,
                   other = dominant == kLeft ? kRight : kLeft;
        const reference::StereoSettings twin_settings{.choice = choiceOf(mode),
                                                      .margin_px = 8,
                                                      .center_rois = true,
                                                      .source_hidden = lenses()[dominant],
                                                      .target_hidden = lenses()[other]};
        const auto [made, depth, twin, same_kind] =
            makeWithTwin(frame, scene, *eyes, twin_settings, makeSettings(mode, dominant, true));
        std::uint64_t again = 0, predicted_cost = 0;
        for (std::size_t t = 0; t < twin.tile_kinds.size(); ++t) {
            CHECK((made.tile_kinds[t] == gpu::kTileHidden) == (lenses()[other][t] != 0));
            again += made.tile_kinds[t] != 0 && made.tile_kinds[t] != gpu::kTileHidden;
            predicted_cost += made.tile_kinds[t] == gpu::kTilePredicted ? twin.tile_costs[t] : 0;
        }
        // Measured: five in one frame, where a splat that is large for its tiles is only just visible to the
        // dominant eye, or just not.
        CHECK(std::ranges::count(same_kind, 0u) <= (mode == Mode::kPredicted ? 6 : 0));
        CHECK(countOf(made.result, "tiles_patched") == again);
        // The budget is a share of what is shown. The device has the twin's pairs and few more.
        if (mode == Mode::kPredicted) {
            CHECK(static_cast<double>(predicted_cost) <=
                  twin_settings.budget * static_cast<double>(countOf(made.result, "work_full")));
        }
        // Only reprojected pixels are counted, before any tile is rendered for its errors.
        std::uint64_t moved_px = 0, other_depth = 0;
        for (std::size_t i = 0; i < depth.pixelCount(); ++i) {
            const std::size_t tile = tileOf(i, kSizePx);
            const std::uint32_t kind = made.tile_kinds[tile];
            moved_px += kind == 0 || kind == gpu::kTileCenter || kind == gpu::kTilePredicted;
            const double d = static_cast<double>(depth.values[i]), e = twin.affiliated_depth[i];
            other_depth += same_kind[tile] != 0 && !(std::abs(d - e) <= 1e-3 * std::abs(e) + 1e-4);
        }
        CHECK(countOf(made.result, "pixels_covered") + countOf(made.result, "pixels_gap") +
                  countOf(made.result, "pixels_hole") ==
              moved_px);
        CHECK(other_depth * 200 <= depth.pixelCount());
        FrameSettings without = makeSettings(mode, dominant, true);
        without.keep_both_depths = false;
        frame.render(*eyes, without);
        CHECK(frame.picture(other).depths.bytes() == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "for a gaze, the choice of tiles is the twin's, and so are rows that become means") {
    auto view = viewAtelier({256, 192});
    const auto eyes = headsetEyes(view.eye, glm::radians(5.0));
    hideWhatMeetsTheNearPlane(view.scene, eyes);
    KeptFrame frame(context(), view.scene);
    std::size_t chosen = 0, chosen_everywhere = 0;
    for (const Side dominant : {kLeft, kRight}) {
        CAPTURE(static_cast<int>(dominant));
        // A picture this small shows more than the eye resolves only far from the gaze.
        const Gaze gaze{{dominant == kLeft ? -3.0 : 3.0, 0.5, 1.0}, 0.0};
        reference::StereoSettings twin_settings{.budget = 0.2};
        twin_settings.target_gaze = reference::Gaze{gaze.direction, gaze.clear_rad};
        FrameSettings settings = test::makeSettings(Mode::kPredicted, dominant);
        settings.keep_both_depths = true;
        settings.stereo = settingsOf(twin_settings);
        const AffiliatedFrame everywhere = makeAffiliated(frame, eyes, settings);
        const std::size_t other = 1 - static_cast<std::size_t>(dominant);
        settings.gazes[other] = gaze;
        const auto [made, depth, twin, same_kind] =
            makeWithTwin(frame, view.scene, eyes, twin_settings, settings);
        CHECK(std::ranges::count(same_kind, 0u) <= 1);
        chosen += countOf(made.result, "tiles_predicted");
        chosen_everywhere += countOf(everywhere.result, "tiles_predicted");
        // The dominant eye's gaze tells nothing about the affiliated eye's tiles.
        settings.gazes = {};
        settings.gazes[static_cast<std::size_t>(dominant)] = gaze;
        CHECK(makeAffiliated(frame, eyes, settings).tile_kinds == everywhere.tile_kinds);
    }
    CHECK(chosen == between(0, chosen_everywhere));
}

TEST_CASE_FIXTURE(Gpu, "lists may grow in a frame with masks, and where all is hidden there is no work") {
    const ViewedScene view = viewAtelier(kSizePx);
    const auto eyes = headsetEyes(view.eye, 0.0);
    const GpuScene scene(context(), view.scene);
    KeptFrame frame(context(), scene);
    StereoFrame small(context(), scene, {.first_capacity = {1, 1}, .threads_per_cell = 0});
    small.render(eyes, makeSettings(Mode::kPredicted, kLeft, true));
    frame.render(eyes, makeSettings(Mode::kPredicted, kLeft, true));
    CHECK(shownBy(small) == shownBy(frame));
    const Tiles all(kTiles.x * kTiles.y, 1);
    FrameSettings settings = makeSettings(Mode::kPredicted, kLeft, false);
    settings.hidden_tiles = {all, all};
    const FrameResult nothing = frame.render(eyes, settings);
    CHECK(countOf(nothing, "tile_pairs_left") + countOf(nothing, "tile_pairs_right") == 0);
    CHECK(countOf(nothing, "tiles_patched") == 0);
}

}  // SUITE(shown_tiles)
