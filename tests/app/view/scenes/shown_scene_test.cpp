// Facts about showing one scene after another: a dropped or chosen scene replaces the one that is shown, or a
// line says why not. Also about remembered places.
#include "app/view/scenes/shown_scene.h"
#include "app/options/modes.h"
#include "app/view/panel/canvas.h"
#include "app/view/panel/panel_content.h"
#include "app/view/panel/panel_style.h"
#include "app/view/scenes/viewpoint_list.h"
#include "app/view/settings/view_files.h"
#include "engine/builtin/procedural.h"
#include "engine/files/load_scene.h"
#include "engine/files/ply.h"
#include "tests/engine/gpu/device_image.h"
#include "tests/run_program.h"

#ifdef BINOSPLAT_SOG
#include "tests/engine/files/sog_scenes.h"
#endif

#include <sys/stat.h>

SUITE(shown_scene) {

struct Shown : Gpu, Workplace {
    using Workplace::run, Workplace::write;

    Shown() {
        setenv("XDG_CONFIG_HOME", (base / "config").c_str(), 1);
        options.scene = "builtin:step-edge";
    }
    ~Shown() { unsetenv("XDG_CONFIG_HOME"); }

    // One line says why, and the scene stays as it was.
    void checkRefused(ShownScene& scenes, const fs::path& place, const std::string& part) {
        CAPTURE(place);
        const LoadedScene* before = scenes.get();
        scenes.begin(place.string());
        const std::string complaint = scenes.take(state);
        INFO(complaint);
        CHECK(complaint.starts_with(place.string() + ": "));
        CHECK(complaint.find(part) != std::string::npos);
        CHECK(complaint.find('\n') == std::string::npos);
        CHECK(scenes.get() == before);
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
    write("notes.txt", "no scene");
    fs::create_directory(path / "pictures");
    REQUIRE(mkfifo((path / "pipe.ply").c_str(), 0600) == 0);
    checkRefused(scenes, path / "notes.txt", "not a scene file of a known format");
    checkRefused(scenes, path / "pictures", "is a directory, expected one with");
    checkRefused(scenes, path / "pipe.ply", "is not a regular file");
    checkRefused(scenes, path / "gone.ply", "no such file");
    CHECK_FALSE(scenes.loading().has_value());
}

#ifdef BINOSPLAT_SOG
TEST_CASE_FIXTURE(Shown, "a folder of a SOG scene is shown like a file, with or without a slash at its end") {
    fs::create_directory(path / "statue");
    for (const auto& [name, bytes] : makeSog()) { write("statue/" + name, bytes); }
    ShownScene scenes(context(), options, log);
    REQUIRE(scenes.take(state).empty());
    for (const std::string& place : {(path / "statue").string(), (path / "statue").string() + "/",
                                     (path / "statue" / "meta.json").string()}) {
        CAPTURE(place);
        scenes.begin(place);
        CHECK(scenes.take(state).empty());
        CHECK(scenes.name() == place);
        CHECK(scenes.get()->facts.splats == 8);
        CHECK(scenes.get()->facts.file_bytes > 0);
    }
}
#endif

TEST_CASE_FIXTURE(Shown,
                  "one that was asked for while another came takes its place, and if it cannot be read the "
                  "first comes after all") {
    ShownScene scenes(context(), options, log);
    scenes.begin("builtin:fence");
    scenes.begin("builtin:slanted-wall");
    CHECK(scenes.take(state).empty());
    CHECK(scenes.name() == "builtin:slanted-wall");
    CHECK_FALSE(scenes.loading().has_value());
    ShownScene others(context(), options, log);
    others.begin((path / "gone.ply").string());
    CHECK(others.take(state).find("gone.ply: no such file") != std::string::npos);
    CHECK(others.get() == nullptr);
    CHECK(others.take(state).empty());
    CHECK(others.name() == "builtin:step-edge");
    // The scene of the command line has nothing to fall back to.
    options.scene = (path / "gone.ply").string();
    ShownScene none(context(), options, log);
    CHECK_THROWS_AS(static_cast<void>(none.take(state)), Error);
}

TEST_CASE_FIXTURE(Shown,
                  "a place belongs to the scene that it was given with: others start at their own, or where "
                  "they were saved") {
    const auto startOf = [&](const std::string& scene, const ViewOptions& given) {
        ShownScene scenes(context(), given, log);
        scenes.begin(scene);
        REQUIRE(scenes.take(state).empty());
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
    for (const char* scene : {"builtin:fence", "builtin:step-edge"}) { (void)saveViewSettings(scene, moved); }
    CHECK(same(startOf("builtin:fence", options), *moved.scene_from_room));
    CHECK(same(startOf("builtin:step-edge", options), given));
}

TEST_CASE_FIXTURE(Shown,
                  "a remembered place that is of no use is one line, the scene is shown at its start, saving "
                  "mends the file") {
    const fs::path file = viewSettingsFile(options.scene);
    const auto showAgain = [&](std::string& complaint) {
        ShownScene scenes(context(), options, log);
        complaint = scenes.take(state);
        return same(state.sceneFromRoom(), scenes.get()->start);
    };
    std::string complaint;
    CHECK(showAgain(complaint));
    CHECK(complaint.empty());
    ViewSettings moved = state.withPlacement();
    moved.scene_from_room->position += glm::dvec3(1.0, 2.0, 3.0);
    const auto spoil = [&](const std::string& text) {
        fs::remove_all(file);
        fs::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    };
    const auto checkSaid = [&] {
        CHECK(showAgain(complaint));
        INFO(complaint);
        CHECK(complaint.find(file.string()) != std::string::npos);
        CHECK(complaint.find('\n') == std::string::npos);
    };
    for (const std::string& text : {std::string("[view\n"), std::string("[view]\nunits-per-metre = 2\n"),
                                    std::string("\xff\xfe\0\0", 4)}) {
        CAPTURE(text);
        spoil(text);
        checkSaid();
        // The next save repairs it.
        CHECK(saveViewSettings(options.scene, moved) == "saved as " + file.string());
        CHECK_FALSE(showAgain(complaint));
        CHECK(complaint.empty());
    }
    // Anything but a regular file stays, even when settings are saved, and nothing waits for a pipe.
    fs::remove(file);
    fs::create_directory(file);
    checkSaid();
    CHECK(saveViewSettings(options.scene, moved).find("is a directory") != std::string::npos);
    CHECK(fs::is_directory(file));
    fs::remove(file);
    REQUIRE(mkfifo(file.c_str(), 0600) == 0);
    checkSaid();
    CHECK(fs::is_fifo(file));
    // No half-written file is left.
    CHECK(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()) == 1);
}

TEST_CASE_FIXTURE(
    Shown, "loading gives up where it is told to, before the file's end, and so does the way to the device") {
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
    const Scene scene = loadScene((path / "many.ply").string());
    double furthest = 0.0;
    const auto stop = [&](double share) {
        furthest = std::max(furthest, share);
        throw Enough();
    };
    CHECK_THROWS_AS(GpuScene(context(), scene, stop), Enough);
    CHECK(furthest < 0.6);
}

TEST_CASE_FIXTURE(
    Shown,
    "a loader that was told to give up ends, and keeps nothing in memory, whether it was in time or not") {
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
    CHECK(early.take() == nullptr);
    CHECK(late.take() == nullptr);
    // Nor does a scene that was fully loaded when another one was requested.
    ShownScene scenes(context(), options, log);
    while (!scenes.isNextReady()) { std::this_thread::yield(); }
    const std::uint64_t one = context().memoryUse().current_bytes;
    scenes.begin((path / "gone.ply").string());
    while (!scenes.isNextReady()) { std::this_thread::yield(); }
    CHECK(one > before);
    CHECK(context().memoryUse().current_bytes == before);
}

TEST_CASE_FIXTURE(Gpu, "the panel has the same colours where the runtime has no sRGB images, as light") {
    const auto drawn = [&](vk::Format format) {
        Canvas canvas(context(), kPanelPx, format);
        ViewSettings settings;
        SceneChooser chooser;
        PanelStatus status;
        status.has_scene = true;
        canvas.begin({}, 0.01);
        static_cast<void>(drawPanel(kPanelPx, settings, chooser, status));
        canvas.end();
        const test::DeviceImage image(context(), kPanelPx, format);
        const Buffer bytes = allocate<std::uint32_t>("panel", std::size_t{kPanelPx.x} * kPanelPx.y);
        run([&](Commands& commands) {
            canvas.record(commands);
            canvas.copyTo(commands, *image.image);
            image.copyLevel(commands, 0, kPanelPx, bytes, 0);
        });
        return readBack<std::uint32_t>(bytes, std::size_t{kPanelPx.x} * kPanelPx.y);
    };
    using Format = vk::Format;
    for (const auto& [encoded, linear] : {std::pair(Format::eR8G8B8A8Srgb, Format::eR8G8B8A8Unorm),
                                          std::pair(Format::eB8G8R8A8Srgb, Format::eB8G8R8A8Unorm)}) {
        const std::vector<std::uint32_t> seen = drawn(encoded), light = drawn(linear);
        std::set<std::uint32_t> colours;
        double farthest = 0.0;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            colours.insert(seen[i]);
            for (const int shift : {0, 8, 16}) {
                const double value = (seen[i] >> shift & 255) / 255.0;
                const double expected =
                    value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
                farthest = std::max(farthest, std::abs((light[i] >> shift & 255) - 255.0 * expected));
            }
        }
        CHECK(colours.size() > 20);
        CHECK(farthest < 1.0);
    }
}

TEST_CASE_FIXTURE(Shown,
                  "two scenes are compared where their files say they are; another scene ends that, and so "
                  "does one that cannot be read") {
    Scene far = loadScene("builtin:one-splat");
    far.origin = {500'000.0, 0.0, -300'000.0};
    writePly(far, (path / "far.ply").string());
    options.compare = (path / "far.ply").string();
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
    // The next one that is asked for is compared, not shown; that it cannot be read leaves the first one
    // alone.
    CHECK(scenes.toggleComparison().find("no longer compared") != std::string::npos);
    CHECK(scenes.drawn() == scenes.get());
    CHECK(scenes.toggleComparison().find("to compare with builtin:step-edge") != std::string::npos);
    scenes.begin((path / "gone.ply").string());
    CHECK(scenes.takeOther().find("no such file") != std::string::npos);
    CHECK(scenes.names() == "builtin:step-edge");
    scenes.begin("builtin:fence", "builtin:slanted-wall");
    REQUIRE(scenes.take(state).empty());
    REQUIRE(scenes.takeOther().empty());
    CHECK(scenes.names() == "builtin:fence | builtin:slanted-wall");
    scenes.draw(true);
    scenes.begin("builtin:step-edge");
    REQUIRE(scenes.take(state).empty());
    CHECK(scenes.names() == "builtin:step-edge");
    CHECK(scenes.drawn() == scenes.get());
}

TEST_CASE_FIXTURE(Shown,
                  "where two scenes do not fit together, the one that is shown goes first, with a word, and "
                  "comes back if that was in vain") {
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
    options.scene = (path / "many.ply").string();
    const std::string more = (path / "more.ply").string(), most = (path / "most.ply").string();
    ShownScene scenes(small, options, log);
    REQUIRE(scenes.take(state).empty());
    const Similarity moved = Similarity{{1, 0, 0, 0}, {1, 2, 3}, 2.0};
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
    CHECK(scenes.take(state).find(" is removed first") != std::string::npos);
    CHECK(scenes.take(state).find("MiB") != std::string::npos);
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
    options.scene = (path / "one.ply").string();
    ShownScene scenes(context(), options, log);
    REQUIRE(scenes.take(state).empty());
    FileWorker files;
    std::string said;
    ViewpointList list(files, [&](const std::string& words) { said = words; });
    CHECK(list.goBy(1) == nullptr);
    list.show(scenes.get());
    CHECK(list.goBy(1) == nullptr);
    CHECK(said.find("no viewpoints") != std::string::npos);
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
    list.moveBy(-1);
    list.moveBy(-1);
    list.moveBy(-1);
    CHECK(names() == "door;your own 1;your own 2;");
    CHECK(list.words() == "viewpoint 1 of 3: door");
    REQUIRE(list.goBy(1) != nullptr);
    list.forget();
    CHECK(names() == "door;your own 2;");
    CHECK_FALSE(list.requireOwn());
    // Shared, then read by somebody who has none of them; reading twice adds nothing.
    list.writeShared();
    files.finish();
    CHECK(said == "2 viewpoints are in " + (path / "one.viewpoints.json").string());
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
        CHECK(said == fmt::format("2 viewpoints from {}, {} of them new",
                                  (path / "one.viewpoints.json").string(), added));
    }
    CHECK(list.count() == 2);
    list.read((path / "gone.json").string());
    readAll();
    CHECK(said.find("gone.json") != std::string::npos);
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

TEST_CASE_FIXTURE(Shown,
                  "another method is drawn once its kernels are there, made beside the frames, and the next "
                  "scene comes with them") {
    ViewSettings settings;
    options.run.stereo.mode = settings.stereo.mode = Mode::kMono;
    const glm::uvec2 size_px(64, 64);
    ShownScene scenes(context(), options, log, FramesAhead{settings.stereo, size_px, false, false, {}});
    // Chosen while the first scene loads.
    settings.stereo.mode = Mode::kShared;
    scenes.expect(settings.stereo, size_px, false);
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
    // Chosen while it is shown: frames go on as before until kernels and other frames are ready. Values of
    // sliders apply at once.
    const ViewSettings shared = settings;
    settings.stereo.mode = Mode::kTwoPass;
    scenes.expect(settings.stereo, size_px, false);
    CHECK(these(scenes.isMakingMethod(), scenes.drawable(settings).stereo) == these(true, shared.stereo));
    const auto waitUntilReady = [&] {
        while (scenes.isMakingMethod()) {
            std::this_thread::yield();
            scenes.expect(settings.stereo, size_px, false);
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
    scenes.expect(settings.stereo, size_px, false);
    CHECK(these(scenes.isMakingMethod(), scenes.drawable(settings)) == these(false, settings));
    // Chosen, and then changed back.
    const ViewSettings two_pass = settings;
    settings.stereo.mode = Mode::kPaper;
    scenes.expect(settings.stereo, size_px, false);
    settings = two_pass;
    scenes.expect(settings.stereo, size_px, false);
    waitUntilReady();
    CHECK(scenes.drawable(settings) == settings);
    // Splats of another kind need other kernels.
    scenes.begin("builtin:atelier");
    REQUIRE(scenes.take(state).empty());
    CHECK(drawsWithoutCompiling());
}

}  // SUITE(shown_scene)
