// Facts about whole frames with a reprojected eye: what stays the same, what is written, and what it costs.
#include "tests/engine/frame/affiliated_frames.h"
#include "tests/engine/frame/frame_runs.h"

SUITE(affiliated) {

FrameSettings makeSettings(Mode mode, Side dominant = kLeft) {
    FrameSettings settings = test::makeSettings(mode, dominant);
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

std::string describe(const FrameSettings& settings) {
    return fmt::format("{}{}", nameOf(settings.mode), settings.stereo.forward ? " as in the paper" : "");
}

TEST_CASE_FIXTURE(Gpu, "without a distance between them, both eyes have the same picture, byte for byte") {
    const ViewedScene view = viewAtelier();
    KeptFrame frame(context(), view.scene);
    for (const gpu::uint depth_choice : {gpu::kDepthSum, gpu::kDepthMean, gpu::kDepthInverse}) {
        CAPTURE(depth_choice);
        for (FrameSettings settings : makeReprojecting(depth_choice == gpu::kDepthMean ? kRight : kLeft)) {
            INFO(describe(settings));
            settings.background = {0.1, 0.7, 0.3};
            settings.stereo.depth_choice = depth_choice;
            const AffiliatedFrame made = makeAffiliated(frame, stereoPair(view.eye, 0.0), settings);
            CHECK(made.pictures[kLeft].values == made.pictures[kRight].values);
            // Tiles in which nothing is visible are not worth reprojecting; all others are covered.
            const auto cheap = std::ranges::count(made.tile_kinds, gpu::kTileCheap),
                       moved = std::ranges::count(made.tile_kinds, 0u);
            CHECK(cheap + moved == std::ssize(made.tile_kinds));
            CHECK(countOf(made.result, "tiles_patched") == cheap);
            const std::size_t pixels = made.pictures[kLeft].pixelCount();
            CHECK(countOf(made.result, "pixels_covered") == pixels - 256 * static_cast<std::size_t>(cheap));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "every mode gives the same bytes again, whatever room its lists begin with") {
    const ViewedScene view = viewAtelier();
    const auto eyes = headsetEyes(view.eye, glm::radians(5.0));
    const GpuScene scene(context(), view.scene);
    std::vector<FrameSettings> all = makeReprojecting();
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared}) { all.push_back(makeSettings(mode)); }
    for (const FrameSettings& settings : all) {
        INFO(describe(settings));
        const auto make = [&](KeptFrame& frame) {
            const AffiliatedFrame made = makeAffiliated(frame, eyes, settings);
            return std::tuple(made.pictures[kLeft].values, made.pictures[kRight].values,
                              frame.readDominantDepth().values, made.tile_kinds, made.pixel_classes,
                              countOf(made.result, "tile_pairs_left"),
                              countOf(made.result, "tile_pairs_right"));
        };
        KeptFrame frame(context(), scene), grows(context(), scene, {.first_capacity = {1, 1}});
        const auto first = make(frame);
        for (KeptFrame* again : {&frame, &grows, &grows}) { CHECK((make(*again) == first)); }
    }
}

TEST_CASE_FIXTURE(Gpu, "tiles rendered again are the full render's, and more budget is never worse") {
    const ViewedScene view = viewAtelier({192, 192});
    KeptFrame frame(context(), view.scene);
    for (const auto& eyes : {stereoPair(view.eye, 0.063), headsetEyes(view.eye, glm::radians(5.0))}) {
        FrameSettings settings = makeSettings(Mode::kShared);
        settings.keep_both_depths = true;
        const Image full = makeAffiliated(frame, eyes, settings).pictures[kRight],
                    full_depth = frame.readDepth(kRight);
        // Moving odd rows like even ones costs little quality.
        double before_db =
            compare(makeAffiliated(frame, eyes, makeSettings(Mode::kReproject)).pictures[kRight], full)
                .psnrDb() -
            0.4;
        for (const auto& [mode, budget] : {std::pair(Mode::kPaper, 0.0), std::pair(Mode::kPredicted, 0.0),
                                           std::pair(Mode::kPredicted, 0.2), std::pair(Mode::kPredicted, 0.5),
                                           std::pair(Mode::kPredicted, 1.0)}) {
            INFO("mode ", nameOf(mode), ", budget ", budget);
            settings.mode = mode;
            settings.stereo.budget = budget;
            const AffiliatedFrame made = makeAffiliated(frame, eyes, settings);
            const auto areFull = [&](const Image& picture, const Image& whole) {
                return keepTiles(picture, made.tile_kinds).values == keepTiles(whole, made.tile_kinds).values;
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

TEST_CASE_FIXTURE(Gpu, "eyes that cull and sort by themselves have two-pass's tiles") {
    const ViewedScene view = viewAtelier();
    KeptFrame frame(context(), view.scene);
    for (const double canting_rad : {0.0, glm::radians(5.0)}) {
        CAPTURE(canting_rad);
        const auto eyes = headsetEyes(view.eye, canting_rad);
        const Image full = makeAffiliated(frame, eyes, makeSettings(Mode::kTwoPass)).pictures[kRight];
        FrameSettings settings = makeLetterSettings();
        const AffiliatedFrame alone = makeAffiliated(frame, eyes, settings);
        CHECK(keepTiles(alone.pictures[kRight], alone.tile_kinds).values ==
              keepTiles(full, alone.tile_kinds).values);
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
