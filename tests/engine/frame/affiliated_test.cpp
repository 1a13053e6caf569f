// Facts about whole frames with a reprojected eye: what stays the same, that every pixel is written, and what
// it costs.
#include "tests/engine/frame/affiliated_frames.h"
#include "tests/engine/frame/frame_runs.h"

SUITE(affiliated) {

ViewedScene viewAtelier(glm::uvec2 size_px = {128, 128}) {
    return test::viewBuiltin("builtin:atelier", size_px, 20000);
}

FrameSettings makeSettings(Mode mode, Side dominant = kLeft) {
    FrameSettings settings;
    settings.mode = mode;
    settings.dominant = dominant;
    settings.stereo.center_rois = true;
    return settings;
}

// Exactly as in the paper.
FrameSettings makeLetterSettings(Side dominant = kLeft) {
    FrameSettings settings = makeSettings(Mode::kPaper, dominant);
    settings.stereo.depth_choice = gpu::kDepthSum;
    settings.stereo.forward = true;
    settings.per_eye = true;
    return settings;
}

std::vector<FrameSettings> makeReprojecting(Side dominant = kLeft) {
    std::vector<FrameSettings> all{makeLetterSettings(dominant)};
    for (const Mode mode : {Mode::kReproject, Mode::kPaper, Mode::kPredicted}) {
        all.push_back(makeSettings(mode, dominant));
    }
    return all;
}

// Values that must not occur in a picture of a scene that fills the view, over a magenta background.
std::size_t countFlaws(const Image& image) {
    std::size_t flaws = 0;
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        const float* pixel = &image.values[4 * i];
        for (int channel = 0; channel < 4; ++channel) {
            flaws += std::isfinite(pixel[channel]) && pixel[channel] >= 0.0f ? 0 : 1;
        }
        // Before a pixel is written, its bytes hold no alpha near 1: the last channel is an inverse depth.
        flaws += pixel[3] > 0.9f && pixel[3] < 1.1f ? 0 : 1;
        flaws += pixel[0] > pixel[1] + 0.7f && pixel[2] > pixel[1] + 0.7f ? 1 : 0;
    }
    return flaws;
}

// Pixels that were reprojected before any tile was chosen for its errors.
std::size_t countMoved(const AffiliatedFrame& made) {
    const glm::uvec2 size_px = made.pictures[kLeft].size_px;
    std::size_t moved = 0;
    for (std::size_t i = 0; i < made.pictures[kLeft].pixelCount(); ++i) {
        const std::uint32_t kind =
            made.tile_kinds.empty()
                ? 0
                : made.tile_kinds[i / size_px.x / 16 * ((size_px.x + 15) / 16) + i % size_px.x / 16];
        moved += kind == 0 || kind == gpu::kTileCenter || kind == gpu::kTilePredicted ? 1 : 0;
    }
    return moved;
}

TEST_CASE_FIXTURE(
    Gpu,
    "without a distance between the eyes, the other eye's picture is the dominant one's, byte for byte") {
    const ViewedScene view = viewAtelier();
    KeptFrame frame(context(), view.scene);
    for (const gpu::uint depth_choice : {gpu::kDepthSum, gpu::kDepthMean, gpu::kDepthInverse}) {
        CAPTURE(depth_choice);
        for (FrameSettings settings : makeReprojecting(depth_choice == gpu::kDepthMean ? kRight : kLeft)) {
            INFO("settings.mode ", static_cast<int>(settings.mode), ", settings.stereo.forward ",
                 settings.stereo.forward);
            settings.background = {0.1, 0.7, 0.3};
            settings.stereo.depth_choice = depth_choice;
            const AffiliatedFrame made = makeAffiliated(frame, stereoPair(view.eye, 0.0), settings);
            CHECK(made.pictures[kLeft].values == made.pictures[kRight].values);
            // Tiles in which nothing is visible are not worth reprojecting.
            CHECK(countOf(made.result, "pixels_covered") == countMoved(made));
            CHECK(std::ranges::all_of(
                made.tile_kinds, [](std::uint32_t kind) { return kind == 0 || kind == gpu::kTileCheap; }));
            CHECK(countOf(made.result, "tiles_patched") ==
                  std::ranges::count(made.tile_kinds, gpu::kTileCheap));
        }
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "every mode gives the same bytes from run to run, whatever room its lists begin with") {
    const ViewedScene view = viewAtelier();
    const auto eyes = test::headsetEyes(view.eye, glm::radians(5.0));
    const GpuScene scene(context(), view.scene);
    std::vector<FrameSettings> all = makeReprojecting();
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared}) { all.push_back(makeSettings(mode)); }
    for (const FrameSettings& settings : all) {
        INFO("settings.mode ", static_cast<int>(settings.mode), ", settings.stereo.forward ",
             settings.stereo.forward);
        std::vector<AffiliatedFrame> made;
        std::vector<Image> depths;
        for (const FrameCapacity& first : {FrameOptions{}.first_capacity, FrameCapacity{1, 1}}) {
            KeptFrame frame(context(), scene, {.first_capacity = first});
            for (int run = 0; run < 2; ++run) {
                made.push_back(makeAffiliated(frame, eyes, settings));
                depths.push_back(frame.readDominantDepth());
            }
        }
        for (std::size_t run = 1; run < made.size(); ++run) {
            CHECK(these(made[run].pictures[kLeft].values, made[run].pictures[kRight].values,
                        made[run].tile_kinds) ==
                  these(made[0].pictures[kLeft].values, made[0].pictures[kRight].values, made[0].tile_kinds));
            CHECK(made[run].pixel_classes == made[0].pixel_classes);
            CHECK(depths[run].values == depths[0].values);
            for (const char* pairs : {"tile_pairs_left", "tile_pairs_right"}) {
                CHECK(countOf(made[run].result, pairs) == countOf(made[0].result, pairs));
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "every pixel of the other eye is written, with parallel, asymmetric and canted eyes, "
                  "whichever dominates") {
    const ViewedScene view = viewAtelier({97, 131});
    KeptFrame frame(context(), view.scene);
    for (const double canting_rad : {0.0, glm::radians(5.0)}) {
        const auto eyes = test::headsetEyes(view.eye, canting_rad);
        for (const Side dominant : {kLeft, kRight}) {
            FrameSettings full_settings = makeSettings(Mode::kShared, dominant);
            full_settings.background = {1.0, 0.0, 1.0};
            const Image full = makeAffiliated(frame, eyes, full_settings).pictures[1 - dominant];
            REQUIRE(countFlaws(full) == 0);
            for (FrameSettings settings : makeReprojecting(dominant)) {
                INFO("canting_rad ", canting_rad, ", dominant ", static_cast<int>(dominant),
                     ", settings.mode ", static_cast<int>(settings.mode), ", settings.stereo.forward ",
                     settings.stereo.forward);
                settings.background = full_settings.background;
                const AffiliatedFrame made = makeAffiliated(frame, eyes, settings);
                CHECK(countFlaws(made.pictures[1 - dominant]) == 0);
                const double psnr_db = compare(made.pictures[1 - dominant], full).psnrDb();
                CHECK(psnr_db >= (settings.mode == Mode::kReproject ? 15.0 : 20.0));
                CHECK(countOf(made.result, "pixels_covered") + countOf(made.result, "pixels_gap") +
                          countOf(made.result, "pixels_hole") ==
                      countMoved(made));
            }
        }
    }
}

TEST_CASE_FIXTURE(
    Gpu, "tiles that are rendered again are those of the full render, and more budget is never worse") {
    const ViewedScene view = viewAtelier({192, 192});
    KeptFrame frame(context(), view.scene);
    for (const auto& eyes : {stereoPair(view.eye, 0.063), test::headsetEyes(view.eye, glm::radians(5.0))}) {
        FrameSettings full_settings = makeSettings(Mode::kShared);
        full_settings.keep_both_depths = true;
        const Image full = makeAffiliated(frame, eyes, full_settings).pictures[kRight],
                    full_depth = frame.readDepth(kRight);
        // Moving odd rows like even ones costs little quality.
        double before_db =
            compare(makeAffiliated(frame, eyes, makeSettings(Mode::kReproject)).pictures[kRight], full)
                .psnrDb() -
            0.4;
        for (const auto& [mode, budget] : {std::pair(Mode::kPaper, 0.0), std::pair(Mode::kPredicted, 0.0),
                                           std::pair(Mode::kPredicted, 0.2), std::pair(Mode::kPredicted, 0.5),
                                           std::pair(Mode::kPredicted, 1.0)}) {
            INFO("mode ", static_cast<int>(mode), ", budget ", budget);
            FrameSettings settings = makeSettings(mode);
            settings.stereo.budget = budget;
            settings.keep_both_depths = true;
            const AffiliatedFrame made = makeAffiliated(frame, eyes, settings);
            const auto areFull = [&](const Image& picture, const Image& whole) {
                return test::keepTiles(picture, made.tile_kinds).values ==
                       test::keepTiles(whole, made.tile_kinds).values;
            };
            CHECK(areFull(made.pictures[kRight], full));
            CHECK(areFull(frame.readDepth(kRight), full_depth));
            const auto tiles =
                made.tile_kinds.size() - static_cast<std::size_t>(std::ranges::count(made.tile_kinds, 0u));
            CHECK(tiles == countOf(made.result, "tiles_patched"));
            if (mode == Mode::kPaper || budget > 0.0) { CHECK(tiles > 0); }
            if (mode == Mode::kPaper) { continue; }
            if (countOf(made.result, "tiles_edge") + countOf(made.result, "tiles_cheap") == 0) {
                CHECK(static_cast<double>(countOf(made.result, "work_patched")) <=
                      budget * static_cast<double>(countOf(made.result, "work_full")));
            }
            // Patched tiles are exact, and a larger budget patches the same tiles and others.
            const double psnr_db = compare(made.pictures[kRight], full).psnrDb();
            CHECK(psnr_db >= before_db);
            if (budget == 1.0) { CHECK(psnr_db >= 50.0); }
            before_db = psnr_db;
        }
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "what each eye culls and sorts by itself makes two-pass's tiles, and with parallel eyes "
                  "shared lists' picture") {
    const ViewedScene view = viewAtelier();
    KeptFrame frame(context(), view.scene);
    for (const double canting_rad : {0.0, glm::radians(5.0)}) {
        CAPTURE(canting_rad);
        const auto eyes = test::headsetEyes(view.eye, canting_rad);
        const Image full = makeAffiliated(frame, eyes, makeSettings(Mode::kTwoPass)).pictures[kRight];
        FrameSettings settings = makeLetterSettings();
        const AffiliatedFrame alone = makeAffiliated(frame, eyes, settings);
        CHECK(test::keepTiles(alone.pictures[kRight], alone.tile_kinds).values ==
              test::keepTiles(full, alone.tile_kinds).values);
        CHECK(countOf(alone.result, "splats_visible_left") != countOf(alone.result, "splats_visible_right"));
        settings.per_eye = false;
        const AffiliatedFrame together = makeAffiliated(frame, eyes, settings);
        CHECK(countOf(together.result, "splats_visible_left") >=
              countOf(alone.result, "splats_visible_left"));
        CHECK(these(together.tile_kinds, together.pictures[kRight].values, together.pictures[kLeft].values) ==
              these(alone.tile_kinds, alone.pictures[kRight].values, alone.pictures[kLeft].values));
    }
}

TEST_CASE_FIXTURE(Gpu, "a predicted frame of parallel eyes keeps to 28 commands and 48 bytes a pixel") {
    const ViewedScene view = viewAtelier({256, 256});
    KeptFrame frame(context(), view.scene);
    FrameSettings settings = makeSettings(Mode::kPredicted);
    settings.keep_depth = false;
    for (const bool half_floats : {false, true}) {
        settings.half_floats = half_floats;
        const FrameResult result = frame.render(stereoPair(view.eye, 0.063), settings);
        CHECK(countOf(result, "tiles_patched") > 0);
        CHECK(countOf(result, "commands") == 28);
        REQUIRE(result.stereo_bytes_per_pixel.back().first == "all");
        CHECK(result.stereo_bytes_per_pixel.back().second > 8.0);
        CHECK(result.stereo_bytes_per_pixel.back().second <= 48.0);
    }
}

}  // SUITE(affiliated)
