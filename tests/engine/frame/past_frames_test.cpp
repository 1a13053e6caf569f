// Facts about frames that are made from the ones before: what they equal where nothing moves, and what they cost. Pass by pass:
// past_passes_test.cpp.
#include "engine/frame/stereo_frame.h"
#include "engine/picture/metrics.h"
#include "tests/engine/frame/frame_runs.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

TEST_SUITE_BEGIN("past_frames");

namespace past_frames_test {

using namespace binosplat;
using test::Gpu;
using test::ViewedScene;

namespace {

FrameSettings makeSettings(Mode mode, double budget = 0.2) {
    FrameSettings settings;
    settings.mode = mode;
    settings.keep_past = true;
    settings.stereo.budget = budget;
    return settings;
}

ViewedScene viewAtelier() { return test::viewBuiltin("builtin:atelier", {208, 176}, 20000); }

// A head that walks by 3 mm a frame, and turns a little.
std::array<Eye, 2> eyesAt(const Eye& middle, double step) {
    Eye eye = middle;
    eye.world_from_camera.position += step * glm::dvec3(0.003, 0.001, 0.001);
    eye.world_from_camera.orientation =
        eye.world_from_camera.orientation * glm::angleAxis(0.002 * step, glm::normalize(glm::dvec3(0.2, 1, 0)));
    return stereoPair(eye, 0.063);
}

// Frames one after another, and beside each the full renders.
class Walk {
public:
    Walk(const Context& context, const FrameSettings& settings)
        : scene_(context, view_.scene), frame_(context, scene_), full_(context, scene_), settings_(settings), kept_(context, frame_) {}

    FrameResult go(double step) {
        eyes_ = eyesAt(view_.eye, step);
        return frame_.render(eyes_, settings_);
    }
    std::array<Image, 2> shown() { return {frame_.readPicture(kLeft), frame_.readPicture(kRight)}; }
    std::array<Image, 2> full() {
        full_.render(eyes_, makeSettings(Mode::kShared));
        return {full_.readPicture(kLeft), full_.readPicture(kRight)};
    }
    // Of the worse eye.
    double psnr() {
        const auto pictures = shown(), wanted = full();
        return std::min(compare(pictures[0], wanted[0]).psnrDb(), compare(pictures[1], wanted[1]).psnrDb());
    }
    StereoFrame& frame() { return frame_; }
    [[nodiscard]] const std::array<Eye, 2>& eyes() const { return eyes_; }

private:
    ViewedScene view_ = viewAtelier();
    GpuScene scene_;
    StereoFrame frame_, full_;
    FrameSettings settings_;
    test::KeptKernels kept_;
    std::array<Eye, 2> eyes_;
};

}  // namespace

TEST_CASE_FIXTURE(Gpu, "where no past is kept, temporal is predicted and alternate is shared, frame after frame") {
    const ViewedScene view = viewAtelier();
    for (const auto& [mode, same] : {std::pair(Mode::kTemporal, Mode::kPredicted), std::pair(Mode::kAlternate, Mode::kShared)}) {
        const GpuScene scene(context(), view.scene);
        StereoFrame frame(context(), scene), other(context(), scene);
        const test::KeptKernels kept(context(), frame);
        for (int step = 0; step < 2; ++step) {
            FrameSettings settings = makeSettings(mode);
            settings.keep_past = false;
            frame.render(eyesAt(view.eye, step), settings);
            other.render(eyesAt(view.eye, step), makeSettings(same));
            for (const int eye : {kLeft, kRight}) { CHECK(frame.readPicture(eye).values == other.readPicture(eye).values); }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a head that stands still sees the full render within 30 frames, and then for good, for no work") {
    Walk walk(context(), makeSettings(Mode::kTemporal));
    for (int frame = 0; frame < 4; ++frame) { walk.go(frame); }
    for (int frame = 0; frame < 30; ++frame) { walk.go(4.0); }
    const auto full = walk.full();
    for (int frame = 0; frame < 3; ++frame) {
        const FrameResult result = walk.go(4.0);
        CHECK(result.work_rendered == 0.0);
        const auto shown = walk.shown();
        for (const int eye : {kLeft, kRight}) {
            CHECK(shown[static_cast<std::size_t>(eye)].values == full[static_cast<std::size_t>(eye)].values);
        }
    }
}

TEST_CASE_FIXTURE(
    Gpu, "with work for nearly all of both eyes these are nearly the full render, parallel or canted, whatever room lists had before") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    for (const double cant : {0.0, 0.05}) {  // parallel eyes are rendered beside each other, canted ones one after the other
        CAPTURE(cant);
        StereoFrame frame(context(), scene, {.first_capacity = {1, 1}, .threads_per_cell = 0}), full(context(), scene);
        const test::KeptKernels kept(context(), frame);
        for (int step = 0; step < 5; ++step) {
            std::array<Eye, 2> eyes = eyesAt(view.eye, step);
            eyes[1].world_from_camera.orientation = eyes[1].world_from_camera.orientation * glm::angleAxis(cant, glm::dvec3(0, 1, 0));
            const FrameResult result = frame.render(eyes, makeSettings(Mode::kTemporal, 0.9));
            if (step == 4) { CHECK(result.counters.commands == (cant > 0.0 ? 43u : 34u)); }
            full.render(eyes, makeSettings(Mode::kShared));
            if (step < 2) { continue; }  // of the second eye less than half was rendered at first
            for (const int eye : {kLeft, kRight}) { CHECK(compare(frame.readPicture(eye), full.readPicture(eye)).psnrDb() >= 53.0); }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a walk keeps its quality within the budget, in both eyes and without a frame that costs more") {
    Walk walk(context(), makeSettings(Mode::kTemporal));
    walk.go(0.0);
    CHECK(walk.shown()[0].values == walk.full()[0].values);  // nothing was there to be made from
    for (int frame = 1; frame <= 24; ++frame) {
        const FrameResult result = walk.go(frame);
        REQUIRE(result.counters.warped);
        CHECK(result.work_rendered > 0.15);
        CHECK(result.work_rendered < 0.22);  // a tile more than the budget at most
        CHECK(result.counters.warped->tiles_patched > 0);
        CHECK(result.counters.commands <= 42);
        if (frame % 6 == 0) { CHECK(walk.psnr() > 36.0); }
    }
}

TEST_CASE_FIXTURE(Gpu, "where it is known where the eyes look, the budget is spent there") {
    // Of the left third of both pictures.
    const auto errorOf = [](Walk& walk) {
        const auto shown = walk.shown(), full = walk.full();
        double error = 0.0;
        for (std::size_t e = 0; e < 2; ++e) {
            const glm::uvec2 size_px = shown[e].size_px;
            for (std::size_t i = 0; i < shown[e].pixelCount(); ++i) {
                for (std::size_t c = 0; 3 * (i % size_px.x) < size_px.x && c < 3; ++c) {
                    error += std::pow(static_cast<double>(shown[e].values[4 * i + c]) - static_cast<double>(full[e].values[4 * i + c]), 2);
                }
            }
        }
        return error;
    };
    FrameSettings looks = makeSettings(Mode::kTemporal);
    looks.gazes = {Gaze{{-0.8, 0.0, 1.0}, 0.0}, Gaze{{-0.8, 0.0, 1.0}, 0.0}};
    Walk seen(context(), looks), alike(context(), makeSettings(Mode::kTemporal));
    double seen_error = 0.0, alike_error = 0.0;
    for (int frame = 0; frame <= 18; ++frame) {
        const FrameResult result = seen.go(frame);
        alike.go(frame);
        if (frame < 6) { continue; }
        CHECK(result.work_rendered > 0.15);
        CHECK(result.work_rendered < 0.22);
        if (frame % 6 != 0) { continue; }
        seen_error += errorOf(seen);
        alike_error += errorOf(alike);
    }
    MESSAGE("of the error there is left " << seen_error / alike_error);
    CHECK(seen_error < 0.8 * alike_error);
}

TEST_CASE_FIXTURE(Gpu, "more budget is a better picture, and all of it is the full render") {
    std::vector<double> reached;
    for (const double budget : {0.05, 0.2, 0.5}) {
        Walk walk(context(), makeSettings(Mode::kTemporal, budget));
        for (int frame = 0; frame < 12; ++frame) { walk.go(frame); }
        reached.push_back(walk.psnr());
    }
    CHECK(reached[0] < reached[1]);
    CHECK(reached[1] < reached[2]);
    Walk walk(context(), makeSettings(Mode::kTemporal, 1.0));
    for (int frame = 0; frame < 3; ++frame) { walk.go(frame); }
    CHECK(walk.psnr() > 80.0);
}

TEST_CASE_FIXTURE(Gpu, "after a jump of the head one eye is rendered in full, and the other is made from it within the budget") {
    Walk walk(context(), makeSettings(Mode::kTemporal));
    for (int frame = 0; frame < 3; ++frame) { walk.go(frame); }
    const FrameResult result = walk.go(200.0);
    const auto shown = walk.shown(), full = walk.full();
    CHECK(shown[0].values == full[0].values);
    CHECK(result.work_rendered < 0.25);  // of the other eye
    FrameSettings predicted = makeSettings(Mode::kPredicted);
    predicted.stereo.budget = 0.2;
    walk.frame().render(walk.eyes(), predicted);
    CHECK(shown[1].values == walk.frame().readPicture(kRight).values);
    for (int frame = 201; frame < 216; ++frame) { walk.go(frame); }
    CHECK(walk.psnr() > 36.0);
}

// As where a governor looks for the resolution that keeps the rate.
TEST_CASE_FIXTURE(Gpu, "a past comes from less than the way to the other eye; without one a frame is waited for") {
    constexpr double kStepMetres = 0.0033166;  // of eyesAt
    const auto countFull = [](Walk& walk) {
        const auto shown = walk.shown(), full = walk.full();
        return (shown[0].values == full[0].values ? 1 : 0) + (shown[1].values == full[1].values ? 1 : 0);
    };
    for (const auto& [metres, full] : {std::pair(0.04, 0), std::pair(0.06, 1)}) {
        Walk walk(context(), makeSettings(Mode::kTemporal));
        walk.go(0.0);
        walk.go(metres / kStepMetres);
        CHECK(countFull(walk) == full);
    }
    // One eye is rendered in any case, so that only the other's past counts, which is one frame old.
    Walk alternate(context(), makeSettings(Mode::kAlternate));
    for (int frame = 0; frame < 4; ++frame) { alternate.go(frame * 0.04 / kStepMetres); }
    CHECK(countFull(alternate) == 1);

    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    FrameSettings settings = makeSettings(Mode::kTemporal);
    std::vector<int> told;
    for (const double metres : {0.0, 0.003, 0.006, 0.009, 0.109, 0.112}) {
        const auto result = frame.renderAhead(eyesAt(view.eye, metres / kStepMetres), settings);
        told.push_back(result ? static_cast<int>(result->mark) : -1);
        ++settings.mark;
    }
    CHECK(told[3] < 3);   // told later
    CHECK(told[4] == 4);  // at once
}

TEST_CASE_FIXTURE(Gpu, "a past of another size or of other angles is a past like any other, also when both change in each frame") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    for (const bool ahead : {false, true}) {
        StereoFrame frame(context(), scene), full(context(), scene);
        const test::KeptKernels kept(context(), frame);
        for (int step = 0; step < 14; ++step) {
            Eye middle = view.eye;
            const double scale = step % 3 == 0 ? 1.0 : step % 3 == 1 ? 0.85 : 1.15, zoom = step % 2 == 0 ? 1.0 : 1.04;
            middle.size_px = glm::uvec2(glm::dvec2(view.eye.size_px) * scale);
            const double pixels = middle.size_px.x / static_cast<double>(view.eye.size_px.x);
            middle.intrinsics = {view.eye.intrinsics.fx * pixels * zoom, view.eye.intrinsics.fy * pixels * zoom,
                                 view.eye.intrinsics.cx * pixels, view.eye.intrinsics.cy * pixels};
            const std::array<Eye, 2> eyes = eyesAt(middle, step);
            FrameResult result;
            if (ahead) {
                result = frame.renderAhead(eyes, makeSettings(Mode::kTemporal, 0.4)).value();  // it is waited for
            } else {
                result = frame.render(eyes, makeSettings(Mode::kTemporal, 0.4));
            }
            if (step > 0) { CHECK(result.work_rendered < 0.45); }
            if (step < 4) { continue; }
            full.render(eyes, makeSettings(Mode::kShared));
            for (const int eye : {kLeft, kRight}) {
                const double psnr_db = compare(frame.readPicture(eye), full.readPicture(eye)).psnrDb();
                CAPTURE(step);
                CHECK(psnr_db > 34.0);
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "alternate renders one eye in full, in turn, and the other is what its last full render shows from there") {
    Walk walk(context(), makeSettings(Mode::kAlternate));
    walk.go(0.0);
    std::array<int, 2> turns{};
    for (int frame = 1; frame <= 6; ++frame) {
        walk.go(frame);
        // The order of splats is the eye's own, so that a few bits may differ.
        const auto shown = walk.shown(), full = walk.full();
        const std::array psnr_db{compare(shown[0], full[0]).psnrDb(), compare(shown[1], full[1]).psnrDb()};
        const bool left = psnr_db[0] > 70.0, right = psnr_db[1] > 70.0;
        CHECK(left != right);
        ++turns[left ? 0 : 1];
        CHECK(std::min(psnr_db[0], psnr_db[1]) > 35.0);
    }
    CHECK(turns == std::array{3, 3});
}

TEST_CASE_FIXTURE(Gpu, "frames that are not waited for are the same ones, also after one of another size") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame waited(context(), scene), ahead(context(), scene);
    const test::KeptKernels kept(context(), waited);
    for (int frame = 0; frame < 24; ++frame) {
        Eye middle = view.eye;
        const double scale = frame < 6 ? 1.0 : frame < 12 ? 0.7 : frame < 18 ? 0.6 : 1.0;
        middle.size_px = glm::uvec2(glm::dvec2(view.eye.size_px) * scale);
        middle.intrinsics = intrinsicsFromFovX(glm::radians(70.0), middle.size_px);
        const auto eyes = eyesAt(middle, frame);
        waited.render(eyes, makeSettings(Mode::kTemporal));
        ahead.renderAhead(eyes, makeSettings(Mode::kTemporal));
        if (frame % 6 != 5) { continue; }
        ahead.finish();
        for (const int eye : {kLeft, kRight}) { CHECK(ahead.readPicture(eye).values == waited.readPicture(eye).values); }
    }
}

TEST_CASE_FIXTURE(Gpu, "frames that are not waited for are the same ones") {
    for (const Mode mode : {Mode::kTemporal, Mode::kAlternate}) {
        Walk waited(context(), makeSettings(mode));
        const ViewedScene view = viewAtelier();
        const GpuScene scene(context(), view.scene);
        StereoFrame ahead(context(), scene);
        for (int frame = 0; frame < 5; ++frame) {
            waited.go(frame);
            ahead.renderAhead(eyesAt(view.eye, frame), makeSettings(mode));
        }
        ahead.finish();
        const auto shown = waited.shown();
        for (const int eye : {kLeft, kRight}) { CHECK(ahead.readPicture(eye).values == shown[static_cast<std::size_t>(eye)].values); }
    }
}

}  // namespace past_frames_test
