// Facts about the eye that is made from the other, as whole frames: that nothing moves where nothing should, that every pixel is
// written, that no byte depends on the run, and what it costs.
#include "engine/picture/metrics.h"
#include "tests/engine/frame/affiliated_frames.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <cmath>

TEST_SUITE_BEGIN("affiliated");

namespace affiliated_test {

using namespace binosplat;
using test::AffiliatedFrame;
using test::Gpu;
using test::makeAffiliated;
using test::ViewedScene;

namespace {

ViewedScene viewAtelier(glm::uvec2 size_px = {192, 192}) { return test::viewBuiltin("builtin:atelier", size_px, 20000); }

FrameSettings makeSettings(Mode mode, Side dominant = kLeft) {
    FrameSettings settings;
    settings.mode = mode;
    settings.dominant = dominant;
    settings.stereo.center_rois = true;
    return settings;
}

// The paper to the letter.
FrameSettings makeLetterSettings(Side dominant = kLeft) {
    FrameSettings settings = makeSettings(Mode::kPaper, dominant);
    settings.stereo.depth_choice = gpu::kDepthSum;
    settings.stereo.forward = true;
    settings.per_eye = true;
    return settings;
}

std::vector<FrameSettings> makeReprojecting(Side dominant = kLeft) {
    std::vector<FrameSettings> all{makeLetterSettings(dominant)};
    for (const Mode mode : {Mode::kReproject, Mode::kPaper, Mode::kPredicted}) { all.push_back(makeSettings(mode, dominant)); }
    return all;
}

// One pixel's worth of what should not be there.
struct Flaws {
    std::size_t not_finite = 0, negative = 0, transparent = 0, background = 0;
    bool operator==(const Flaws&) const = default;
};

// Of a picture of a scene that closes the view, over a magenta background.
Flaws findFlaws(const Image& image) {
    Flaws flaws;
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        const float* pixel = &image.values[4 * i];
        for (int channel = 0; channel < 4; ++channel) {
            flaws.not_finite += std::isfinite(pixel[channel]) ? 0 : 1;
            flaws.negative += pixel[channel] < 0.0f ? 1 : 0;
        }
        // What lies in these bytes before a pixel is written is no alpha near 1: the last channel is an inverse depth.
        flaws.transparent += pixel[3] > 0.9f && pixel[3] < 1.1f ? 0 : 1;
        flaws.background += pixel[0] > pixel[1] + 0.7f && pixel[2] > pixel[1] + 0.7f ? 1 : 0;
    }
    return flaws;
}

// Pixels that were moved before any tile was chosen for what is wrong with them.
std::size_t countMoved(const AffiliatedFrame& made) {
    const glm::uvec2 size_px = made.pictures[kLeft].size_px;
    std::size_t moved = 0;
    for (std::size_t i = 0; i < made.pictures[kLeft].pixelCount(); ++i) {
        const std::uint32_t kind =
            made.tile_kinds.empty() ? 0 : made.tile_kinds[i / size_px.x / 16 * ((size_px.x + 15) / 16) + i % size_px.x / 16];
        moved += kind == 0 || kind == gpu::kTileCenter || kind == gpu::kTilePredicted ? 1 : 0;
    }
    return moved;
}

// Without a distance between the eyes there is nothing to make.
void checkSameForBothEyes(Gpu& gpu, const ViewedScene& view) {
    CAPTURE(view.name);
    const GpuScene scene(gpu.context(), view.scene);
    StereoFrame frame(gpu.context(), scene);
    const test::KeptKernels kept(gpu.context(), frame);
    for (const gpu::uint depth_choice : {gpu::kDepthSum, gpu::kDepthMean, gpu::kDepthInverse}) {
        CAPTURE(depth_choice);
        for (FrameSettings settings : makeReprojecting(depth_choice == gpu::kDepthMean ? kRight : kLeft)) {
            CAPTURE(static_cast<int>(settings.mode));
            CAPTURE(settings.stereo.forward);
            settings.background = {0.1, 0.7, 0.3};
            settings.stereo.depth_choice = depth_choice;
            const AffiliatedFrame made = makeAffiliated(frame, stereoPair(view.eye, 0.0), settings);
            CHECK(made.pictures[kLeft].values == made.pictures[kRight].values);
            // Tiles that nothing is seen in are not worth moving.
            CHECK(made.result.counters.named().at("pixels_covered") == countMoved(made));
            CHECK(std::ranges::all_of(made.tile_kinds, [](std::uint32_t kind) { return kind == 0 || kind == gpu::kTileCheap; }));
            CHECK(made.result.counters.named().at("tiles_patched") == std::ranges::count(made.tile_kinds, gpu::kTileCheap));
        }
    }
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "without a distance between the eyes, the other eye's picture is the dominant one's, byte for byte") {
    checkSameForBothEyes(*this, viewAtelier());
}

TEST_CASE_FIXTURE(Gpu, "of a real scene, too, it is the dominant one's without a distance" * test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    const View view{{0.0, -0.6, -1.6}, {0.0, -0.4, 0.0}, {0.0, -1.0, 0.0}, 60.0};
    checkSameForBothEyes(*this,
                         {"playbot", loadScene((*data / "playbot" / "playbot_lod3_2dgs_sh2.ply").string()), test::eyeOf(view, {200, 150})});
}

TEST_CASE_FIXTURE(Gpu, "every mode gives the same bytes from run to run, and on a device that starts anew") {
    const ViewedScene view = viewAtelier();
    const auto eyes = test::headsetEyes(view.eye, glm::radians(5.0));
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    std::vector<FrameSettings> all = makeReprojecting();
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared}) { all.push_back(makeSettings(mode)); }
    for (const FrameSettings& settings : all) {
        CAPTURE(static_cast<int>(settings.mode));
        CAPTURE(settings.stereo.forward);
        const AffiliatedFrame first = makeAffiliated(frame, eyes, settings);
        for (int run = 0; run < 2; ++run) {
            const AffiliatedFrame again = makeAffiliated(frame, eyes, settings);
            CHECK(again.pictures[kLeft].values == first.pictures[kLeft].values);
            CHECK(again.pictures[kRight].values == first.pictures[kRight].values);
            CHECK(again.tile_kinds == first.tile_kinds);
            CHECK(again.pixel_classes == first.pixel_classes);
        }
        StereoFrame fresh(context(), scene);
        const AffiliatedFrame anew = makeAffiliated(fresh, eyes, settings);
        CHECK(anew.pictures[kRight].values == first.pictures[kRight].values);
        CHECK(anew.tile_kinds == first.tile_kinds);
    }
}

TEST_CASE_FIXTURE(Gpu, "every pixel of the other eye is written, with parallel, asymmetric and canted eyes, whichever dominates") {
    for (const glm::uvec2 size_px : {glm::uvec2(192, 192), glm::uvec2(97, 131)}) {
        const ViewedScene view = viewAtelier(size_px);
        const GpuScene scene(context(), view.scene);
        StereoFrame frame(context(), scene);
        const test::KeptKernels kept(context(), frame);
        for (const double canting_rad : {0.0, glm::radians(5.0)}) {
            const auto eyes = test::headsetEyes(view.eye, canting_rad);
            for (const Side dominant : {kLeft, kRight}) {
                FrameSettings full_settings = makeSettings(Mode::kShared, dominant);
                full_settings.background = {1.0, 0.0, 1.0};
                const Image full = makeAffiliated(frame, eyes, full_settings).pictures[1 - dominant];
                REQUIRE(findFlaws(full) == Flaws{});
                for (FrameSettings settings : makeReprojecting(dominant)) {
                    CAPTURE(canting_rad);
                    CAPTURE(static_cast<int>(dominant));
                    CAPTURE(static_cast<int>(settings.mode));
                    CAPTURE(settings.stereo.forward);
                    settings.background = full_settings.background;
                    const AffiliatedFrame made = makeAffiliated(frame, eyes, settings);
                    const Flaws flaws = findFlaws(made.pictures[1 - dominant]);
                    CHECK(flaws == Flaws{});
                    const double psnr_db = compare(made.pictures[1 - dominant], full).psnrDb();
                    CHECK(psnr_db >= (settings.mode == Mode::kReproject ? 15.0 : 20.0));
                    const auto& counters = made.result.counters.named();
                    CHECK(counters.at("pixels_covered") + counters.at("pixels_gap") + counters.at("pixels_hole") == countMoved(made));
                }
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "tiles that are rendered again are those of the full render") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    for (const double canting_rad : {0.0, glm::radians(5.0)}) {
        const auto eyes = test::headsetEyes(view.eye, canting_rad);
        const Image full = makeAffiliated(frame, eyes, makeSettings(Mode::kShared)).pictures[kRight];
        for (const auto& [mode, budget] :
             {std::pair(Mode::kPaper, 0.0), std::pair(Mode::kPredicted, 0.2), std::pair(Mode::kPredicted, 1.0)}) {
            CAPTURE(canting_rad);
            CAPTURE(static_cast<int>(mode));
            CAPTURE(budget);
            FrameSettings settings = makeSettings(mode);
            settings.stereo.budget = budget;
            const AffiliatedFrame made = makeAffiliated(frame, eyes, settings);
            CHECK(test::keepTiles(made.pictures[kRight], made.tile_kinds).values == test::keepTiles(full, made.tile_kinds).values);
            std::size_t tiles = 0;
            for (const std::uint32_t kind : made.tile_kinds) { tiles += kind != 0 ? 1 : 0; }
            CHECK(tiles == made.result.counters.named().at("tiles_patched"));
            CHECK(tiles > 0);
            if (mode == Mode::kPredicted) {
                const auto& counters = made.result.counters.named();
                if (counters.at("tiles_edge") + counters.at("tiles_cheap") == 0) {
                    CHECK(static_cast<double>(counters.at("work_patched")) <= budget * static_cast<double>(counters.at("work_full")));
                }
            }
            const double psnr_db = compare(made.pictures[kRight], full).psnrDb();
            if (budget == 1.0) { CHECK(psnr_db >= 50.0); }
            MESSAGE("canted " << canting_rad << ", mode " << static_cast<int>(mode) << ", budget " << budget << ": " << tiles << " of "
                              << made.tile_kinds.size() << " tiles, picture " << psnr_db << " dB");
        }
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "what each eye culls and sorts by itself makes two-pass's tiles, and with parallel eyes the picture of shared lists") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    for (const double canting_rad : {0.0, glm::radians(5.0)}) {
        CAPTURE(canting_rad);
        const auto eyes = test::headsetEyes(view.eye, canting_rad);
        const Image full = makeAffiliated(frame, eyes, makeSettings(Mode::kTwoPass)).pictures[kRight];
        FrameSettings settings = makeLetterSettings();
        const AffiliatedFrame alone = makeAffiliated(frame, eyes, settings);
        CHECK(test::keepTiles(alone.pictures[kRight], alone.tile_kinds).values == test::keepTiles(full, alone.tile_kinds).values);
        CHECK(alone.result.counters.named().at("splats_visible_left") != alone.result.counters.named().at("splats_visible_right"));
        settings.per_eye = false;
        const AffiliatedFrame together = makeAffiliated(frame, eyes, settings);
        CHECK(together.result.counters.named().at("splats_visible_left") >= alone.result.counters.named().at("splats_visible_left"));
        CHECK(together.tile_kinds == alone.tile_kinds);
        CHECK(together.pictures[kRight].values == alone.pictures[kRight].values);
        CHECK(together.pictures[kLeft].values == alone.pictures[kLeft].values);
    }
}

TEST_CASE_FIXTURE(Gpu, "more budget is never worse") {
    const ViewedScene view = viewAtelier();
    const auto eyes = stereoPair(view.eye, 0.063);
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    const Image full = makeAffiliated(frame, eyes, makeSettings(Mode::kShared)).pictures[kRight];
    // That odd rows are moved like even ones costs little.
    const double reprojected_db = compare(makeAffiliated(frame, eyes, makeSettings(Mode::kReproject)).pictures[kRight], full).psnrDb();
    double before_db = reprojected_db - 0.4;
    for (const double budget : {0.0, 0.05, 0.1, 0.2, 0.4, 0.8}) {
        FrameSettings settings = makeSettings(Mode::kPredicted);
        settings.stereo.budget = budget;
        const AffiliatedFrame made = makeAffiliated(frame, eyes, settings);
        const double psnr_db = compare(made.pictures[kRight], full).psnrDb();
        MESSAGE("budget " << budget << ": " << psnr_db << " dB");
        // What is patched is exact, and more budget patches the same tiles and others.
        CHECK(psnr_db >= before_db);
        before_db = psnr_db;
    }
}

TEST_CASE_FIXTURE(Gpu, "capacities that are too small grow, and the other eye's picture is the same") {
    const ViewedScene view = viewAtelier({160, 160});
    const auto eyes = test::headsetEyes(view.eye, glm::radians(5.0));
    const GpuScene scene(context(), view.scene);
    for (const FrameSettings& settings : makeReprojecting()) {
        CAPTURE(static_cast<int>(settings.mode));
        CAPTURE(settings.per_eye);
        const auto makeFrom = [&](const FrameCapacity& first) {
            StereoFrame frame(context(), scene, {.first_capacity = first, .threads_per_cell = 0});
            const test::KeptKernels kept(context(), frame);
            return makeAffiliated(frame, eyes, settings);
        };
        const AffiliatedFrame expected = makeFrom({20000, 1u << 20}), grown = makeFrom({1, 1});
        CHECK(grown.pictures[kLeft].values == expected.pictures[kLeft].values);
        CHECK(grown.pictures[kRight].values == expected.pictures[kRight].values);
        CHECK(grown.tile_kinds == expected.tile_kinds);
        CHECK(grown.pixel_classes == expected.pixel_classes);
    }
}

TEST_CASE_FIXTURE(Gpu, "a predicted frame of parallel eyes keeps to 36 commands and 48 bytes a pixel") {
    const ViewedScene view = viewAtelier({512, 512});
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    FrameSettings settings = makeSettings(Mode::kPredicted);
    settings.keep_depth = false;
    for (const bool half_floats : {false, true}) {
        settings.half_floats = half_floats;
        const FrameResult result = frame.render(stereoPair(view.eye, 0.063), settings);
        CHECK(result.counters.named().at("tiles_patched") > 0);
        CHECK(result.counters.named().at("commands") == 36);
        REQUIRE(result.stereo_bytes_per_pixel.back().first == "all");
        CHECK(result.stereo_bytes_per_pixel.back().second > 8.0);
        CHECK(result.stereo_bytes_per_pixel.back().second <= 48.0);
    }
}

TEST_CASE("making one eye from the other takes less memory than rendering both") {
    const ViewedScene view = viewAtelier({384, 384});
    for (const FrameCapacity& first : {FrameCapacity{1, 1}, FrameOptions{}.first_capacity}) {
        std::uint64_t two_pass_bytes = 0;
        std::vector<FrameSettings> all{makeSettings(Mode::kTwoPass)};
        for (const FrameSettings& settings : makeReprojecting()) { all.push_back(settings); }
        for (FrameSettings settings : all) {
            const Context context;
            const GpuScene scene(context, view.scene);
            StereoFrame frame(context, scene, {.first_capacity = first, .threads_per_cell = 0});
            settings.keep_depth = false;
            const std::uint64_t peak_bytes = frame.render(stereoPair(view.eye, 0.063), settings).peak_gpu_bytes;
            if (settings.mode == Mode::kTwoPass) { two_pass_bytes = peak_bytes; }
            MESSAGE("first capacity " << first.pairs << ", mode " << static_cast<int>(settings.mode)
                                      << std::string(settings.per_eye ? " per eye" : "") << ": " << peak_bytes << " bytes, "
                                      << 100.0 * static_cast<double>(peak_bytes) / static_cast<double>(two_pass_bytes) << " %");
            // Most of the dominant eye's pairs lie where the other eye's picture will be.
            if (settings.mode != Mode::kTwoPass) { CHECK(peak_bytes < two_pass_bytes); }
        }
    }
}

}  // namespace affiliated_test
