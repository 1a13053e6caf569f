// Moving scenes on the device: the frame of a time, what lies between two, and late or broken ones.
#include "engine/stream/moving_scene.h"

#include "tests/engine/files/ply_files.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/stream/moving_frames.h"

SUITE(moving_scene) {

constexpr int kFrames = 6;
constexpr double kRate = 10.0;

std::array<Eye, 2> atelierEyes(glm::uvec2 size_px = {160, 160}, double aside = 0.0) {
    Eye middle = eyeOf(*builtinView("atelier"), size_px);
    middle.world_from_camera.position.x += aside;
    return stereoPair(middle, 0.063);
}

Image pictureOf(StereoFrame& frame) {
    frame.render(atelierEyes(), makeSettings(Mode::kShared));
    return frame.readPicture(kLeft);
}

Image pictureOf(const Context& context, const Scene& scene) {
    KeptFrame frame(context, scene);
    return pictureOf(frame);
}

// Halfway through a scene frame.
double timeOf(double frame) { return (frame + 0.5) / kRate; }

void settleAt(MovingScene& moving, double time_s) {
    moving.setTime(time_s);
    moving.settle({});
}

// Until the scene for this time is shown, or as much of it as there is.
template <typename Is>
void updateUntil(MovingScene& scene, const Is& is) {
    do {
        scene.update({}, 0.0);
        std::this_thread::yield();
    } while (!is());
}

// The worst frame after the first eight, seen from this far behind the view, with four display frames for
// each scene frame.
double worstFromHistories(MovingScene& moving, double back_m, int frames) {
    KeptFrame temporal(Gpu::shared(), moving.scene()), full(Gpu::shared(), moving.scene());
    std::array<Eye, 2> eyes = atelierEyes();
    for (Eye& eye : eyes) { eye.world_from_camera.position.z -= back_m; }
    double worst_db = 1000.0;
    for (int step = 0; step < frames; ++step) {
        settleAt(moving, static_cast<double>(step) / (4.0 * kRate));
        temporal.render(eyes, makeSettings(Mode::kTemporal));
        if (step < 8) { continue; }
        full.render(eyes, makeSettings(Mode::kShared));
        worst_db = std::min(worst_db, psnrDb(picturesOf(temporal), picturesOf(full)));
    }
    return worst_db;
}

struct Sliding : Gpu {
    Sliding() { writeSliding(folder.file("slide"), kFrames); }
    [[nodiscard]] std::unique_ptr<MovingScene> open(MovingSettings settings = {}) const {
        settings.rate_hz = kRate;
        return std::make_unique<MovingScene>(context(), SceneSeries(folder.file("slide")),
                                             std::move(settings));
    }
    [[nodiscard]] std::string fileOf(int frame) const {
        return folder.file(fmt::format("slide/frame_{:04}.ply", frame + 1));
    }
    // To the bit.
    void checkShows(StereoFrame& frame, int file) const {
        CHECK(pictureOf(frame).values == pictureOf(context(), loadScene(fileOf(file))).values);
    }

    Folder folder;
};

TEST_CASE_FIXTURE(Sliding, "each frame of a moving scene is its file, to the bit, round and round") {
    const auto moving = open();
    CHECK(moving->seconds() == doctest::Approx(kFrames / kRate));
    KeptFrame frame(context(), moving->scene());
    for (const int at : {0, 3, 2, 5, 6, 13, -1}) {
        CAPTURE(at);
        settleAt(*moving, timeOf(at));
        CHECK(moving->frameAt(timeOf(at)) == static_cast<std::size_t>((at + kFrames) % kFrames));
        checkShows(frame, (at + kFrames) % kFrames);
    }
    CHECK(moving->isSettled());
    CHECK(these(moving->counters().scene_frames_late, moving->counters().splats_read,
                moving->takeLines(Waits::kBriefly).empty()) == these(0, 8000, true));
}

TEST_CASE_FIXTURE(Sliding, "between two frames there is what lies between their splats, if asked for") {
    const auto moving = open({.blend = true});
    KeptFrame frame(context(), moving->scene());
    settleAt(*moving, 2.25 / kRate);
    const Image between = pictureOf(frame), wanted = pictureOf(context(), slidingAtelier(2.25));
    CHECK(compare(between, wanted).psnrDb() > 60.0);
    CHECK(compare(between, pictureOf(context(), slidingAtelier(2.0))).psnrDb() < 50.0);
    settleAt(*moving, (kFrames - 0.5) / kRate);  // files may end differently from how they began
    checkShows(frame, kFrames - 1);
}

TEST_CASE_FIXTURE(Sliding, "frames go on while the next is read, which is late at most once") {
    for (const bool blend : {false, true}) {
        CAPTURE(blend);
        const auto moving = open({.blend = blend});
        KeptFrame frame(context(), moving->scene());
        for (const double at : {0.5, 1.5, 2.5, 4.5, 7.5}) {
            const int shown = static_cast<int>(at) % kFrames;
            moving->setTime(at / kRate);
            CHECK(moving->frameAt(at / kRate) == static_cast<std::size_t>(shown));
            updateUntil(*moving, [&] { return (pictureOf(frame), moving->isSettled()); });
            const Image expected = pictureOf(context(), slidingAtelier(blend ? shown + 0.5 : shown));
            CHECK(compare(pictureOf(frame), expected).psnrDb() > 60.0);
        }
        CHECK(moving->counters().frames_waited_for_loading == 0);
        CHECK(moving->counters().scene_frames_late <= 4);
    }
}

TEST_CASE_FIXTURE(Sliding, "a frame that is not there in time is late once, and shown when it comes") {
    std::atomic<bool> holds = false;
    MovingSettings settings;
    settings.memory_bytes = 1;  // only the next ones
    settings.draw_as = [&](Scene&, LoadNotes&) { holds.wait(true); };
    const auto moving = open(std::move(settings));
    KeptFrame frame(context(), moving->scene());
    moving->setTime(timeOf(0));
    updateUntil(*moving, [&] { return (pictureOf(frame), moving->isSettled()); });
    const Image first = pictureOf(frame);
    holds = true;
    for (int i = 0; i < 5; ++i) {
        moving->setTime(timeOf(5));
        moving->update({}, 0.0);
        CHECK(pictureOf(frame).values == first.values);
    }
    CHECK(moving->counters().scene_frames_late == 1);
    holds = false;
    holds.notify_all();
    updateUntil(*moving, [&] { return pictureOf(frame).values != first.values; });
    checkShows(frame, 5);
    CHECK(moving->counters().scene_frames_late == 1);
}

TEST_CASE_FIXTURE(Sliding, "in place of a broken frame the one before stays, and one line says so") {
    std::ofstream(fileOf(2), std::ios::binary | std::ios::trunc) << "ply\nbroken";
    const auto moving = open();
    KeptFrame frame(context(), moving->scene());
    std::vector<std::string> lines;
    for (int at = 0; at < 4; ++at) {
        moving->setTime(timeOf(at));
        updateUntil(*moving, [&] {
            pictureOf(frame);
            for (std::string& line : moving->takeLines(Waits::kNever)) { lines.push_back(std::move(line)); }
            return at == 2 ? !moving->isSettled() && !lines.empty() : moving->isSettled();
        });
        checkShows(frame, at == 2 ? 1 : at);
    }
    CHECK(lines.size() == 1);
    CHECK_THROWS_AS(settleAt(*moving, timeOf(2)), Error);
    settleAt(*moving, timeOf(4));
    checkShows(frame, 4);
}

TEST_CASE_FIXTURE(Sliding, "frames may have more splats or fewer, as far as the sizes of files let expect") {
    writePly(slidingAtelier(2, 12'000), fileOf(2));
    writePly(slidingAtelier(3, 1'000), fileOf(3));
    const auto moving = open({.memory_bytes = 1});
    KeptFrame frame(context(), moving->scene());
    for (const int at : {0, 2, 3, 0, 3, 2, 0}) {
        CAPTURE(at);
        settleAt(*moving, timeOf(at));
        CHECK(moving->counters().splats_resident == loadScene(fileOf(at)).size());
        checkShows(frame, at);
    }
    // A file that has grown since its size was read.
    writePly(slidingAtelier(4, 60'000), fileOf(4));
    CHECK_THROWS_WITH_AS(settleAt(*moving, timeOf(4)), doctest::Contains("there is room for"), Error);
}

TEST_CASE_FIXTURE(Sliding, "pictures that are made from their histories show what moves") {
    CHECK(worstFromHistories(*open(), 0.0, 16) > 27.0);
}

TEST_CASE_FIXTURE(Sliding, "for longer, too, and where it is a part of the picture" * nightly()) {
    for (const double back_m : {1.2, 0.0}) { CHECK(worstFromHistories(*open(), back_m, 30) > 27.0); }
}

TEST_CASE_FIXTURE(Sliding, "what stays equal costs pictures that are made from their histories nothing") {
    for (int at = 1; at < kFrames; ++at) { writePly(slidingAtelier(0), fileOf(at)); }
    const auto still = open();
    KeptFrame frame(context(), still->scene());
    pictureOf(frame);
    const std::uint64_t before = still->scene().changesRecorded();
    for (int at = 1; at < kFrames; ++at) {
        settleAt(*still, timeOf(at));
        CHECK(still->isSettled());
        pictureOf(frame);
    }
    CHECK(still->scene().changesRecorded() == before);
}

// A film of which no more than the next frames are in memory, and two frames of it.
struct Film : Gpu {
    void open(int frames, const std::function<Scene(int frame)>& frameAt) {
        writeFilm(folder.file("film"), frames, frameAt);
        scene.emplace(context(), SceneSeries(folder.file("film")),
                      MovingSettings{.rate_hz = kRate, .memory_bytes = 1});
        frame.emplace(context(), scene->scene());
        other.emplace(context(), scene->scene());
    }
    void checkNotCutShort() { CHECK(frame->finish().value().counters.ahead.value().frames_cut_short == 0); }

    static constexpr glm::uvec2 kSize{192, 144};
    const Folder folder;
    std::optional<MovingScene> scene;
    std::optional<KeptFrame> frame, other;
    const FrameSettings temporal = makeSettings(Mode::kTemporal), full = makeSettings(Mode::kShared);
};

TEST_CASE_FIXTURE(Film, "where most of a picture changes, it is rendered in full, and then has a history") {
    open(3, [](int at) { return shakenAtelier(at, 2); });
    for (const double at : {0.0, 0.2, 1.0, 2.0, 2.2, 2.4}) {
        CAPTURE(at);
        settleAt(*scene, timeOf(at));
        const std::array<Eye, 2> eyes = atelierEyes(kSize, 0.01 * at);
        const FrameResult result = frame->render(eyes, temporal), whole = other->render(eyes, full);
        const bool is_full = at == 0.0 || at == 2.0;
        for (const int e : {kLeft, kRight}) {
            CHECK((frame->readPicture(e).values == other->readPicture(e).values) == is_full);
        }
        CHECK((countOf(result, "tile_pairs_left") == countOf(whole, "tile_pairs_left")) == is_full);
    }
}

TEST_CASE_FIXTURE(Film, "frames under way have room for what changes, with a history or without") {
    open(9, [](int at) { return shakenAtelier(at, 5); });
    for (int step = 0; step < 16; ++step) {
        // A different scene frame every second display frame, and in three in a row.
        const int at = step < 8 ? step / 2 : step - 4;
        settleAt(*scene, timeOf(std::min(at, 8)));
        frame->renderAhead(atelierEyes(kSize, 0.004 * step), temporal);
        other->render(atelierEyes(kSize, 0.004 * step), temporal);
    }
    checkNotCutShort();
    CHECK(shownBy(*frame) == shownBy(*other));
}

TEST_CASE_FIXTURE(Film, "a frame that changes make a full one waits for room, however much it needs") {
    open(3, [](int at) {
        Scene made = shakenAtelier(0, 2);
        for (glm::vec2& scale : made.scales) { scale *= at == 2 ? 4.0f : 1.0f; }
        return made;
    });
    for (int step = 0; step < 8; ++step) {
        settleAt(*scene, timeOf(step < 6 ? 0.25 * step : 2.0));
        frame->renderAhead(atelierEyes(kSize), temporal);
    }
    checkNotCutShort();
    other->render(atelierEyes(kSize), full);
    CHECK(compare(frame->readPicture(kLeft), other->readPicture(kLeft), 3).psnrDb() > 40.0);
}

}  // SUITE(moving_scene)
