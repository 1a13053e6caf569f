// Facts about frames that are not waited for: they show what others show, and report one or two frames later.
#include "tests/engine/frame/frames_ahead.h"

SUITE(frame_ahead) {

using namespace test::ahead;

TEST_CASE_FIXTURE(Atelier, "a frame that is not waited for is the one that is, in every mode and size") {
    const std::array<glm::uvec2, 5> sizes_px{{{96, 96}, {64, 80}, {96, 96}, {81, 50}, {90, 96}}};
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared, Mode::kReproject, Mode::kPaper, Mode::kPredicted,
                            Mode::kAlternate, Mode::kTemporal}) {
        for (const glm::uvec2 most_px : {glm::uvec2(0), glm::uvec2(96)}) {
            INFO(nameOf(mode), ", most_px ", most_px.x);
            KeptFrame ahead(context(), scene), waited(context(), scene);
            FrameSettings settings = makeSettings(mode);
            // Kernels that were made before change nothing.
            ahead.makeKernels(eyesAt(ofSize(view.eye, {96, 16}), 0), settings);
            const int sizes = settings.keep_history || most_px.x > 0 ? 5 : 1;
            for (int step = 0; step < 4 * sizes; ++step) {
                const glm::uvec2 size_px = sizes_px.at(static_cast<std::size_t>(step / 4));
                const auto eyes = eyesAt(ofSize(view.eye, size_px), step);
                std::vector<std::uint8_t> hidden(tileCount(size_px), 0);
                hidden.front() = 1;
                if (step / 4 >= 2) { settings.hidden_tiles = {hidden, hidden}; }
                settings.most_px = most_px;
                ahead.renderAhead(eyes, settings);
                settings.most_px = {};
                // `predicted` uses the frame before
                if (settings.keep_history || step % 4 >= 2 || step == 0) { waited.render(eyes, settings); }
                if (step % 4 == 3 || step == 0) { CHECK(shownBy(ahead) == shownBy(waited)); }
            }
        }
    }
}

TEST_CASE_FIXTURE(Atelier, "frames of a scene as it was go on with it, and none is waited for") {
    auto was = std::make_unique<GpuScene>(scene.asItIs());
    KeptFrame frame(context(), *was), other(context(), scene);
    const auto eyes = eyesAt(view.eye, 0);
    goAhead(frame, eyes, seeing(), 2);
    frame.finish();
    frame.goOnWith(scene);
    was.reset();
    CHECK_FALSE(frame.renderAhead(eyes, seeing()));
    CHECK(shownBy(frame) == renderPair(other, eyes, seeing()));
}

TEST_CASE_FIXTURE(Atelier, "what a frame says of itself comes two frames later, the first and last at once") {
    KeptFrame frame(context(), scene), waited(context(), scene);
    std::vector<std::uint64_t> visible;
    std::vector<int> told;
    const auto take = [&](const std::optional<FrameResult>& result) {
        told.push_back(result ? static_cast<int>(result->mark) : -1);
        if (result) { CHECK(countOf(*result, "splats_visible_left") == visible.at(result->mark)); }
    };
    FrameSettings settings = seeing();
    for (int step = 0; step < 6; ++step) {
        const auto eyes = eyesAt(view.eye, step);
        visible.push_back(countOf(waited.render(eyes, settings), "splats_visible_left"));
        take(frame.renderAhead(eyes, settings));
        ++settings.mark;
    }
    take(frame.finish());
    // The first frame is waited for, since nothing is known about its lists.
    CHECK(told == std::vector{0, -1, -1, 1, 2, 3, 5});
    CHECK_FALSE(frame.finish().has_value());
}

TEST_CASE_FIXTURE(Atelier, "lists have room ahead however many pairs a pixel has") {
    StereoFrame counting(context(), scene);
    const auto pairsOf = [&](const std::array<Eye, 2>& eyes) {
        const FrameResult result = counting.render(eyes, seeing());
        return std::max(countOf(result, "tile_pairs_left"), countOf(result, "tile_pairs_right"));
    };
    std::size_t tried = 0;
    for (unsigned side = 24; side <= 120; side += 4) {
        CAPTURE(side);
        const auto narrow = stereoPair(ofSize(view.eye, {side, side}), 0.063);
        const auto pairs = static_cast<double>(pairsOf(narrow));
        // A wider view, with a tenth more pairs.
        std::array<Eye, 2> wide = narrow;
        double more = 1.0;
        while (more < 1.06) {
            for (Eye& eye : wide) { eye.intrinsics.fx *= 0.99, eye.intrinsics.fy *= 0.99; }
            more = static_cast<double>(pairsOf(wide)) / pairs;
        }
        if (more > StereoFrame::kCapacityAhead) { continue; }
        ++tried;
        KeptFrame frame(context(), scene, kNoRoom);
        frame.renderAhead(narrow, seeing());
        auto last = frame.renderAhead(wide, seeing());
        if (!last) { last = frame.finish(); }
        CHECK(countOf(*last, "frames_done_again") == 1);  // the first one
        CHECK(countOf(*last, "frames_cut_short") == 0);
    }
    CHECK(tried > 15);
}

TEST_CASE_FIXTURE(Atelier, "walking is no jump, at any scale; a wearer's step and snap turn are") {
    // Whether a frame is waited for, in which case it reports at once.
    const auto waits = [&](double units_per_metre, double metres, double degrees) {
        KeptFrame frame(context(), scene);
        FrameSettings settings = seeing();
        settings.near = 0.01 * units_per_metre;
        settings.units_per_metre = units_per_metre;
        Eye there = turned(view.eye, glm::radians(degrees));
        there.world_from_camera.position.x += metres * units_per_metre;
        frame.renderAhead(stereoPair(view.eye, 0.063 * units_per_metre), settings);
        settings.mark = 1;
        const auto result = frame.renderAhead(stereoPair(there, 0.063 * units_per_metre), settings);
        return result && result->mark == 1;
    };
    for (const double units_per_metre : {0.01, 1.0, 2.0}) {
        CAPTURE(units_per_metre);
        CHECK_FALSE(waits(units_per_metre, 0.19, 5.5));
        CHECK(waits(units_per_metre, 0.21, 0.0));
        CHECK(waits(units_per_metre, 0.0, 6.5));
    }
}

TEST_CASE_FIXTURE(Atelier, "other sizes, modes and hidden tiles wait for the frames that are under way") {
    KeptFrame frame(context(), scene);
    std::vector<std::uint8_t> hidden(std::size_t{6} * 6, 0);
    hidden[0] = 1;
    std::uint64_t mark = 0;
    for (const Mode mode :
         {Mode::kShared, Mode::kPredicted, Mode::kPaper, Mode::kShared, Mode::kPredicted, Mode::kPaper}) {
        for (int step = 0; step < 3; ++step) {
            frame.renderAhead(eyesAt(view.eye, step), makeSettings(mode, kLeft, ++mark));
        }
        FrameSettings masked = makeSettings(mode, kLeft, ++mark);
        masked.hidden_tiles = {hidden, hidden};
        CHECK(frame.renderAhead(eyesAt(view.eye, 3), masked)->mark == mark);
        const auto small = eyesAt(ofSize(view.eye, {64, 48}), 0);
        CHECK(frame.renderAhead(small, makeSettings(mode, kLeft, ++mark))->mark == mark);
    }
    CHECK_FALSE(frame.finish().has_value());
}

TEST_CASE_FIXTURE(Atelier, "frames with the same kernels draw their own scenes, also on two threads") {
    const ViewedScene other_view = viewBuiltin("builtin:fence", {96, 96});
    const GpuScene other_scene(context(), other_view.scene);
    const auto pictureOf = [](StereoFrame& frame, const Eye& eye) {
        frame.render(eyesAt(eye, 0), makeSettings(Mode::kPredicted));
        return frame.readPicture(kRight).values;
    };
    KeptFrame alone(context(), scene), other_alone(context(), other_scene);
    const auto expected = pictureOf(alone, view.eye), other_expected = pictureOf(other_alone, other_view.eye);
    PassKernels kernels(context());
    StereoFrame frame(context(), scene, kernels);
    auto other = std::make_unique<StereoFrame>(context(), other_scene, kernels);
    // Both make those that they need.
    std::vector<float> other_picture;
    std::thread beside([&] { other_picture = pictureOf(*other, other_view.eye); });
    CHECK(pictureOf(frame, view.eye) == expected);
    beside.join();
    CHECK(other_picture == other_expected);
    const std::size_t made = kernels.size();
    CHECK(pictureOf(*other, other_view.eye) == other_expected);
    other.reset();
    CHECK(pictureOf(frame, view.eye) == expected);
    CHECK(kernels.size() == made);
    frame.rebuildKernels();
    CHECK(pictureOf(frame, view.eye) == expected);
}

}  // SUITE(frame_ahead)
