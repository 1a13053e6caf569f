// Facts about the memory of frames that are not waited for, and of a device that has no more.
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
        KeptFrame frame(context(), scene, kNoRoom), waited(context(), scene);
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
        waited.render(eyesAt(view.eye, 0), makeSettings(mode));
        CHECK(shownBy(frame) == renderPair(waited, eyesAt(view.eye, 0), makeSettings(mode)));
    }
}

TEST_CASE_FIXTURE(Atelier, "where a jump may be seen, no frame is waited for, and a whole one comes soon") {
    const auto there = eyesAt(view.eye, 0), before = eyesAt(turned(view.eye, 0.5), 0),
               nowhere = eyesAt(awayFrom(view.eye), 0);
    for (const Mode mode : {Mode::kShared, Mode::kTemporal}) {
        for (const bool has_room : {true, false}) {
            INFO(nameOf(mode), ", has_room ", has_room);
            KeptFrame frame(context(), scene, kNoRoom), waited(context(), scene);
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
            CHECK(shownBy(frame) == renderPair(waited, there, settings));
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
    std::uint64_t with_few = 0;  // bytes
    // With `spare`, no more memory is left than that once the first lists are there.
    const auto goOn = [&](StereoFrame& frame, const Context& on, std::optional<std::uint64_t> spare) {
        goAhead(frame, less, settings, 1);
        with_few = on.memoryUse().current_bytes;
        const Buffer filler(on, "filler", spare ? on.memoryLimitBytes() - with_few - *spare : 0);
        FrameResult last{};
        for (int round = 0; round < 6; ++round) {
            last = goAhead(frame, all, settings, 3);
            frame.finish();
        }
        return countOf(last, "frames_done_again");
    };
    const Context plenty;
    const GpuScene on_plenty(plenty, view.scene);
    StereoFrame with_plenty(plenty, on_plenty, kNoRoom);
    CHECK(goOn(with_plenty, plenty, std::nullopt) == 1);  // the first one
    const std::uint64_t with_all = plenty.memoryUse().current_bytes, more = with_all - with_few;
    const Context small({.device = {}, .memory_limit_bytes = with_all + (64 << 20)});
    const GpuScene on_small(small, view.scene);
    const PairOfValues whole = shownBy(with_plenty);
    // Somewhere between too little for any, and enough for old and new ones at a time.
    std::size_t waited = 0;
    for (int tenths = 1; tenths <= 12; ++tenths) {
        StereoFrame frame(small, on_small, kNoRoom);
        waited +=
            goOn(frame, small, more * static_cast<std::uint64_t>(tenths) / 10) > 1 && shownBy(frame) == whole;
    }
    CHECK(waited > 0);
}

TEST_CASE_FIXTURE(Atelier, "a frame that finds no room without a jump is counted, and the next is whole") {
    // Nothing moves but a wall of splats that comes through the near plane.
    const auto eyes = eyesAt(view.eye, 0);
    KeptFrame frame(context(), scene, kNoRoom), waited(context(), scene);
    goAhead(frame, eyes, blind(), 3);
    const FrameResult last = goAhead(frame, eyes, seeing(), 4);
    CHECK(countOf(last, "frames_cut_short") > 0);
    CHECK(countOf(last, "frames_done_again") > 0);
    CHECK(shownBy(frame) == renderPair(waited, eyes, seeing()));
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
    CHECK(shownBy(frame) == renderPair(roomy, eyesAt(splat.eye, 3), seeing()));
    CHECK(tight.validationMessages().empty());
}

TEST_CASE_FIXTURE(Atelier, "pictures that do not fit are refused before a frame is begun") {
    const Context tight({.device = {}, .validation = kValidation, .memory_limit_bytes = 64u << 20});
    const GpuScene held(tight, view.scene);
    StereoFrame frame(tight, held);
    const FrameSettings settings = makeSettings(Mode::kPredicted);
    const std::array<Eye, 2> fits = eyesAt(view.eye, 0), large = eyesAt(ofSize(view.eye, {4096, 4096}), 0);
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
