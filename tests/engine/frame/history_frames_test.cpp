// Facts about frames that are reprojected from the history: what they equal if nothing moves, and their cost.
#include "tests/engine/passes/history_stages.h"

SUITE(history_frames) {

constexpr glm::uvec2 kSizePx(208, 176);

FrameSettings withBudget(Mode mode, double budget) {
    FrameSettings settings = makeSettings(mode);
    settings.stereo.budget = budget;
    return settings;
}

// With coarse tiles where the eyes do not look.
FrameSettings withCoarse(Mode mode) {
    FrameSettings settings = makeSettings(mode);
    settings.half_periphery = true;
    settings.gazes = {kAside, kAside};
    return settings;
}

// Each eye by itself, without a history.
std::array<Image, 2> seenAlone(HistoryWalk& walk) {
    const auto frame = StereoFrame::beside(walk.frame());
    const FrameSettings settings = withCoarse(Mode::kMono);
    return {renderEye(*frame, walk.eyes()[kLeft], settings),
            renderEye(*frame, walk.eyes()[kRight], settings)};
}

bool leavesOutReprojection(const FrameResult& result) {
    return std::ranges::any_of(result.left_out,
                               [](const std::string& what) { return what.starts_with("reprojection: "); });
}

// How many of both eyes' pictures are full renders to the last bit.
int countFull(HistoryWalk& walk) {
    const auto shown = walk.shown(), full = walk.full();
    return (shown[0].values == full[0].values ? 1 : 0) + (shown[1].values == full[1].values ? 1 : 0);
}

TEST_CASE_FIXTURE(Gpu, "where no history is kept, temporal is predicted and alternate is shared") {
    const ViewedScene view = viewAtelier(kSizePx);
    for (const auto& [mode, same] :
         {std::pair(Mode::kTemporal, Mode::kPredicted), std::pair(Mode::kAlternate, Mode::kShared)}) {
        KeptFrame frame(context(), view.scene), other(context(), view.scene);
        FrameSettings settings = makeSettings(mode);
        settings.keep_history = false;
        for (int step = 0; step < 2; ++step) {
            const auto eyes = walkedEyes(view.eye, step);
            CHECK(renderPair(frame, eyes, settings) == renderPair(other, eyes, makeSettings(same)));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a head that stands still sees all in full within 30 frames, and then for no work") {
    for (const bool coarse : {false, true}) {
        CAPTURE(coarse);
        HistoryWalk walk(*this, coarse ? viewWide(kSizePx) : viewAtelier(kSizePx),
                         coarse ? withCoarse(Mode::kTemporal) : makeSettings(Mode::kTemporal));
        for (int frame = 0; frame < 4; ++frame) { walk.go(frame); }
        for (int frame = 0; frame < 30; ++frame) { walk.go(4.0); }
        if (coarse) {  // errors that nobody notices get their turn now and then
            CHECK(walk.go(4.0).work_rendered < 0.005);
            CHECK(psnrDb(walk.shown(), seenAlone(walk)) > 50.0);
            continue;
        }
        for (int frame = 0; frame < 3; ++frame) {
            CHECK(walk.go(4.0).work_rendered == 0.0);
            CHECK(countFull(walk) == 2);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "with work for nearly all both eyes are nearly the full render") {
    const ViewedScene view = viewAtelier(kSizePx);
    const GpuScene scene(context(), view.scene);
    // Parallel eyes are rendered side by side, canted ones one after the other.
    for (const double cant : {0.0, 0.05}) {
        CAPTURE(cant);
        KeptFrame frame(context(), scene, {.first_capacity = {1, 1}}), full(context(), scene);
        for (int step = 0; step < 5; ++step) {
            std::array<Eye, 2> eyes = walkedEyes(view.eye, step);
            eyes[1] = turned(eyes[1], cant);
            const FrameResult result = frame.render(eyes, withBudget(Mode::kTemporal, 0.9));
            if (step == 4) { CHECK(result.counters.commands == (cant > 0.0 ? 35u : 22u)); }
            full.render(eyes, makeSettings(Mode::kShared));
            CHECK(psnrDb(picturesOf(frame), picturesOf(full)) >= 53.0);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a walk keeps its quality within the budget, without a frame that costs more") {
    struct Way {
        Mode mode;
        bool coarse;
        Range work;  // at most one tile more than the budget
        double least_db;
    };
    for (const auto& [mode, coarse, work, least_db] : {Way{Mode::kTemporal, false, between(0.15, 0.22), 36.0},
                                                       Way{Mode::kTemporal, true, between(0.1, 0.23), 34.0},
                                                       Way{Mode::kAlternate, true, within(0.0, 1.0), 34.0}}) {
        INFO("mode ", nameOf(mode), ", coarse ", coarse);
        HistoryWalk walk(*this, coarse ? viewWide(kSizePx) : viewAtelier(kSizePx),
                         coarse ? withCoarse(mode) : makeSettings(mode));
        walk.go(0.0);
        if (!coarse) { CHECK(walk.shown()[0].values == walk.full()[0].values); }  // without a history
        for (int frame = 1; frame <= 12; ++frame) {
            const FrameResult result = walk.go(frame);
            CHECK(result.work_rendered == work);
            if (frame % 6 == 0) { CHECK(walk.psnr() > least_db); }
            if (coarse) { continue; }
            REQUIRE(result.counters.warped);
            CHECK(result.counters.warped->tiles_patched > 0);
            CHECK(result.counters.commands <= 22);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "where reprojecting would cost more than it saves, frames are rendered in full") {
    const ViewedScene view = viewAtelier(kSizePx);
    KeptFrame frame(context(), view.scene), full(context(), view.scene);
    FrameSettings settings = makeSettings(Mode::kTemporal);
    frame.makeKernels(walkedEyes(view.eye, 0), settings);
    const std::size_t kernels = frame.kernelCount();
    const auto go = [&](int step, gpu::uint move_cost) {
        settings.stereo.move_cost = move_cost;
        std::optional<FrameResult> result = frame.renderAhead(walkedEyes(view.eye, step), settings);
        if (std::optional<FrameResult> last = frame.finish()) { result = std::move(last); }
        return result.value();
    };
    for (int step = 0; step < 3; ++step) { CHECK(go(step, 0).counters.warped.has_value() == (step > 0)); }
    // The first frame with other settings is made from its history, and finds out; then lists for both
    // pictures are made beside a frame.
    for (int step = 3; step < 5; ++step) { CHECK(go(step, 1000000).counters.warped); }
    for (int step = 5; step < 7; ++step) {
        const FrameResult result = go(step, 1000000);
        CHECK_FALSE(result.counters.warped);
        CHECK(result.counters.commands <= 20);
        CHECK(leavesOutReprojection(result));
        CHECK(shownBy(frame) == renderPair(full, walkedEyes(view.eye, step), makeSettings(Mode::kShared)));
    }
    // What they leave is a history like any other.
    const FrameResult result = go(7, 0);
    REQUIRE(result.counters.warped);
    CHECK(result.work_rendered <= 0.22);
    full.render(walkedEyes(view.eye, 7), makeSettings(Mode::kShared));
    CHECK(psnrDb(picturesOf(frame), picturesOf(full)) > 36.0);
    CHECK(frame.kernelCount() == kernels);
    CHECK(result.counters.ahead->frames_cut_short == 0);
}

TEST_CASE("whether reprojecting pays is decided by its cost, and tried again after a while") {
    HistoryPays pays;
    HistoryPays::Asked asked;
    asked.stereo.move_cost = 32;
    pays.ask(asked);
    const auto learn = [&](double full, std::optional<double> rendered) {
        pays.learn(asked, full, rendered, 10.0);
        return pays.mayReproject();
    };
    CHECK(learn(600.0, 279.0));
    CHECK_FALSE(learn(600.0, 281.0));
    // It must then save an eighth more.
    CHECK_FALSE(learn(600.0, 260.0));
    int frames = 0;
    while (!learn(600.0, std::nullopt) && frames < 1000) { ++frames; }
    CHECK(frames >= 3);
    CHECK(frames <= 90);
    // If there is hardly anything to save, it is not tried; if there is a lot of work, always.
    for (int frame = 0; frame < 1000; ++frame) { CHECK_FALSE(learn(300.0, std::nullopt)); }
    CHECK(learn(1000.0, 990.0));
    CHECK_FALSE(learn(300.0, 0.0));
    // Frames with other settings say nothing, and are not spoken of.
    HistoryPays::Asked other = asked;
    other.stereo.budget = 0.1;
    pays.learn(other, 600.0, 0.0, 10.0);
    CHECK_FALSE(pays.mayReproject());
    pays.ask(other);
    CHECK(pays.mayReproject());
}

TEST_CASE_FIXTURE(Gpu, "where it is known where the eyes look, the budget is spent there") {
    // The error in the left third of both pictures, over some frames.
    const auto errorOf = [&](const FrameSettings& settings) {
        HistoryWalk walk(*this, viewAtelier(kSizePx), settings);
        double error = 0.0;
        for (int frame = 0; frame <= 12; ++frame) {
            const FrameResult result = walk.go(frame);
            if (frame < 6) { continue; }
            CHECK(result.work_rendered == between(0.15, 0.22));
            if (frame % 6 != 0) { continue; }
            const auto shown = walk.shown(), full = walk.full();
            for (std::size_t i = 0; i < shown[0].values.size(); ++i) {
                const bool counts = i % 4 < 3 && 3 * (i / 4 % shown[0].size_px.x) < shown[0].size_px.x;
                for (std::size_t e = 0; counts && e < 2; ++e) {
                    error += std::pow(shown[e].values[i] - full[e].values[i], 2);
                }
            }
        }
        return error;
    };
    FrameSettings looks = makeSettings(Mode::kTemporal);
    looks.gazes = {Gaze{{-0.8, 0.0, 1.0}, 0.0}, Gaze{{-0.8, 0.0, 1.0}, 0.0}};
    CHECK(errorOf(looks) < 0.8 * errorOf(makeSettings(Mode::kTemporal)));
}

TEST_CASE_FIXTURE(Gpu, "a history comes from nearer than the other eye; else frames are waited for") {
    constexpr double kStepMetres = 0.0033166;  // the step of walkedEyes
    for (const auto& [metres, full] : {std::pair(0.04, 0), std::pair(0.06, 2)}) {
        HistoryWalk walk(*this, viewAtelier(kSizePx), makeSettings(Mode::kTemporal));
        walk.go(0.0);
        walk.go(metres / kStepMetres);
        CHECK(countFull(walk) == full);
    }
    // One eye is always rendered, so only the other's history counts, which is one frame old.
    HistoryWalk alternate(*this, viewAtelier(kSizePx), makeSettings(Mode::kAlternate));
    for (int frame = 0; frame < 4; ++frame) { alternate.go(frame * 0.04 / kStepMetres); }
    CHECK(countFull(alternate) == 1);

    const ViewedScene view = viewAtelier(kSizePx);
    KeptFrame frame(context(), view.scene);
    FrameSettings settings = makeSettings(Mode::kTemporal);
    std::vector<int> told;
    for (const double metres : {0.0, 0.003, 0.006, 0.009, 0.109, 0.112}) {
        const auto result = frame.renderAhead(walkedEyes(view.eye, metres / kStepMetres), settings);
        told.push_back(result ? static_cast<int>(result->mark) : -1);
        ++settings.mark;
    }
    CHECK(told[3] < 3);   // reported later
    CHECK(told[4] == 4);  // reported at once
}

// The resolution changes as it does when a governor looks for the one that holds the rate.
TEST_CASE_FIXTURE(Gpu, "a history of another size or other angles is a history like any other") {
    HistoryWalk walk(*this, viewAtelier(kSizePx), withBudget(Mode::kTemporal, 0.4));
    for (int step = 0; step < 8; ++step) {
        Eye eye = viewAtelier(kSizePx).eye;
        const double scale = std::array{1.0, 0.85, 1.15}.at(static_cast<std::size_t>(step % 3)),
                     zoom = step % 2 == 0 ? 1.0 : 1.04;
        const Intrinsics k = eye.intrinsics;
        const double pixels = std::floor(eye.size_px.x * scale) / eye.size_px.x;
        eye.size_px = glm::uvec2(glm::dvec2(eye.size_px) * scale);
        eye.intrinsics = {k.fx * pixels * zoom, k.fy * pixels * zoom, k.cx * pixels, k.cy * pixels};
        const FrameResult result = walk.go(step, eye);
        if (step > 0) { CHECK(result.work_rendered < 0.45); }
        if (step >= 4) { CHECK(walk.psnr() > 34.0); }
    }
}

TEST_CASE_FIXTURE(Gpu, "alternate renders one eye in full, in turn, and the other from its last picture") {
    HistoryWalk walk(*this, viewAtelier(kSizePx), makeSettings(Mode::kAlternate));
    walk.go(0.0);
    for (std::size_t frame = 1; frame <= 6; ++frame) {
        walk.go(static_cast<double>(frame));
        const std::size_t in_full = frame % 2, other = 1 - in_full;
        const auto shown = walk.shown(), full = walk.full();
        // The splats are in the eye's own order, so a few bits may differ.
        CHECK(compare(shown[in_full], full[in_full]).psnrDb() > 70.0);
        CHECK(compare(shown[other], full[other]).psnrDb() == between(35.0, 70.0));
    }
}

TEST_CASE_FIXTURE(Gpu, "with coarse tiles, both eyes are as alone without a history") {
    for (const Mode mode : {Mode::kPredicted, Mode::kAlternate, Mode::kTemporal}) {
        CAPTURE(nameOf(mode));
        HistoryWalk walk(*this, viewWide(kSizePx), withCoarse(mode));
        const FrameResult result = walk.go(0.0);
        CHECK(countOf(result, "tiles_coarse") > 50);
        const auto shown = walk.shown(), alone = seenAlone(walk);
        CHECK(shown[kLeft].values == alone[kLeft].values);
        // in the left eye's order, which may differ by rounding
        CHECK(compare(shown[kRight], alone[kRight]).psnrDb() > 80.0);
        CHECK(walk.psnr() > 40.0);
        CHECK(leavesOutReprojection(result));
    }
}

}  // SUITE(history_frames)
