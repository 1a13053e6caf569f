// Facts about showing one scene after another: a dropped or chosen scene replaces the one that is shown, or a
// line says why not. Also about remembered places.
#include "app/view/scenes/shown_scene.h"
#include "app/options/modes.h"
#include "app/view/scenes/viewpoint_list.h"
#include "app/view/settings/view_files.h"
#include "engine/builtin/procedural.h"
#include "engine/files/load_scene.h"
#include "engine/files/ply.h"
#include "tests/engine/gpu/gpu_fixture.h"
#include "tests/run_program.h"

#include <sys/stat.h>

SUITE(shown_scene) {

struct Shown : Gpu, Home {
    using Home::run, Home::write;

    Shown() { options.scene = "builtin:step-edge"; }

    void show(ShownScene& scenes, const std::string& place) {
        scenes.begin(place);
        REQUIRE(scenes.take(state).empty());
    }

    ViewOptions options;
    ViewState state;
    FrameLog log;
};

bool same(const Similarity& a, const Similarity& b) {
    return glm::length(a.position - b.position) < 1e-6 && std::abs(a.scale - b.scale) < 1e-6 &&
           std::abs(std::abs(glm::dot(a.orientation, b.orientation)) - 1.0) < 1e-6;
}

TEST_CASE_FIXTURE(Shown, "a file that is no scene gives one line, and what was shown stays") {
    ShownScene scenes(context(), options, log);
    REQUIRE(scenes.take(state).empty());
    CHECK(scenes.name() == "builtin:step-edge");
    const LoadedScene* const before = scenes.get();
    write("notes.txt", "no scene");
    fs::create_directory(path / "pictures");
    REQUIRE(mkfifo((path / "pipe.ply").c_str(), 0600) == 0);
    for (const auto& [name, part] :
         {std::pair("notes.txt", "not a scene file of a known format"),
          std::pair("pictures", "is a directory, expected one with"),
          std::pair("pipe.ply", "is not a regular file"), std::pair("gone.ply", "no such file")}) {
        scenes.begin(at(name));
        const std::string complaint = scenes.take(state);
        CHECK(complaint.starts_with(at(name) + ": "));
        CHECK_MESSAGE(contains(complaint, part), complaint);
        CHECK(these(contains(complaint, "\n"), scenes.get() == before) == these(false, true));
    }
    CHECK_FALSE(scenes.loading().has_value());
}

TEST_CASE_FIXTURE(Shown, "the last scene asked for comes; if it cannot be read, the one before does") {
    ShownScene scenes(context(), options, log);
    scenes.begin("builtin:fence");
    scenes.begin("builtin:slanted-wall");
    CHECK(scenes.take(state).empty());
    CHECK(scenes.name() == "builtin:slanted-wall");
    CHECK_FALSE(scenes.loading().has_value());
    ShownScene others(context(), options, log);
    others.begin(at("gone.ply"));
    CHECK(contains(others.take(state), "gone.ply: no such file"));
    CHECK(others.get() == nullptr);
    CHECK(others.take(state).empty());
    CHECK(others.name() == "builtin:step-edge");
    // The scene of the command line has nothing to fall back to.
    options.scene = at("gone.ply");
    ShownScene none(context(), options, log);
    CHECK_THROWS_AS(static_cast<void>(none.take(state)), Error);
}

TEST_CASE_FIXTURE(Shown, "a place belongs to its scene: others start at their own or saved one") {
    const auto startOf = [&](const std::string& scene, const ViewOptions& given) {
        ShownScene scenes(context(), given, log);
        show(scenes, scene);
        return state.sceneFromRoom();
    };
    const Similarity own = startOf("builtin:step-edge", options), other = startOf("builtin:fence", options);
    options.run.camera.eye = glm::dvec3(0.0, -0.5, -3.0);
    options.run.camera.up = glm::dvec3(0.0, 0.0, 1.0);
    ShownScene scenes(context(), options, log);
    REQUIRE(scenes.take(state).empty());
    const Similarity given = state.sceneFromRoom();
    CHECK_FALSE(same(given, own));
    CHECK(same(startOf("builtin:fence", options), other));
    ViewSettings moved = state.withPlacement();
    moved.scene_from_room->position += glm::dvec3(1.0, 2.0, 3.0);
    moved.metres_per_unit = 0.25;
    CHECK_FALSE(scenes.get()->measured.has_value());
    for (const char* scene : {"builtin:fence", "builtin:step-edge"}) { (void)saveViewSettings(scene, moved); }
    CHECK(same(startOf("builtin:fence", options), *moved.scene_from_room));
    show(scenes, "builtin:fence");
    CHECK(scenes.get()->measured == 0.25);
    CHECK(same(startOf("builtin:step-edge", options), given));
}

TEST_CASE_FIXTURE(Shown, "a remembered place of no use is one line, and saving mends the file") {
    const fs::path file = viewSettingsFile(options.scene);
    // What it complains of, and whether the wearer is at the scene's start.
    const auto showAgain = [&] {
        ShownScene scenes(context(), options, log);
        const std::string complaint = scenes.take(state);
        return std::pair(complaint, same(state.sceneFromRoom(), scenes.get()->start));
    };
    CHECK(showAgain() == std::pair(std::string(), true));
    ViewSettings moved = state.withPlacement();
    moved.scene_from_room->position += glm::dvec3(1.0, 2.0, 3.0);
    const auto spoil = [&](const std::string& text) {
        fs::remove_all(file);
        fs::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    };
    const auto checkSaid = [&] {
        const auto [complaint, at_start] = showAgain();
        CHECK(these(at_start, contains(complaint, "\n")) == these(true, false));
        CHECK_MESSAGE(contains(complaint, file.string()), complaint);
    };
    for (const std::string& text : {std::string("[view\n"), std::string("[view]\nunits-per-metre = 2\n"),
                                    std::string("\xff\xfe\0\0", 4)}) {
        CAPTURE(text);
        spoil(text);
        checkSaid();
        // The next save repairs it.
        CHECK(saveViewSettings(options.scene, moved) == "saved as " + file.string());
        CHECK(showAgain() == std::pair(std::string(), false));
    }
    // Anything but a regular file stays, even when settings are saved, and nothing waits for a pipe.
    fs::remove(file);
    fs::create_directory(file);
    checkSaid();
    CHECK(contains(saveViewSettings(options.scene, moved), "is a directory"));
    CHECK(fs::is_directory(file));
    fs::remove(file);
    REQUIRE(mkfifo(file.c_str(), 0600) == 0);
    checkSaid();
    CHECK(fs::is_fifo(file));
    // No half-written file is left.
    CHECK(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()) == 1);
}

TEST_CASE_FIXTURE(Shown, "loading, and the way to the device, give up where they are told to") {
    struct Enough {};
    go("scene atelier --splats 200000 --out many.ply");
    go("convert many.ply many.spz");
    for (const char* name : {"many.ply", "many.spz"}) {
        CAPTURE(name);
        double furthest = 0.0;
        const auto stop = [&](double share) {
            furthest = std::max(furthest, share);
            if (share > 0.0) { throw Enough(); }
        };
        CHECK_THROWS_AS(static_cast<void>(loadScene((path / name).string(), 0, nullptr, stop)), Enough);
        CHECK(furthest < 0.6);
    }
    const Scene scene = loadScene(at("many.ply"));
    const auto stop = [](double share) {
        CHECK(share < 0.6);
        throw Enough();
    };
    CHECK_THROWS_AS(GpuScene(context(), scene, stop), Enough);
}

TEST_CASE_FIXTURE(Shown, "a loader that was told to give up, in time or not, keeps nothing in memory") {
    const std::uint64_t before = context().memoryUse().current_bytes;
    PassKernels kernels(context());
    SceneLoader early(context(), kernels, "builtin:fence", options.run),
        late(context(), kernels, "builtin:fence", options.run);
    early.cancel();
    while (!late.isDone()) { std::this_thread::yield(); }
    while (!early.isDone()) { std::this_thread::yield(); }
    CHECK(context().memoryUse().current_bytes > before);
    late.cancel();
    CHECK(context().memoryUse().current_bytes == before);
    for (SceneLoader* loader : {&early, &late}) { CHECK(loader->take() == nullptr); }
    // Nor does a scene that was fully loaded when another one was requested.
    ShownScene scenes(context(), options, log);
    while (!scenes.isNextReady()) { std::this_thread::yield(); }
    const std::uint64_t one = context().memoryUse().current_bytes;
    scenes.begin(at("gone.ply"));
    while (!scenes.isNextReady()) { std::this_thread::yield(); }
    CHECK(one > before);
    CHECK(context().memoryUse().current_bytes == before);
}

TEST_CASE_FIXTURE(Shown, "two scenes are compared where their files say, until another is shown") {
    Scene far = loadScene("builtin:one-splat");
    far.origin = {500'000.0, 0.0, -300'000.0};
    writePly(far, at("far.ply"));
    options.compare = at("far.ply");
    ShownScene scenes(context(), options, log);
    REQUIRE(scenes.take(state).empty());
    CHECK(scenes.other() == nullptr);
    REQUIRE(scenes.takeOther().empty());
    CHECK(scenes.names() == "builtin:step-edge | " + options.compare);
    const glm::dvec3 from = scenes.get()->origin, to = scenes.other()->origin;
    CHECK(glm::length(to - from) > 400'000.0);
    const Similarity place{{1, 0, 0, 0}, {1, 2, 3}, 2.0};
    CHECK(scenes.drawnFrom(place).position == place.position);
    CHECK(&scenes.frame() != &scenes.otherFrame());
    scenes.draw(true);
    CHECK(scenes.drawn() == scenes.other());
    CHECK(&scenes.frame() == &scenes.otherFrame());
    CHECK(glm::length(scenes.drawnFrom(place).position + to - (place.position + from)) < 1e-6);
    CHECK(scenes.drawnFrom(place).scale == place.scale);
    // The next one is compared, not shown; that it cannot be read leaves the first one alone.
    CHECK(contains(scenes.toggleComparison(), "no longer compared"));
    CHECK(scenes.drawn() == scenes.get());
    CHECK(contains(scenes.toggleComparison(), "to compare with builtin:step-edge"));
    scenes.begin(at("gone.ply"));
    CHECK(contains(scenes.takeOther(), "no such file"));
    CHECK(scenes.names() == "builtin:step-edge");
    scenes.begin("builtin:fence", "builtin:slanted-wall");
    REQUIRE(scenes.take(state).empty());
    REQUIRE(scenes.takeOther().empty());
    CHECK(scenes.names() == "builtin:fence | builtin:slanted-wall");
    scenes.draw(true);
    show(scenes, "builtin:step-edge");
    CHECK(scenes.names() == "builtin:step-edge");
    CHECK(scenes.drawn() == scenes.get());
}

TEST_CASE_FIXTURE(Shown, "the shown scene makes room for one that does not fit beside it, or comes back") {
    go("scene atelier --splats 20000 --out many.ply");
    go("scene atelier --splats 24000 --out more.ply");
    go("scene atelier --splats 400000 --out most.ply");
    const auto bytesOf = [&](const char* name) {
        const std::uint64_t before = context().memoryUse().current_bytes;
        const GpuScene scene(context(), loadScene((path / name).string()));
        return context().memoryUse().current_bytes - before;
    };
    // Enough for one and a half of them, with their lists.
    ContextOptions limited;
    limited.memory_limit_bytes = bytesOf("many.ply") + bytesOf("more.ply") - bytesOf("many.ply") / 4;
    const Context small(limited);
    options.scene = at("many.ply");
    const std::string more = at("more.ply"), most = at("most.ply");
    ShownScene scenes(small, options, log);
    REQUIRE(scenes.take(state).empty());
    const Similarity moved{{1, 0, 0, 0}, {1, 2, 3}, 2.0};
    state.place(moved);
    scenes.begin(more);
    CHECK(scenes.take(state) ==
          options.scene + " and " + more +
              " do not fit into the device's memory together: the first one is removed first");
    CHECK(scenes.get() == nullptr);
    CHECK(scenes.name() == more);
    CHECK(scenes.take(state).empty());
    REQUIRE(scenes.get() != nullptr);
    CHECK(scenes.name() == more);
    // This one cannot fit at all, so the previous scene comes back.
    scenes.begin(most);
    CHECK(contains(scenes.take(state), " is removed first"));
    CHECK(contains(scenes.take(state), "MiB"));
    CHECK(scenes.get() == nullptr);
    CHECK(scenes.take(state).empty());
    CHECK(scenes.name() == more);
    // And the program still knows where its wearer stood.
    scenes.begin(options.scene);
    static_cast<void>(scenes.take(state));
    REQUIRE(scenes.take(state).empty());
    CHECK(same(state.sceneFromRoom(), moved));
}

TEST_CASE_FIXTURE(Shown, "viewpoints are kept, named, put in order, forgotten, shared, and toured") {
    go("scene one-splat --out one.ply");
    options.scene = at("one.ply");
    ShownScene scenes(context(), options, log);
    REQUIRE(scenes.take(state).empty());
    FileWorker files;
    std::string said;
    ViewpointList list(files, [&](const std::string& words) { said = words; });
    CHECK(list.goBy(1) == nullptr);
    list.show(scenes.get());
    CHECK(list.goBy(1) == nullptr);
    CHECK(contains(said, "no viewpoints"));
    const auto names = [&] {
        files.finish();
        std::string all;
        for (const Viewpoint& viewpoint : keptViewpoints(options.scene)) { all += viewpoint.name + ";"; }
        return all;
    };
    for (const double z : {-1.0, -2.0, -3.0}) {
        list.keep({{0.0, 0.0, z}, {0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}, 60.0});
    }
    CHECK(names() == "your own 1;your own 2;your own 3;");
    list.rename("door");
    for (int i = 0; i < 3; ++i) { list.moveBy(-1); }
    CHECK(names() == "door;your own 1;your own 2;");
    CHECK(list.words() == "viewpoint 1 of 3: door");
    REQUIRE(list.goBy(1) != nullptr);
    list.forget();
    CHECK(names() == "door;your own 2;");
    CHECK_FALSE(list.requireOwn());
    // Shared, then read by somebody who has none of them; reading twice adds nothing.
    list.writeShared();
    files.finish();
    CHECK(said == "2 viewpoints are in " + at("one.viewpoints.json"));
    scenes.get()->viewpoints.clear();
    list.show(scenes.get());
    // finish() drops reading that has not begun; otherwise it writes what was read.
    const auto readAll = [&] {
        while (!files.now().empty()) { std::this_thread::yield(); }
        files.finish();
        files.finish();
    };
    for (const int added : {2, 0}) {
        list.read("");
        readAll();
        CHECK(said == fmt::format("2 viewpoints from {}, {} of them new", at("one.viewpoints.json"), added));
    }
    CHECK(list.count() == 2);
    list.read(at("gone.json"));
    readAll();
    CHECK(contains(said, "gone.json"));
    // The tour pauses at each viewpoint, and ends after the last.
    std::string toured;
    list.toggleTour();
    for (int i = 0; i < 100 && list.isTouring(); ++i) {
        if (const Viewpoint* const next = list.pass(0.25, true)) {
            toured += fmt::format("{} {};", i, next->name);
        }
    }
    CHECK(toured == "0 door;6 your own 2;");
    CHECK(said == "the tour is over");
}

TEST_CASE_FIXTURE(Shown, "another method is drawn once its kernels are there, made beside the frames") {
    ViewSettings settings;
    options.run.stereo.mode = settings.stereo.mode = Mode::kMono;
    const glm::uvec2 size_px(64, 64);
    ShownScene scenes(context(), options, log, FramesAhead{settings.stereo, size_px, false, false});
    // Chosen while the first scene loads.
    settings.stereo.mode = Mode::kShared;
    scenes.expect(settings, size_px, {size_px, true});
    REQUIRE(scenes.take(state).empty());
    CHECK(scenes.drawable(settings) == settings);
    Eye middle{};
    middle.size_px = size_px;
    middle.intrinsics = intrinsicsFromFovX(1.5, size_px);
    const auto eyes = stereoPair(middle, 0.063);
    const auto frameNow = [&] {
        FrameSettings frame = frameSettings(options.run.camera, settings.stereo, kWearersOrder);
        frame.half_floats = true;
        frame.keep_depth = frame.keep_both_depths = false;
        return frame;
    };
    const auto drawsWithoutCompiling = [&] {
        const std::size_t before = scenes.frame().kernelCount();
        scenes.frame().renderAhead(eyes, frameNow());
        scenes.frame().finish();
        return scenes.frame().kernelCount() == before;
    };
    CHECK(drawsWithoutCompiling());
    // Chosen while it is shown: frames go on as before until the others are ready. Sliders apply at once.
    const ViewSettings shared = settings;
    settings.stereo.mode = Mode::kTwoPass;
    scenes.expect(settings, size_px, {size_px, true});
    CHECK(these(scenes.isMakingMethod(), scenes.drawable(settings).stereo) == these(true, shared.stereo));
    const auto waitUntilReady = [&] {
        while (scenes.isMakingMethod()) {
            std::this_thread::yield();
            scenes.expect(settings, size_px, {size_px, true});
            if (scenes.toRemake()) {
                scenes.remakeFrames({{eyes.begin(), eyes.end()}, frameNow(), {}, {}, {}});
            }
        }
    };
    const StereoFrame* const shared_frame = &scenes.frame();
    waitUntilReady();
    CHECK(scenes.drawable(settings) == settings);
    CHECK(&scenes.frame() != shared_frame);
    CHECK_FALSE(scenes.frame().renderAhead(eyes, frameNow()));  // not waited for
    CHECK(drawsWithoutCompiling());
    for (int frame = 0; frame < 2; ++frame) { scenes.passOver(); }
    settings.stereo.warp.budget = 0.9;
    scenes.expect(settings, size_px, {size_px, true});
    CHECK(these(scenes.isMakingMethod(), scenes.drawable(settings)) == these(false, settings));
    // Chosen, and then changed back.
    const ViewSettings two_pass = settings;
    settings.stereo.mode = Mode::kPaper;
    scenes.expect(settings, size_px, {size_px, true});
    settings = two_pass;
    scenes.expect(settings, size_px, {size_px, true});
    waitUntilReady();
    CHECK(scenes.drawable(settings) == settings);
    // Splats of another kind need other kernels.
    scenes.begin("builtin:atelier");
    REQUIRE(scenes.take(state).empty());
    CHECK(drawsWithoutCompiling());
}

}  // SUITE(shown_scene)
