// Facts about the memory of frames that are not waited for: lists that are too short, sizes that change, and
// what happens where the device has no more.
#include "tests/engine/frame/frames_ahead.h"

SUITE(frame_memory) {

using namespace test::ahead;

TEST_CASE_FIXTURE(Atelier, "with memory for the largest size, frames of other sizes wait for nothing") {
    const glm::uvec2 most_px(96, 96), least_px(32, 32);
    const auto eyesOf = [&](glm::uvec2 size_px) { return eyesAt(ofSize(view.eye, size_px), 0); };
    for (const Mode mode :
         {Mode::kTwoPass, Mode::kShared, Mode::kPredicted, Mode::kAlternate, Mode::kTemporal}) {
        CAPTURE(nameOf(mode));
        KeptFrame frame(context(), scene, kNoRoom);
        FrameSettings settings = makeSettings(mode);
        settings.waits_for_lists = false;
        settings.most_px = most_px;
        goAhead(frame, eyesOf(most_px), settings, 2);
        const std::uint64_t bytes = context().memoryUse().current_bytes;
        settings.mark = 1;
        for (const glm::uvec2 size_px :
             {glm::uvec2(64, 80), least_px, most_px, least_px, glm::uvec2(81, 50), most_px}) {
            CAPTURE(size_px.x);
            for (int i = 0; i < 2; ++i) {
                const auto result = frame.renderAhead(eyesOf(size_px), settings);
                CHECK((!result || result->mark < settings.mark));
                ++settings.mark;
            }
            CHECK(context().memoryUse().current_bytes == bytes);
        }
        CHECK(countOf(*frame.finish(), "frames_cut_short") == 0);

        KeptFrame grows(context(), scene, kNoRoom);
        goAhead(grows, eyesOf(least_px), settings, 3);
        CHECK_FALSE(grows.growFor(most_px));
        while (!grows.growFor(most_px)) {
            goAhead(grows, eyesOf(least_px), settings, 1);
            std::this_thread::yield();
        }
        goAhead(grows, eyesOf(most_px), settings, 4);
        CHECK(countOf(*grows.finish(), "frames_cut_short") == 0);
    }
}

TEST_CASE_FIXTURE(Atelier, "after a jump a frame is waited for, and done again once at most, unseen") {
    for (const Mode mode :
         {Mode::kTwoPass, Mode::kShared, Mode::kReproject, Mode::kPaper, Mode::kPredicted}) {
        CAPTURE(nameOf(mode));
        KeptFrame frame(context(), scene, kNoRoom);
        const auto waited = StereoFrame::beside(frame);
        std::uint64_t mark = 0, before = 0;
        // The first frame, a jump to where there is nothing, and one back.
        for (const Eye& eye : {view.eye, awayFrom(view.eye), view.eye}) {
            const auto eyes = eyesAt(eye, 0);
            const auto first = frame.renderAhead(eyes, makeSettings(mode, kLeft, ++mark));
            REQUIRE(first.has_value());
            CHECK(first->mark == mark);
            CHECK(countOf(*first, "frames_done_again") <= before + 1);
            if (mark == 1) { CHECK(countOf(*first, "frames_done_again") == 1); }
            // Nor is any later frame cut short.
            const FrameResult last = goAhead(frame, eyes, makeSettings(mode, kLeft, mark), 3);
            CHECK(countOf(last, "frames_done_again") <= before + 2);
            CHECK(countOf(last, "frames_cut_short") == countOf(*first, "frames_cut_short"));
            before = countOf(last, "frames_done_again");
        }
        for (int step = 0; step < 2; ++step) { waited->render(eyesAt(view.eye, 0), makeSettings(mode)); }
        CHECK(shownBy(frame) == shownBy(*waited));
    }
}

TEST_CASE_FIXTURE(Atelier, "where a jump may be seen, no frame is waited for, and a whole one comes soon") {
    const auto there = eyesAt(view.eye, 0), before = eyesAt(turned(view.eye, 0.5), 0),
               nowhere = eyesAt(awayFrom(view.eye), 0);
    for (const Mode mode : {Mode::kShared, Mode::kTemporal}) {
        for (const bool has_room : {true, false}) {
            CAPTURE(nameOf(mode));
            CAPTURE(has_room);
            KeptFrame frame(context(), scene, kNoRoom);
            const auto waited = StereoFrame::beside(frame);
            FrameSettings settings = makeSettings(mode);
            settings.waits_for_lists = false;
            if (has_room) { frame.renderAhead(there, settings); }
            goAhead(frame, has_room ? before : nowhere, settings, 3);
            settings.mark = 1;
            const std::optional<FrameResult> told = frame.renderAhead(there, settings);
            CHECK_FALSE((told && told->mark == 1));
            FrameResult last{};
            if (has_room) {
                last = frame.finish().value();
            } else {
                // How long one list must be is known once another one is long enough. What finish() waits
                // for, frames do not.
                for (int round = 0; round < 4; ++round) {
                    last = goAhead(frame, there, settings, 3);
                    frame.finish();
                }
            }
            CHECK((countOf(last, "frames_cut_short") > 0) == !has_room);
            CHECK(countOf(last, "frames_done_again") == 1);  // the first one
            waited->render(there, settings);
            CHECK(shownBy(frame) == shownBy(*waited));
        }
    }
}

TEST_CASE_FIXTURE(Atelier, "lists that fill up grow beside the frames, before one of these is cut short") {
    KeptFrame frame(context(), scene, kNoRoom);
    FrameSettings settings = seeing();
    settings.waits_for_lists = false;
    const Eye aside = turned(view.eye, 0.9);
    std::uint64_t mark = 0, bytes = 0;
    FrameResult last{};
    for (int step = 0; step < 48; ++step) {
        settings.mark = ++mark;
        const auto told = frame.renderAhead(eyesAt(aside, -step), settings);
        if (mark == 1) { bytes = context().memoryUse().current_bytes; }
        // The first one is waited for, and no other; nothing is on the way after finish().
        const bool tells_nothing = mark < 4 || step % 4 < 2;
        CHECK((told ? told->mark : 0) == (mark == 1 ? 1 : tells_nothing ? 0 : mark - 2));
        if (step % 4 == 3) { last = frame.finish().value(); }
    }
    CHECK(countOf(last, "frames_cut_short") == 0);
    CHECK(context().memoryUse().current_bytes > bytes);
}

TEST_CASE_FIXTURE(Atelier, "where longer lists do not fit beside the old ones, the frame is waited for") {
    const auto all = eyesAt(view.eye, 0);
    std::array<Eye, 2> less = all;
    KeptFrame counting(context(), scene);
    const auto pairsOf = [&](const std::array<Eye, 2>& eyes) {
        return static_cast<double>(countOf(counting.render(eyes, seeing()), "tile_pairs_left"));
    };
    const double most = pairsOf(all);
    for (double turn = 0.1; 1.8 * pairsOf(less) > most; turn += 0.1) {
        less = stereoPair(turned(view.eye, turn), 0.063);
    }
    FrameSettings settings = seeing();
    settings.waits_for_lists = false;
    struct Bytes {
        std::uint64_t without_lists, with_few, with_all;
    };
    // With `spare`, no more memory is left than that once the first lists are there.
    const auto goOn = [&](StereoFrame& frame, const Context& on, std::optional<std::uint64_t> spare,
                          FrameResult& last) {
        const auto bytes = [&] { return on.memoryUse().current_bytes.load(); };
        Bytes found{};
        frame.reserve(less, settings);
        found.without_lists = bytes();
        goAhead(frame, less, settings, 1);
        found.with_few = bytes();
        const Buffer filler(on, "filler", spare ? on.memoryLimitBytes() - found.with_few - *spare : 0);
        for (int round = 0; round < 6; ++round) {
            last = goAhead(frame, all, settings, 3);
            frame.finish();
        }
        found.with_all = bytes();
        return found;
    };
    const Context plenty;
    const GpuScene on_plenty(plenty, view.scene);
    StereoFrame with_plenty(plenty, on_plenty, kNoRoom);
    FrameResult last{};
    const Bytes bytes = goOn(with_plenty, plenty, std::nullopt, last);
    CHECK(countOf(last, "frames_done_again") == 1);  // the first one
    ContextOptions limited;
    limited.memory_limit_bytes = bytes.with_all + (64 << 20);
    const Context small(limited);
    const GpuScene on_small(small, view.scene);
    const PairOfValues whole = shownBy(with_plenty);
    // Somewhere between too little for any, and enough for old and new ones at a time.
    std::size_t waited = 0;
    for (int tenths = 1; tenths <= 12; ++tenths) {
        StereoFrame frame(small, on_small, kNoRoom);
        goOn(frame, small, (bytes.with_all - bytes.with_few) * static_cast<std::uint64_t>(tenths) / 10, last);
        waited += countOf(last, "frames_done_again") > 1 && shownBy(frame) == whole;
    }
    CHECK(waited > 0);
}

TEST_CASE_FIXTURE(Atelier, "a frame that finds no room without a jump is counted, and the next is whole") {
    // Nothing moves but a wall of splats that comes through the near plane.
    const auto eyes = eyesAt(view.eye, 0);
    KeptFrame frame(context(), scene, kNoRoom);
    const auto waited = StereoFrame::beside(frame);
    goAhead(frame, eyes, blind(), 3);
    const FrameResult last = goAhead(frame, eyes, seeing(), 4);
    CHECK(countOf(last, "frames_cut_short") > 0);
    CHECK(countOf(last, "frames_done_again") > 0);
    waited->render(eyes, seeing());
    CHECK(shownBy(frame) == shownBy(*waited));
}

TEST_CASE_FIXTURE(Atelier, "lists that the device has no memory for cost the picture, not the session") {
    const auto eyes = eyesAt(view.eye, 0);
    const std::uint64_t before = context().memoryUse().current_bytes;
    KeptFrame roomy(context(), view.scene, kNoRoom);
    roomy.render(eyes, blind());
    const std::uint64_t least = context().memoryUse().current_bytes - before;
    roomy.render(eyes, seeing());
    const std::uint64_t most = context().memoryUse().current_bytes - before;

    const Context tight({.device = {}, .validation = kValidation, .memory_limit_bytes = (least + most) / 2});
    const GpuScene held(tight, view.scene);
    StereoFrame frame(tight, held, kNoRoom);
    goAhead(frame, eyes, blind(), 3);
    FrameResult last = goAhead(frame, eyes, seeing(), 4);
    const std::uint64_t cut_short = countOf(last, "frames_cut_short");
    CHECK(cut_short > 0);
    CHECK(countOf(last, "tile_pairs_left") == 0);
    // Once everything fits, it is shown again.
    // Two were in flight.
    CHECK(countOf(goAhead(frame, eyes, blind(), 4), "frames_cut_short") <= cut_short + 2);
    // Another scene, which fits, starts afresh in the same frame object.
    const ViewedScene splat = viewBuiltin("builtin:one-splat", {96, 96});
    const GpuScene splat_scene(tight, splat.scene), roomy_splat(context(), splat.scene);
    frame.show(splat_scene);
    last = goAhead(frame, eyesAt(splat.eye, 3), seeing(), 4);
    frame.finish();
    CHECK(countOf(last, "frames_cut_short") == 0);
    roomy.show(roomy_splat);
    roomy.render(eyesAt(splat.eye, 3), seeing());
    CHECK(shownBy(frame) == shownBy(roomy));
    CHECK(tight.validationMessages().empty());
}

TEST_CASE_FIXTURE(Atelier, "pictures that do not fit are refused before a frame is begun") {
    const Context tight({.device = {}, .validation = kValidation, .memory_limit_bytes = 64u << 20});
    const GpuScene held(tight, view.scene);
    StereoFrame frame(tight, held);
    const FrameSettings settings = makeSettings(Mode::kPredicted);
    const std::array<Eye, 2> fits = eyesAt(view.eye, 0);
    std::array<Eye, 2> large = fits;
    for (Eye& eye : large) { eye.size_px = {4096, 4096}; }
    const auto show = [&] {
        for (int step = 0; step < 3; ++step) {
            frame.reserve(fits, settings);
            frame.renderAhead(fits, settings);
        }
        frame.finish();
        return shownBy(frame);
    };
    const PairOfValues before = show();
    for (int time = 0; time < 2; ++time) { CHECK_THROWS_AS(frame.reserve(large, settings), Error); }
    CHECK(show() == before);
    CHECK(tight.validationMessages().empty());
}

}  // SUITE(frame_memory)
