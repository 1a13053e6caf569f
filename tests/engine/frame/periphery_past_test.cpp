// Facts about both eyes' frames with half the resolution where they do not look: made from each other and from the frames before.
#include "engine/frame/stereo_frame.h"
#include "engine/picture/metrics.h"
#include "tests/engine/frame/frame_runs.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

TEST_SUITE_BEGIN("periphery_past");

namespace periphery_past_test {

using namespace binosplat;
using test::Gpu;
using test::ViewedScene;

namespace {

constexpr std::array kModes{Mode::kPredicted, Mode::kAlternate, Mode::kTemporal};

ViewedScene viewRoom() {
    ViewedScene view = test::viewBuiltin("builtin:atelier", {384, 336}, 40000);
    view.eye.intrinsics = intrinsicsFromAngles({-0.9, 0.8, 0.75, -0.85}, view.eye.size_px);
    return view;
}

FrameSettings settingsOf(Mode mode, double budget = 0.2) {
    FrameSettings settings;
    settings.mode = mode;
    settings.keep_past = mode != Mode::kMono;
    settings.stereo.budget = budget;
    settings.half_periphery = true;
    settings.gazes = {Gaze{{0.0, 0.0, 1.0}, 0.1}, Gaze{{0.0, 0.0, 1.0}, 0.1}};
    return settings;
}

// A head that walks by 3 mm a frame, and turns a little.
std::array<Eye, 2> eyesAt(const Eye& middle, double step) {
    Eye eye = middle;
    eye.world_from_camera.position += step * glm::dvec3(0.003, 0.001, 0.001);
    eye.world_from_camera.orientation =
        eye.world_from_camera.orientation * glm::angleAxis(0.002 * step, glm::normalize(glm::dvec3(0.2, 1, 0)));
    return stereoPair(eye, 0.063);
}

std::uint64_t count(const FrameResult& result, const char* name) { return result.counters.named().at(name); }

// Frames one after another, and beside each those of eyes alone: in two pictures without a past, and in full.
class Walk {
public:
    Walk(const Context& context, const FrameSettings& settings)
        : scene_(context, view_.scene), frame_(context, scene_), alone_(context, scene_), settings_(settings), kept_(context, frame_) {}

    FrameResult go(double step) {
        eyes_ = eyesAt(view_.eye, step);
        return frame_.render(eyes_, settings_);
    }
    Image shown(int eye) { return frame_.readPicture(eye); }
    Image alone(int eye, bool in_two) {
        FrameSettings settings = settingsOf(Mode::kMono);
        settings.half_periphery = in_two;
        settings.half_floats = settings_.half_floats;
        alone_.render({&eyes_[static_cast<std::size_t>(eye)], 1}, settings);
        return alone_.readPicture(0);
    }
    double psnr(int eye, bool to_two) { return compare(shown(eye), alone(eye, to_two)).psnrDb(); }
    StereoFrame& frame() { return frame_; }

private:
    ViewedScene view_ = viewRoom();
    GpuScene scene_;
    StereoFrame frame_, alone_;
    FrameSettings settings_;
    test::KeptKernels kept_;
    std::array<Eye, 2> eyes_;
};

}  // namespace

TEST_CASE_FIXTURE(Gpu, "without a past both eyes are as alone") {
    for (const Mode mode : kModes) {
        CAPTURE(nameOf(mode));
        Walk walk(context(), settingsOf(mode));
        const FrameResult result = walk.go(0.0);
        CHECK(walk.shown(kLeft).values == walk.alone(kLeft, true).values);
        CHECK(walk.psnr(kRight, true) > 80.0);  // in the left eye's order, which rounding may make another one
        CHECK(walk.psnr(kRight, false) > 40.0);
        CHECK(result.left_out.end() !=
              std::ranges::find_if(result.left_out, [](const std::string& sentence) { return sentence.starts_with("reprojection: "); }));
    }
}

TEST_CASE_FIXTURE(Gpu, "a head that stands still comes to see what it sees without a past, and then for next to no work") {
    Walk walk(context(), settingsOf(Mode::kTemporal));
    for (int frame = 0; frame < 4; ++frame) { walk.go(frame); }
    for (int frame = 0; frame < 30; ++frame) { walk.go(4.0); }
    const FrameResult result = walk.go(4.0);
    MESSAGE(walk.psnr(kLeft, true) << ", " << walk.psnr(kRight, true) << " dB to its eyes alone, " << walk.psnr(kLeft, false) << ", "
                                   << walk.psnr(kRight, false) << " dB to the full render, work " << result.work_rendered);
    CHECK(result.work_rendered < 0.005);  // what nobody notices has its turn now and then
    for (const int eye : {kLeft, kRight}) { CHECK(walk.psnr(eye, true) > 50.0); }
}

TEST_CASE_FIXTURE(Gpu, "a walk keeps its quality within the budget") {
    for (const Mode mode : {Mode::kAlternate, Mode::kTemporal}) {
        CAPTURE(nameOf(mode));
        Walk walk(context(), settingsOf(mode));
        walk.go(0.0);
        for (int frame = 1; frame <= 24; ++frame) {
            const FrameResult result = walk.go(frame);
            if (mode == Mode::kTemporal) {
                CHECK(result.work_rendered > 0.1);
                CHECK(result.work_rendered < 0.23);
            }
            if (frame % 6 != 0) { continue; }
            MESSAGE(nameOf(mode) << " " << frame << ": " << walk.psnr(kLeft, true) << ", " << walk.psnr(kRight, true) << " dB; full "
                                 << walk.psnr(kLeft, false) << ", " << walk.psnr(kRight, false) << "; " << count(result, "tiles_full_size")
                                 << " tiles, " << count(result, "tiles_half_size") << " of half the size, work " << result.work_rendered
                                 << ", " << result.counters.commands << " commands");
            CHECK(std::min(walk.psnr(kLeft, false), walk.psnr(kRight, false)) > 34.0);
        }
    }
}

}  // namespace periphery_past_test
