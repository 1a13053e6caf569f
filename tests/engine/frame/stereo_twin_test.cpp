// The twin's whole stereo frame: what must hold of it by itself, and that the device's frames are like it.
#include "engine/picture/metrics.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_cases.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

TEST_SUITE_BEGIN("stereo_twin");

namespace stereo_twin_test {

using namespace binosplat;
using reference::DepthChoice;
using reference::EyePair;
using reference::PixelClass;
using reference::TileKind;
using test::AffiliatedFrame;
using test::Gpu;

namespace {

Mode modeOf(TileChoice method) {
    return method == TileChoice::kNone ? Mode::kReproject : method == TileChoice::kPaper ? Mode::kPaper : Mode::kPredicted;
}

}  // namespace

TEST_CASE("the twin moves nothing where the eyes are one") {
    const auto view = test::viewBuiltin("builtin:atelier", {80, 60}, 5000);
    const EyePair eyes{view.eye, view.eye};
    for (const DepthChoice choice : {DepthChoice::kSum, DepthChoice::kMean, DepthChoice::kInverse}) {
        for (const TileChoice method : {TileChoice::kNone, TileChoice::kPaper, TileChoice::kPredicted}) {
            const auto pictures = reference::renderStereo(view.scene, eyes, {.choice = method, .depth_choice = choice}, {});
            double worst = 0.0;
            for (std::size_t i = 0; i < pictures.affiliated.size(); ++i) {
                for (int channel = 0; channel < 4; ++channel) {
                    worst = std::max(worst, std::abs(pictures.affiliated[i][channel] - pictures.dominant.rgba[i][channel]));
                }
            }
            CHECK(worst <= 1e-9);
            CHECK(std::all_of(pictures.resolved.begin(), pictures.resolved.end(),
                              [](const auto& pixel) { return pixel.pixel_class == PixelClass::kCovered; }));
            if (method != TileChoice::kPredicted) {
                const reference::StereoSettings letter{.choice = method, .depth_choice = choice, .forward = true};
                CHECK(reference::renderStereo(view.scene, eyes, letter, {}).affiliated == pictures.dominant.rgba);
            }
            CHECK(
                std::all_of(pictures.tile_kinds.begin(), pictures.tile_kinds.end(), [](TileKind kind) { return kind == TileKind::kNone; }));
        }
    }
}

TEST_CASE("the twin moves a wall by its disparity, up to the kernel's error") {
    // fx b / z = 100 * 0.08 / 2 = 4 px to the left: whole pixels, so that the picture is the same but for the column.
    const glm::uvec2 size_px(64, 48);
    const auto eyes = stereoPair(test::makeEye(size_px), 0.08);
    std::vector<test::Splat> splats;
    for (int j = -30; j <= 30; ++j) {
        for (int i = -40; i <= 40; ++i) {
            splats.push_back(
                {{0.04f * static_cast<float>(i), 0.04f * static_cast<float>(j), 2.0f},
                 {1, 0, 0, 0},
                 glm::vec2(0.03f),
                 0.95f,
                 {0.5f + 0.3f * std::sin(0.5f * static_cast<float>(i)), 0.4f, 0.5f + 0.3f * std::cos(0.7f * static_cast<float>(j))}});
        }
    }
    const auto pictures = reference::renderStereo(test::makeScene(splats), {eyes[kLeft], eyes[kRight]}, {.choice = TileChoice::kNone}, {});
    for (std::size_t y = 0; y < 48; ++y) {
        for (std::size_t x = 0; x < 64; ++x) {
            const std::size_t i = y * 64 + x;
            CHECK(pictures.resolved[i].pixel_class == (x < 60 ? PixelClass::kCovered : PixelClass::kHole));
            if (x >= 60) { continue; }
            CHECK(pictures.resolved[i].inverse_depth == doctest::Approx(0.5).epsilon(1e-6));
            CHECK(pictures.affiliated[i].x == doctest::Approx(pictures.dominant.rgba[i + 4].x).epsilon(1e-6));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "the device's stereo frames are the twin's, but for places that round to another pixel") {
    struct View {
        std::string name;
        test::ViewedScene view;
        std::array<Eye, 2> eyes;
    };
    const auto room = test::viewBuiltin("builtin:atelier", {160, 120}, 20000), fence = test::viewBuiltin("builtin:fence", {160, 120});
    const auto gaussians = test::viewGaussians({160, 120}, false), dimmed = test::viewGaussians({160, 120}, true);
    for (const View& seen :
         {View{"room", room, stereoPair(room.eye, 0.063)}, View{"room, canted", room, test::headsetEyes(room.eye, glm::radians(5.0))},
          View{"fence", fence, stereoPair(fence.eye, 0.12)}, View{"3D Gaussians", gaussians, stereoPair(gaussians.eye, 0.063)},
          View{"3D Gaussians, dimmed, canted", dimmed, test::headsetEyes(dimmed.eye, glm::radians(5.0))}}) {
        const GpuScene scene(context(), seen.view.scene);
        StereoFrame frame(context(), scene);
        const test::KeptKernels kept(context(), frame);
        for (const Side dominant : {kLeft, kRight}) {
            // A move that costs nothing, as much as many tiles' pairs, and more than any. And the paper to the letter, each eye by itself.
            for (const auto& [method, move_cost, letter] :
                 {std::tuple(TileChoice::kNone, 0u, false), std::tuple(TileChoice::kNone, 0u, true),
                  std::tuple(TileChoice::kPaper, 0u, false), std::tuple(TileChoice::kPaper, 0u, true),
                  std::tuple(TileChoice::kPredicted, 0u, false), std::tuple(TileChoice::kPredicted, 150u, false),
                  std::tuple(TileChoice::kPredicted, 100000u, false)}) {
                const reference::StereoSettings twin_settings{.choice = method,
                                                              .depth_choice = letter ? DepthChoice::kSum : DepthChoice::kInverse,
                                                              .forward = letter,
                                                              .margin_px = 8,
                                                              .center_rois = true,
                                                              .budget = 0.15,
                                                              .move_cost = move_cost};
                const auto twin =
                    reference::renderStereo(seen.view.scene, {seen.eyes[dominant], seen.eyes[1 - dominant]}, twin_settings, {});
                FrameSettings settings;
                settings.mode = modeOf(method);
                settings.dominant = dominant;
                settings.stereo = test::settingsOf(twin_settings);
                settings.per_eye = letter;
                const AffiliatedFrame made = test::makeAffiliated(frame, seen.eyes, settings);
                const glm::uvec2 size_px = seen.view.eye.size_px;
                // Errors are rounded down pixel by pixel on the device, so that of tiles that are nearly alike, as those of the fence's
                // like bars, others may be chosen; they are then worth as much.
                std::vector<std::uint32_t> same_kind;
                double chosen_error = 0.0, exchanged_error = 0.0;
                for (std::size_t t = 0; t < twin.tile_kinds.size(); ++t) {
                    same_kind.push_back(made.tile_kinds[t] == static_cast<std::uint32_t>(twin.tile_kinds[t]) ? 1 : 0);
                    const double error = twin.tile_errors.empty() ? 0.0 : twin.tile_errors[t];
                    chosen_error += twin.tile_kinds[t] == TileKind::kPredicted ? error : 0.0;
                    if (same_kind.back() == 0) { exchanged_error += made.tile_kinds[t] != 0 ? -error : error; }
                }
                const auto other_kinds = std::count(same_kind.begin(), same_kind.end(), 0u);
                const Difference difference = compare(test::keepTiles(made.pictures[1 - dominant], same_kind),
                                                      test::keepTiles(test::toImage(size_px, twin.affiliated), same_kind), 4);
                // And of tiles that only one of them renders: both are as near to the full render.
                const Image full = test::toImage(reference::render(seen.view.scene, seen.eyes[1 - dominant], {}));
                const double device_db = compare(made.pictures[1 - dominant], full).psnrDb(),
                             twin_db = compare(test::toImage(size_px, twin.affiliated), full).psnrDb();
                std::size_t other_classes = 0;
                for (std::size_t i = 0; i < twin.resolved.size(); ++i) {
                    const std::size_t tile = i / size_px.x / 16 * ((size_px.x + 15) / 16) + i % size_px.x / 16;
                    if (made.tile_kinds[tile] != 0) { continue; }
                    other_classes += made.pixel_classes[i] == static_cast<std::uint8_t>(twin.resolved[i].pixel_class) ? 0 : 1;
                }
                CAPTURE(seen.name);
                CAPTURE(static_cast<int>(dominant));
                CAPTURE(static_cast<int>(method));
                CAPTURE(move_cost);
                CAPTURE(letter);
                CHECK(difference.not_finite == 0);
                if (std::min(device_db, twin_db) < 70.0) {
                    CHECK(std::abs(device_db - twin_db) <= 0.25);
                }                                        // measured: 0.19 in one, 0.12 in one
                CHECK(difference.psnrDb() >= 80.0);      // measured: 84.5 and more; of 3D Gaussians 81.3
                CHECK(difference.shareOff() <= 0.0001);  // measured: none
                if (seen.view.scene.isGaussian3d()) {
                    // Splats that fall between pixels are newcomers for the device alone, and this cloud is full of them.
                    CHECK(other_kinds <= 2);  // measured: two, in two of these frames
                    CHECK(std::abs(exchanged_error) <= 0.03 * chosen_error);
                    CHECK(other_classes <= 4);  // measured: three, canted
                    continue;
                }
                // Canted, one disc that comes through the near plane is a newcomer for the twin alone: the device's bounds of such discs
                // are wider, and let the dominant eye see it. What its tile costs buys the device another one in place of a third.
                const bool canted = seen.name == "room, canted";
                CHECK(other_kinds <= (canted ? 3 : 1));  // measured: three and one, in one of all these frames each
                // Measured: 0.0063, of the tile that the twin's budget just reached.
                if (!canted) { CHECK(std::abs(exchanged_error) <= 0.01 * chosen_error); }
                CHECK(other_classes <= 2);  // measured: none
            }
        }
    }
}

}  // namespace stereo_twin_test
