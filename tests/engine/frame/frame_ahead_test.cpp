// Facts about frames that are not waited for: the same pictures as of those that are, told a frame or two late, and lists with room ahead.
#include "engine/error.h"
#include "engine/frame/stereo_frame.h"
#include "tests/engine/frame/frame_runs.h"

#include <doctest/doctest.h>

#include <memory>

TEST_SUITE_BEGIN("frame_ahead");

namespace frame_ahead_test {

using namespace binosplat;
using test::Gpu;
using test::ViewedScene;

namespace {

FrameSettings makeSettings(Mode mode, std::uint64_t mark = 0) {
    FrameSettings settings;
    settings.mode = mode;
    settings.mark = mark;
    return settings;
}

ViewedScene viewAtelier() { return test::viewBuiltin("builtin:atelier", {128, 128}, 20000); }

// A head that goes on a little, and turns a little.
std::array<Eye, 2> eyesAt(const Eye& middle, int step) {
    Eye eye = middle;
    eye.world_from_camera.position.x += 0.01 * step;
    eye.world_from_camera.orientation = eye.world_from_camera.orientation * glm::angleAxis(0.02 * step, glm::dvec3(0, 1, 0));
    return stereoPair(eye, 0.063);
}

std::uint64_t count(const FrameResult& result, const char* name) {
    const auto counters = result.counters.named();
    return counters.contains(name) ? counters.at(name) : 0;
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "a frame that is not waited for is the one that is, byte for byte, in every mode") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared, Mode::kReproject, Mode::kPaper, Mode::kPredicted}) {
        CAPTURE(static_cast<int>(mode));
        std::array<Image, 2> pictures;
        {
            StereoFrame ahead(context(), scene);
            const test::KeptKernels kept(context(), ahead);
            for (int step = 0; step < 4; ++step) { ahead.renderAhead(eyesAt(view.eye, step), makeSettings(mode)); }
            pictures = {ahead.readPicture(kLeft), ahead.readPicture(kRight)};
        }
        StereoFrame waited(context(), scene);
        const test::KeptKernels kept(context(), waited);
        // `predicted` looks at the frame before for whether moving pays.
        for (int step = 2; step < 4; ++step) { waited.render(eyesAt(view.eye, step), makeSettings(mode)); }
        for (const int eye : {kLeft, kRight}) { CHECK(pictures[static_cast<std::size_t>(eye)].values == waited.readPicture(eye).values); }
    }
}

TEST_CASE_FIXTURE(Gpu, "what a frame says of itself comes two frames later, the first and the last at once") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame waited(context(), scene), frame(context(), scene);
    const test::KeptKernels kept_waited(context(), waited), kept(context(), frame);
    std::vector<std::uint64_t> visible;
    for (int step = 0; step < 6; ++step) {
        visible.push_back(count(waited.render(eyesAt(view.eye, step), makeSettings(Mode::kShared)), "splats_visible_left"));
    }
    std::vector<int> told;
    const auto take = [&](const std::optional<FrameResult>& result) {
        told.push_back(result ? static_cast<int>(result->mark) : -1);
        if (result) { CHECK(count(*result, "splats_visible_left") == visible[result->mark]); }
    };
    for (int step = 0; step < 6; ++step) {
        take(frame.renderAhead(eyesAt(view.eye, step), makeSettings(Mode::kShared, static_cast<std::uint64_t>(step))));
    }
    take(frame.finish());
    // The first is waited for, since nothing is known of its lists.
    CHECK(told == std::vector{0, -1, -1, 1, 2, 3, 5});
    CHECK_FALSE(frame.finish().has_value());
}

TEST_CASE("the host goes on while the device draws") {
    vk::PhysicalDeviceTimelineSemaphoreFeatures waits_for_host(VK_TRUE);
    const Context context({.device = {}, .validation = true, .max_allocation_bytes = 0, .device_features = &waits_for_host});
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context, view.scene);
    StereoFrame frame(context, scene);
    frame.renderAhead(eyesAt(view.eye, 0), makeSettings(Mode::kShared));
    // All that is submitted from now on waits for the host, which would wait for ever were a frame waited for.
    const vk::SemaphoreTypeCreateInfo timeline(vk::SemaphoreType::eTimeline, 0);
    const vk::raii::Semaphore gate = context.device().createSemaphore(vk::SemaphoreCreateInfo({}, &timeline));
    const vk::raii::CommandPool pool = context.device().createCommandPool({{}, context.queueFamily()});
    const vk::raii::CommandBuffers hold(context.device(), vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1));
    hold[0].begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    const auto all = vk::PipelineStageFlagBits::eAllCommands;
    hold[0].pipelineBarrier(all, all, {}, {}, {}, {});
    hold[0].end();
    constexpr std::uint64_t kOpen = 1;
    const auto values = vk::TimelineSemaphoreSubmitInfo().setWaitSemaphoreValues(kOpen);
    const vk::PipelineStageFlags stages = all;
    context.queue().submit(vk::SubmitInfo(*gate, stages, *hold[0], {}, &values));
    CHECK_FALSE(frame.renderAhead(eyesAt(view.eye, 1), makeSettings(Mode::kShared)).has_value());
    CHECK_FALSE(frame.renderAhead(eyesAt(view.eye, 2), makeSettings(Mode::kShared)).has_value());
    context.device().signalSemaphore(vk::SemaphoreSignalInfo(*gate, kOpen));
    CHECK(frame.finish().has_value());
    context.device().waitIdle();
    CHECK(context.validationMessages().empty());
}

TEST_CASE_FIXTURE(Gpu, "lists have room ahead of what eyes need, so that a view that moves is not cut short") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene, {.first_capacity = {1, 1}, .threads_per_cell = 0});
    const test::KeptKernels kept(context(), frame);
    for (int step = 0; step < 30; ++step) {
        const auto result = frame.renderAhead(eyesAt(view.eye, step), makeSettings(Mode::kShared));
        if (step == 0) { CHECK(count(*result, "frames_done_again") == 1); }  // nothing was known yet
    }
    const FrameResult last = *frame.finish();
    CHECK(count(last, "frames_cut_short") == 0);
}

TEST_CASE_FIXTURE(Gpu, "after a jump a frame is waited for, and done again before anybody sees it") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame waited(context(), scene), frame(context(), scene, {.first_capacity = {1, 1}, .threads_per_cell = 0});
    const test::KeptKernels kept_waited(context(), waited), kept(context(), frame);
    // From a look away from everything to a look at it.
    Eye away = view.eye;
    away.world_from_camera.orientation = away.world_from_camera.orientation * glm::angleAxis(3.1, glm::dvec3(0, 1, 0));
    for (int step = 0; step < 3; ++step) { frame.renderAhead(eyesAt(away, 0), makeSettings(Mode::kShared)); }
    const auto result = frame.renderAhead(eyesAt(view.eye, 0), makeSettings(Mode::kShared, 7));
    REQUIRE(result.has_value());
    CHECK(result->mark == 7);
    CHECK(count(*result, "frames_done_again") > 0);
    CHECK(count(*result, "frames_cut_short") == 0);
    waited.render(eyesAt(view.eye, 0), makeSettings(Mode::kShared));
    CHECK(frame.readPicture(kLeft).values == waited.readPicture(kLeft).values);
}

TEST_CASE_FIXTURE(
    Gpu, "walking is no jump, however near the near plane and however large the scene; a step of the wearer and a turn by a step are") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    // Whether a frame is waited for: then what it says comes at once.
    const auto waits = [&](double units_per_metre, double metres, double degrees) {
        StereoFrame frame(context(), scene);
        const test::KeptKernels kept(context(), frame);
        FrameSettings settings = makeSettings(Mode::kShared);
        settings.near = 0.01 * units_per_metre;
        settings.units_per_metre = units_per_metre;
        Eye there = view.eye;
        there.world_from_camera.position.x += metres * units_per_metre;
        there.world_from_camera.orientation =
            there.world_from_camera.orientation * glm::angleAxis(glm::radians(degrees), glm::dvec3(0, 1, 0));
        frame.renderAhead(stereoPair(view.eye, 0.063 * units_per_metre), settings);
        settings.mark = 1;
        const auto result = frame.renderAhead(stereoPair(there, 0.063 * units_per_metre), settings);
        return result && result->mark == 1;
    };
    for (const double units_per_metre : {0.01, 1.0, 2.0}) {
        CAPTURE(units_per_metre);
        CHECK_FALSE(waits(units_per_metre, 0.04, 0.0));
        CHECK_FALSE(waits(units_per_metre, 0.19, 5.5));
        CHECK(waits(units_per_metre, 0.21, 0.0));
        CHECK(waits(units_per_metre, 0.0, 6.5));
    }
}

TEST_CASE_FIXTURE(Gpu, "whatever lists have no room, a frame is done again once at most, and the one after it is whole") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    Eye away = view.eye;
    away.world_from_camera.orientation = away.world_from_camera.orientation * glm::angleAxis(3.1, glm::dvec3(0, 1, 0));
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared, Mode::kReproject, Mode::kPaper, Mode::kPredicted}) {
        CAPTURE(nameOf(mode));
        std::array<Image, 2> expected;
        {
            StereoFrame waited(context(), scene);
            const test::KeptKernels kept(context(), waited);
            for (int step = 0; step < 2; ++step) { waited.render(eyesAt(view.eye, 0), makeSettings(mode)); }
            expected = {waited.readPicture(kLeft), waited.readPicture(kRight)};
        }
        StereoFrame frame(context(), scene, {.first_capacity = {1, 1}, .threads_per_cell = 0});
        const test::KeptKernels kept(context(), frame);
        std::uint64_t before = 0, short_before = 0;
        // The first frame, a jump to where there is nothing, and one back.
        for (const Eye& eye : {view.eye, away, view.eye}) {
            FrameResult last{};
            for (int step = 0; step < 4; ++step) {
                if (auto result = frame.renderAhead(eyesAt(eye, 0), makeSettings(mode))) { last = std::move(*result); }
                if (step == 0) {
                    CHECK(count(last, "frames_done_again") <= before + 1);
                    short_before = count(last, "frames_cut_short");
                }
            }
            CHECK(count(last, "frames_done_again") <= before + 2);
            CHECK(count(last, "frames_cut_short") == short_before);
            before = count(last, "frames_done_again");
        }
        for (const int eye : {kLeft, kRight}) { CHECK(frame.readPicture(eye).values == expected[static_cast<std::size_t>(eye)].values); }
    }
}

TEST_CASE_FIXTURE(Gpu, "kernels that were made before change nothing in a picture") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    for (const Mode mode : {Mode::kShared, Mode::kPaper, Mode::kPredicted}) {
        StereoFrame plain(context(), scene), ready(context(), scene);
        const test::KeptKernels kept(context(), plain);
        Eye small = view.eye;
        small.size_px = {128, 16};
        ready.makeKernels(stereoPair(small, 0.063), makeSettings(mode));
        plain.render(eyesAt(view.eye, 0), makeSettings(mode));
        ready.render(eyesAt(view.eye, 0), makeSettings(mode));
        for (const int eye : {kLeft, kRight}) { CHECK(ready.readPicture(eye).values == plain.readPicture(eye).values); }
    }
}

TEST_CASE_FIXTURE(Gpu, "a frame that finds no room although its eyes did not jump is counted, and the next one is whole") {
    // Nothing moves but a wall of splats that comes out from behind the near plane.
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame waited(context(), scene), frame(context(), scene, {.first_capacity = {1, 1}, .threads_per_cell = 0});
    const test::KeptKernels kept_waited(context(), waited), kept(context(), frame);
    FrameSettings blind = makeSettings(Mode::kShared), seeing = makeSettings(Mode::kShared);
    blind.near = 1e4;
    for (int step = 0; step < 3; ++step) { frame.renderAhead(eyesAt(view.eye, 0), blind); }
    FrameResult last{};
    for (int step = 0; step < 4; ++step) {
        if (auto result = frame.renderAhead(eyesAt(view.eye, 0), seeing)) { last = std::move(*result); }
    }
    CHECK(count(last, "frames_cut_short") > 0);
    CHECK(count(last, "frames_done_again") > 0);
    waited.render(eyesAt(view.eye, 0), seeing);
    CHECK(frame.readPicture(kLeft).values == waited.readPicture(kLeft).values);
    CHECK(frame.readPicture(kRight).values == waited.readPicture(kRight).values);
}

TEST_CASE_FIXTURE(Gpu, "lists that the device has no memory for cost the picture, not the session") {
    const ViewedScene view = viewAtelier();
    FrameSettings blind = makeSettings(Mode::kShared), seeing = makeSettings(Mode::kShared);
    blind.near = 1e4;
    const FrameOptions small{.first_capacity = {1, 1}, .threads_per_cell = 0};
    const std::uint64_t before = context().memoryUse().current_bytes;
    const GpuScene roomy_scene(context(), view.scene);
    StereoFrame roomy(context(), roomy_scene, small);
    const test::KeptKernels kept(context(), roomy);
    roomy.render(eyesAt(view.eye, 0), blind);
    const std::uint64_t least = context().memoryUse().current_bytes - before;
    roomy.render(eyesAt(view.eye, 0), seeing);
    const std::uint64_t most = context().memoryUse().current_bytes - before;

    const Context tight({.device = {}, .validation = test::kValidation, .memory_limit_bytes = (least + most) / 2});
    const GpuScene scene(tight, view.scene);
    StereoFrame frame(tight, scene, small);
    for (int step = 0; step < 3; ++step) { frame.renderAhead(eyesAt(view.eye, 0), blind); }
    FrameResult last{};
    for (int step = 0; step < 4; ++step) {
        if (auto result = frame.renderAhead(eyesAt(view.eye, 0), seeing)) { last = std::move(*result); }
    }
    CHECK(count(last, "frames_cut_short") > 0);
    CHECK(count(last, "tile_pairs_left") == 0);
    // What fits is shown again.
    const std::uint64_t cut_short = count(last, "frames_cut_short");
    for (int step = 0; step < 4; ++step) {
        if (auto result = frame.renderAhead(eyesAt(view.eye, 0), blind)) { last = std::move(*result); }
    }
    CHECK(count(last, "frames_cut_short") <= cut_short + 2);  // two were under way
    // Another scene, which fits, begins anew in the same frame.
    const ViewedScene splat = test::viewBuiltin("builtin:one-splat", {128, 128});
    const GpuScene splat_scene(tight, splat.scene), roomy_splat(context(), splat.scene);
    frame.show(splat_scene);
    for (int step = 0; step < 4; ++step) {
        if (auto result = frame.renderAhead(eyesAt(splat.eye, step), seeing)) { last = std::move(*result); }
    }
    frame.finish();
    CHECK(count(last, "frames_cut_short") == 0);
    roomy.show(roomy_splat);
    roomy.render(eyesAt(splat.eye, 3), seeing);
    CHECK(frame.readPicture(kLeft).values == roomy.readPicture(kLeft).values);
    CHECK(tight.validationMessages().empty());
}

TEST_CASE_FIXTURE(Gpu, "pictures that the device has no memory for are refused before a frame is begun, and smaller ones go on") {
    const ViewedScene view = viewAtelier();
    const Context tight({.device = {}, .validation = test::kValidation, .memory_limit_bytes = 64u << 20});
    const GpuScene scene(tight, view.scene);
    StereoFrame frame(tight, scene);
    const FrameSettings settings = makeSettings(Mode::kPredicted);
    const std::array<Eye, 2> fits = eyesAt(view.eye, 0);
    std::array<Eye, 2> large = fits;
    for (Eye& eye : large) { eye.size_px = {4096, 4096}; }
    for (int step = 0; step < 3; ++step) {
        frame.makeRoom(fits, settings);
        frame.renderAhead(fits, settings);
    }
    frame.finish();
    const Image before = frame.readPicture(kRight);
    for (int time = 0; time < 2; ++time) { CHECK_THROWS_AS(frame.makeRoom(large, settings), Error); }
    for (int step = 0; step < 3; ++step) {
        frame.makeRoom(fits, settings);
        frame.renderAhead(fits, settings);
    }
    frame.finish();
    CHECK(frame.readPicture(kRight).values == before.values);
    CHECK(tight.validationMessages().empty());
}

TEST_CASE_FIXTURE(Gpu, "other sizes, modes and hidden tiles wait for the frames that are under way") {
    const ViewedScene view = viewAtelier();
    const GpuScene scene(context(), view.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    std::array<Eye, 2> small = eyesAt(view.eye, 0);
    for (Eye& eye : small) {
        eye.size_px = {64, 48};
        eye.intrinsics = intrinsicsFromFovX(1.0, eye.size_px);
    }
    std::vector<std::uint8_t> hidden(tilesOf({128, 128}).x * tilesOf({128, 128}).y, 0);
    hidden[0] = 1;
    std::uint64_t mark = 0;
    for (int round = 0; round < 2; ++round) {
        for (const Mode mode : {Mode::kShared, Mode::kPredicted, Mode::kPaper}) {
            for (int step = 0; step < 3; ++step) { frame.renderAhead(eyesAt(view.eye, step), makeSettings(mode, ++mark)); }
            FrameSettings masked = makeSettings(mode, ++mark);
            masked.hidden_tiles = {hidden, hidden};
            CHECK(frame.renderAhead(eyesAt(view.eye, 3), masked)->mark == mark);
            CHECK(frame.renderAhead(small, makeSettings(mode, ++mark))->mark == mark);
        }
    }
    CHECK_FALSE(frame.finish().has_value());
}

TEST_CASE_FIXTURE(Gpu, "a frame that goes on with another's kernels draws its own scene, and the other one can go or go on") {
    const ViewedScene view = viewAtelier(), other_view = test::viewBuiltin("builtin:fence", {128, 128});
    const GpuScene scene(context(), view.scene), other_scene(context(), other_view.scene);
    const auto pictureOf = [](StereoFrame& frame, const Eye& eye) {
        frame.render(eyesAt(eye, 0), makeSettings(Mode::kPredicted));
        return frame.readPicture(kRight).values;
    };
    const auto pictureAlone = [&](const GpuScene& of, const Eye& eye) {
        StereoFrame alone(context(), of);
        const test::KeptKernels kept(context(), alone);
        return pictureOf(alone, eye);
    };
    const auto expected = pictureAlone(scene, view.eye), other_expected = pictureAlone(other_scene, other_view.eye);
    auto before = std::make_unique<StereoFrame>(context(), other_scene);
    for (int step = 0; step < 2; ++step) { before->renderAhead(eyesAt(other_view.eye, step), makeSettings(Mode::kPredicted)); }
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    frame.takeKernels(*before);  // while frames are under way
    CHECK(pictureOf(frame, view.eye) == expected);
    CHECK(pictureOf(*before, other_view.eye) == other_expected);
    before.reset();
    CHECK(pictureOf(frame, view.eye) == expected);
    frame.rebuildKernels();
    CHECK(pictureOf(frame, view.eye) == expected);
}

}  // namespace frame_ahead_test
