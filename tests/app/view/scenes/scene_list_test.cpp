// Facts about finding a scene: folders, recent scenes, what is shown and saved about a scene, and places in
// it.
#include "app/view/scenes/scene_list.h"
#include "app/view/files/file_worker.h"
#include "app/view/files/picture_writer.h"
#include "app/view/governor/met_displays.h"
#include "app/view/panel/scene_chooser.h"
#include "app/view/scenes/natural_order.h"
#include "app/view/scenes/recent_scenes.h"
#include "app/view/scenes/scene_facts.h"
#include "app/view/scenes/seen_scenes.h"
#include "app/view/scenes/view_scenes.h"
#include "app/view/scenes/viewpoints.h"
#include "app/view/settings/view_files.h"
#include "app/view/settings/view_state.h"
#include "engine/files/scene_folder.h"
#include "tests/run_program.h"

#include <sys/stat.h>

#include <future>

SUITE(scene_list) {

// A user of the test's own, with scenes.
struct Home : Workplace {
    Home() { setenv("XDG_CONFIG_HOME", (base / "config").c_str(), 1); }
    ~Home() { unsetenv("XDG_CONFIG_HOME"); }
    void add(const std::string& name) const { write(name, "x"); }
    [[nodiscard]] std::string at(const std::string& name) const { return (path / name).string(); }
};

std::vector<std::string> namesOf(const SceneList& list) {
    std::vector<std::string> names;
    for (const SceneEntry& entry : list.entries) {
        names.push_back(entry.name + (entry.is_folder ? "/" : ""));
    }
    return names;
}

const SceneEntry& entryOf(const SceneList& list, const std::string& name) {
    const auto found = std::ranges::find(list.entries, name, &SceneEntry::name);
    REQUIRE(found != list.entries.end());
    return *found;
}

TEST_CASE("numbers in names count as numbers, capitals do not count, and every two names have an order") {
    const std::vector<std::string> ordered{"",           "2",    "10",       "a",       "A1",
                                           "a2",         "a02b", "a10",      "a00010c", "room2.ply",
                                           "Room10.ply", "z",    "\xc3\xa4", "\xd0\x96"};
    for (std::size_t i = 0; i < ordered.size(); ++i) {
        for (std::size_t j = 0; j < ordered.size(); ++j) {
            INFO("ordered[i] ", ordered[i], ", ordered[j] ", ordered[j]);
            CHECK(comesBefore(ordered[i], ordered[j]) == (i < j));
        }
    }
    // More digits than fit into any integer.
    CHECK(comesBefore("a99999999999999999999999998", "a99999999999999999999999999"));
    CHECK(comesBefore("A", "a") != comesBefore("a", "A"));
    CHECK(comesBefore("a1", "a01") != comesBefore("a01", "a1"));
}

TEST_CASE_FIXTURE(
    Home, "a folder is listed with its folders and scenes, and without what is hidden or something else") {
    for (const char* name : {"room10.ply", "room2.PLY", "a.spz", ".hidden.ply", "notes.txt",
                             "\xd0\x91\xd1\x8e\xd1\x81\xd1\x82.splat"}) {
        add(name);
    }
    for (const char* name : {"zoo", "Attic", ".git", "statue", "folder.ply"}) {
        fs::create_directory(path / name);
    }
    add("statue/meta.json");
    fs::create_directories(path / "trained/point_cloud/iteration_7");
    add("trained/point_cloud/iteration_7/point_cloud.ply");
    fs::create_directories(path / "untrained/point_cloud/iteration_7");
    const SceneList list = listFolder(path.string());
    CHECK(these(list.trouble.empty(), list.title, list.above) == these(true, path.string(), base.string()));
    CHECK(namesOf(list) == std::vector<std::string>{"Attic/", "folder.ply/", "untrained/", "zoo/", "a.spz",
                                                    "room2.PLY", "room10.ply", "statue", "trained",
                                                    "\xd0\x91\xd1\x8e\xd1\x81\xd1\x82.splat"});
    for (const SceneEntry& entry : list.entries) { CHECK(entry.trouble.empty()); }
    CHECK(entryOf(list, "zoo").place == at("zoo"));
    // The viewer's *next scene* uses the same order.
    CHECK(these(sceneBeside(at("room2.PLY"), 1), sceneBeside(at("room10.ply"), 1)) ==
          these(at("room10.ply"), at("statue")));
}

TEST_CASE_FIXTURE(Home, "what cannot be opened is listed with the reason, and nothing waits for a pipe") {
    REQUIRE(mkfifo((path / "pipe.ply").c_str(), 0600) == 0);
    fs::create_symlink("nowhere.ply", path / "gone.ply");
    fs::create_symlink("loop.ply", path / "loop.ply");
    add("good.ply");
    const SceneList list = listFolder(path.string());
    CHECK(these(entryOf(list, "pipe.ply").trouble.empty(), entryOf(list, "gone.ply").trouble,
                entryOf(list, "loop.ply").trouble.empty()) == these(false, "is not there", false));
    CHECK(entryOf(list, "good.ply").trouble.empty());
    CHECK(these(listFolder(at("nowhere")).trouble.empty(), listFolder(at("good.ply")).trouble.empty(),
                listFolder(at("nowhere")).above) == these(false, false, path.string()));
}

TEST_CASE("the way up ends at the top, and built-in scenes have a place of their own") {
    CHECK(listFolder("/").above.empty());
    // Where drives exist, they are listed above their roots.
    const Home work;
    const std::vector<fs::path> drives{"/", work.path};
    CHECK(these(listFolder("/", drives).above, listFolder(work.path.string(), drives).above) ==
          these(kDrives, work.base.string()));
    const SceneList all = listFolder(kDrives, drives);
    CHECK(all.above.empty());
    REQUIRE(all.entries.size() == 2);
    CHECK(these(all.entries[0].name, all.entries[1].place, all.entries[1].is_folder) ==
          these("/", work.path.string(), true));
    CHECK(listFolder("/").title == "/");
    CHECK(these(folderOf("builtin:fence"), folderOf("a/b/../c.ply"), folderOf("a/statue/"),
                folderOf("c.ply")) == these(kBuiltinFolder, (fs::current_path() / "a").string(),
                                            (fs::current_path() / "a").string(),
                                            fs::current_path().string()));
    const SceneList builtin = listFolder(kBuiltinFolder);
    CHECK(builtin.above.empty());
    CHECK(entryOf(builtin, "fence").place == "builtin:fence");
}

TEST_CASE(
    "recent scenes are kept in the user's folder, the latest first, each once, ten at most, and missing ones "
    "are marked") {
    const Home work;
    CHECK(recentScenes().empty());
    work.add("a.ply");
    rememberScene(work.at("a.ply"));
    rememberScene((work.path / "sub" / ".." / "gone.ply").string());
    rememberScene("builtin:fence");
    const std::vector<std::string> kept{"builtin:fence", work.at("gone.ply"), work.at("a.ply")};
    CHECK(recentScenes() == kept);
    const SceneList list = listScenes("Recent scenes", recentScenes());
    CHECK(namesOf(list) == std::vector<std::string>{"builtin:fence", "gone.ply", "a.ply"});
    CHECK(these(list.entries[0].trouble.empty(), list.entries[1].trouble, list.entries[2].trouble.empty(),
                list.entries[2].place) == these(true, "is not there", true, kept[2]));
    // A name with a line break would read as two scenes.
    rememberScene(work.at("two\nlines.ply"));
    CHECK(recentScenes() == kept);
    for (int i = 0; i < 12; ++i) { rememberScene(work.at(fmt::format("{}.ply", i))); }
    CHECK(these(recentScenes().size(), recentScenes().front(), recentScenes().back()) ==
          these(kMostRecentScenes, work.at("11.ply"), work.at("2.ply")));
    rememberScene(work.at("5.ply"));
    const std::vector<std::string> latest = recentScenes();
    CHECK(these(latest.size(), latest.front()) == these(kMostRecentScenes, work.at("5.ply")));
    CHECK(std::ranges::count(latest, work.at("5.ply")) == 1);
    // The folder holds only the list, and a list that cannot be written stays as it was.
    const fs::path folder = work.base / "config" / "binosplat";
    CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
    fs::remove(folder / "recent-scenes.txt");
    fs::create_directory(folder / "recent-scenes.txt");
    CHECK(recentScenes().empty());
    CHECK_THROWS_AS(rememberScene("builtin:fence"), Error);
    CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
}

TEST_CASE("files are read beside whoever asks, who waits for nothing, and what is to be written is written") {
    std::promise<void> disk;
    std::vector<std::string> delivered;
    bool was_written = false;
    {
        FileWorker files;
        CHECK(files.now().empty());
        files.read("reading /far/away", [&, arrival = disk.get_future().share()]() -> FileWorker::Done {
            arrival.wait();
            return [&, by = std::this_thread::get_id()] {
                delivered.push_back(by == std::this_thread::get_id() ? "here" : "far");
            };
        });
        files.write("saving", [&]() -> FileWorker::Done { return [&] { delivered.push_back("saved"); }; });
        // However long the disk takes, frames go on, and can say what they are waiting for.
        files.deliver();
        CHECK(delivered.empty());
        CHECK(files.now() == "reading /far/away");
        std::thread([&] { disk.set_value(); }).join();
        files.finish();
        CHECK(delivered == std::vector<std::string>{"far", "saved"});
        CHECK(files.now().empty());
        files.write("failing", []() -> FileWorker::Done { fail("no room on the disk"); });
        CHECK_THROWS_WITH_AS(files.finish(), "no room on the disk", Error);
        files.write("saving", [&]() -> FileWorker::Done {
            was_written = true;
            return {};
        });
    }
    CHECK(was_written);
}

TEST_CASE("a scene is described in words: how much, of what kind, how large") {
    SceneFacts facts;
    facts.splats = 1234567;
    facts.left_out = 3;
    facts.kind = "3D Gaussians";
    facts.sh_degree = 1;
    facts.sh_degree_in_file = 3;
    facts.device_bytes = 64u << 20;
    facts.file_bytes = 2048;
    const auto lines = describeFacts(facts, 0.25);
    const auto valueOf = [&](const std::string& name) {
        const auto found = std::ranges::find(lines, name, &std::pair<std::string, std::string>::first);
        REQUIRE(found != lines.end());
        return found->second;
    };
    CHECK(these(valueOf("Splats"), valueOf("Kind"), valueOf("Colours (SH)"), valueOf("In memory"),
                valueOf("File")) == these("1 234 567, 3 broken ones left out", "3D Gaussians",
                                          "degree 1, 3 in the file", "64.0 MiB", "2.0 KiB"));
    CHECK(valueOf("Scale") == "0.25 metres a scene unit");
    CHECK(describeFacts({}, 1.0).at(0).second == "0");
    // From what the loader found.
    const Home work;
    fs::create_directory(work.path / "sog");
    work.write("sog/meta.json", std::string(100, 'x'));
    work.write("sog/means.webp", std::string(1000, 'x'));
    Scene scene;
    scene.positions.resize(2);
    scene.thicknesses.resize(2);
    scene.sh_degree = 2;
    LoadNotes notes;
    notes.three_scales = true;
    notes.skipped_not_finite = 4;
    notes.sh_degree_in_file = 2;
    const SceneFacts folder = factsOf(scene, notes, work.at("sog"));
    CHECK(these(folder.splats, folder.left_out, folder.kind, folder.file_bytes) ==
          these(2, 4, "3D Gaussians", 1100));
    CHECK(folder.device_bytes > 0);
    CHECK(factsOf(scene, notes, "builtin:fence").file_bytes == 0);
    CHECK(factsOf(scene, notes, (work.path / "sog" / "meta.json").string()).file_bytes == 100);
    scene.thicknesses.clear();
    CHECK(factsOf(scene, notes, "x").kind == "3D Gaussians, drawn as discs");
    notes.three_scales = false;
    CHECK(factsOf(scene, notes, "x").kind == "2D Gaussians (discs)");
}

TEST_CASE_FIXTURE(Home,
                  "a folder of many numbered scenes is one that moves; of a few it is one to look into") {
    for (int number = 1; number <= 23; ++number) { add(fmt::format("frame_{}.ply", number)); }
    for (int number = 1; number <= 60; ++number) { add(fmt::format("note_{}.txt", number)); }
    CHECK_FALSE(looksLikeScene(path));
    for (int number = 24; number <= 45; ++number) { add(fmt::format("frame_{}.ply", number)); }
    CHECK(looksLikeScene(path));
    for (const char* name : {"a.PLY", "a.ply.gz", "a.zip", "a.sog"}) { CHECK(looksLikeScene(path / name)); }
    for (const char* name : {"a.gz", "a.txt.gz", "a.txt", "ply"}) {
        CHECK_FALSE(looksLikeScene(path / name));
    }
}

TEST_CASE(
    "a folder with one scene in it is that scene, as it is on the command line, unless there is something "
    "else to look into") {
    const Home work;
    fs::create_directories(work.path / "garden" / ".cache");
    for (const char* name : {"garden/garden.ply", "garden/readme.txt", "garden/.old.ply"}) { work.add(name); }
    const SceneList list = listFolder(work.path.string());
    CHECK(namesOf(list) == std::vector<std::string>{"garden"});
    CHECK(entryOf(list, "garden").place == work.at("garden"));
    CHECK(sceneBeside(work.at("garden"), 1) == work.at("garden"));
    fs::create_directory(work.path / "garden" / "more");
    CHECK_FALSE(looksLikeScene(work.path / "garden"));
    fs::remove(work.path / "garden" / "more");
    // The command line opens at most this many files to find the scene.
    for (int i = 0; i < kMostFilesOpened - 2; ++i) { work.add(fmt::format("garden/{}.txt", i)); }
    CHECK(looksLikeScene(work.path / "garden"));
    work.add("garden/one-more.txt");
    CHECK_FALSE(looksLikeScene(work.path / "garden"));
    fs::remove(work.path / "garden" / "one-more.txt");
    work.add("garden/second.spz");
    CHECK_FALSE(looksLikeScene(work.path / "garden"));
    // A folder with several scenes opens at the first one, in natural order; the other cases have no first
    // scene.
    CHECK(firstSceneIn(work.at("garden")) == work.at("garden/garden.ply"));
    CHECK(these(firstSceneIn(work.path.string()), firstSceneIn(work.at("garden/garden.ply")),
                firstSceneIn("builtin:atelier")) == these("", "", ""));
}

TEST_CASE(
    "at a viewpoint the eyes are there, look that way and stand upright, wherever the head is in the room, "
    "at the same scale") {
    const View view{{1, 2, 3}, {1, 2.5, 5}, {0, -1, 0.1}, 60.0};
    const Pose head{glm::angleAxis(0.7, glm::dvec3(0, 1, 0)), {0.3, -0.2, 0.5}};
    const Similarity placed = placedAt(view, {{1, 0, 0, 0}, {9, 9, 9}, 2.5}, head);
    CHECK(placed.scale == 2.5);
    CHECK(glm::distance(transform(placed, head.position), view.eye) < 1e-9);
    const glm::dvec3 up = glm::normalize(view.up), ahead = view.look - view.eye;
    CHECK(glm::distance(placed.orientation * glm::dvec3(0, -1, 0), up) < 1e-9);
    const glm::dvec3 looks = transform(placed, head).orientation * glm::dvec3(0, 0, 1);
    CHECK(glm::distance(looks, glm::normalize(ahead - glm::dot(ahead, up) * up)) < 1e-9);
    // A viewpoint that is kept there leads back there.
    const View kept = viewOf(placed, head);
    const Similarity again = placedAt(kept, placed, head);
    CHECK(glm::distance(again.position, placed.position) < 1e-9);
}

TEST_CASE("a place is saved and asked for in the coordinates of the scene's file") {
    ViewSettings settings;
    settings.scene_from_room = Similarity{{1, 0, 0, 0}, {7, 8, 9}, 2.0};
    ViewState state(settings);
    state.countFrom({1.0, 2.0, 3.0});
    CHECK(state.takeAsked()->position == glm::dvec3(6, 6, 6));
    state.place({{1, 0, 0, 0}, {0, 0, 1}, 1.0});
    CHECK(state.withPlacement().scene_from_room->position == glm::dvec3(1, 2, 4));
    state.set(settings);
    CHECK(these(state.sceneFromRoom().position, state.sceneFromRoom().scale) ==
          these(glm::dvec3(6, 6, 6), 2.0));
}

TEST_CASE_FIXTURE(Home, "viewpoints are the cameras beside the scene, and then those that were kept") {
    const std::string scene = at("a.ply");
    add("a.ply");
    CHECK(findViewpoints({}, scene, {}).empty());
    const fs::path kept = viewFileStem(scene).string() + ".viewpoints.json",
                   old = viewFileStem(scene).string() + ".viewpoints.txt";
    fs::create_directories(kept.parent_path());
    std::ofstream(old) << "0 0 1  0 0 2  0 -1 0\n0 0 3  1 0 3  0 -1 0\n";
    write("cameras.json",
          R"([{"img_name": "door", "width": 8, "height": 8, "fx": 8, "fy": 8, "position": [5, 0, 0],
                                    "rotation": [[1,0,0],[0,1,0],[0,0,1]]}])");
    // Lines that are not views: one looks along its own up, and one is incomplete.
    std::ofstream(old, std::ios::app) << "0 0 1 0 0 2 0 0 1\n0 0 1 0\n";
    const std::vector<Viewpoint> found = findViewpoints({}, scene, {});
    REQUIRE(found.size() == 3);
    CHECK(these(found[0].name, found[0].view.eye, found[1].view.eye, found[2].name) ==
          these("door", glm::dvec3(5, 0, 0), glm::dvec3(0, 0, 1), "your own 2"));
    // Viewpoints are in the coordinates of the scene's file, whatever origin its positions count from.
    Scene far;
    far.origin = {4.0, 0.0, -2.0};
    const std::vector<Viewpoint> there = findViewpoints(far, scene, {});
    REQUIRE(there.size() == 3);
    CHECK(these(there[0].view.eye, there[2].view.eye, there[2].view.look) ==
          these(glm::dvec3(1, 0, 2), glm::dvec3(-4, 0, 5), glm::dvec3(-3, 0, 5)));
    CHECK(findViewpoints(far, scene, path / "cameras.json")[0].view.eye == glm::dvec3(1, 0, 2));
    // Viewpoints from older programs move to where all are kept now, in their order and with their names.
    std::vector<Viewpoint> own = keptViewpoints(scene);
    own.back().name = "\u00fcber dem Tisch \"2\"";
    std::swap(own[0], own[1]);
    keepViewpoints(scene, own);
    CHECK_FALSE(fs::exists(old));
    own = keptViewpoints(scene);
    REQUIRE(own.size() == 2);
    CHECK(these(own[0].name, own[0].view.eye, own[0].is_own, own[1].name) ==
          these("\u00fcber dem Tisch \"2\"", glm::dvec3(0, 0, 3), true, "your own 1"));
    // Viewpoints from other people lie beside the scene, and count if the user has kept none.
    CHECK(sharedViewpoints(scene) == at("a.viewpoints.json"));
    writeViewpoints(sharedViewpoints(scene), {own[1]});
    CHECK(keptViewpoints(scene).size() == 2);
    fs::remove(kept);
    REQUIRE(keptViewpoints(scene).size() == 1);
    CHECK(keptViewpoints(scene)[0].view.look == glm::dvec3(0, 0, 2));
}

TEST_CASE_FIXTURE(Home, "a list of viewpoints that is broken is one line with the place") {
    const auto checkRefused = [&](const std::string& text, const std::string& part) {
        write("bad.viewpoints.json", text);
        try {
            static_cast<void>(readViewpoints(at("bad.viewpoints.json")));
            FAIL(text);
        } catch (const Error& error) {
            INFO(error.what());
            CHECK(std::string(error.what()).starts_with(at("bad.viewpoints.json") + ": "));
            CHECK(std::string(error.what()).find(part) != std::string::npos);
        }
    };
    const auto with = [](const std::string& eye) {
        return R"({"viewpoints": [{"name": "a", "eye": )" + eye +
               R"(, "look": [0, 0, 1], "up": [0, -1, 0]}]})";
    };
    write("good.viewpoints.json", with("[0, 0, 0]"));
    CHECK(readViewpoints(at("good.viewpoints.json")).size() == 1);
    checkRefused("{", "JSON");
    checkRefused("{}", "viewpoints");
    checkRefused(with("[0, 0]"), "viewpoints[0].eye");
    checkRefused(with(R"([0, "x", 0])"), "viewpoints[0].eye[1]");
    checkRefused(with("[0, 0, 1]"), "viewpoints[0]: looks nowhere");
}

TEST_CASE_FIXTURE(Home, "favourites come before the recent scenes, each once") {
    for (const char* name : {"a.ply", "b.ply", "c.ply"}) { add(name); }
    for (const char* name : {"a.ply", "b.ply"}) { rememberScene(at(name)); }
    for (const char* name : {"c.ply", "a.ply"}) { toggleFavourite(at(name)); }
    CHECK(favouriteAndRecentScenes() == std::vector<std::string>{at("c.ply"), at("a.ply"), at("b.ply")});
    const SceneList list = makeSceneList({.recent = true, .folder = {}, .number = 1});
    REQUIRE(list.entries.size() == 3);
    CHECK(these(list.entries[0].name, list.entries[1].is_favourite, list.entries[2].is_favourite) ==
          these("c.ply", true, false));
}

TEST_CASE_FIXTURE(Home, "a scene that was shown has a small picture and a line, and favourites come first") {
    for (const char* name : {"a.ply", "b.ply", "c.ply"}) { add(name); }
    Image wide{{400, 100}, 4, {}};
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 400; ++x) {
            wide.values.insert(wide.values.end(), {x < 200 ? 0.0f : 1.0f, 0.5f, 0.0f, 1.0f});
        }
    }
    const Image small = makeScenePicture(wide);
    CHECK(these(small.size_px, small.values.size(), small.values[0], small.values[small.values.size() - 3]) ==
          these(kScenePicturePx, small.pixelCount() * 3, 0.0f, 1.0f));
    keepSeenScene(at("b.ply"), small, "7 splats, discs");
    toggleFavourite(at("c.ply"));
    SceneList list = listFolder(path.string());
    describeScenes(list);
    REQUIRE(list.entries.size() == 3);
    CHECK(these(list.entries[0].name, list.entries[0].is_favourite, list.entries[1].picture.key.empty(),
                list.entries[1].about) == these("c.ply", true, true, "0.0 KiB"));
    CHECK(list.entries[2].about == "7 splats, discs");
    CHECK(list.entries[2].picture.rgba.size() == std::size_t{4} * kScenePicturePx.x * kScenePicturePx.y);
    toggleFavourite(at("c.ply"));
    CHECK(favouriteScenes().empty());
}

TEST_CASE(
    "the rate is that of the frames of the last second, and those are late that come more than a display "
    "after the one before") {
    MetDisplays met;
    CHECK(met.displayHz() == 0.0);
    std::int64_t time_ns = 0;
    const auto show = [&](int frames, std::int64_t step_ms, double period_ms, double met_hz, int late,
                          bool follows = true) {
        CAPTURE(step_ms);
        for (int i = 0; i < frames; ++i) { met.add(time_ns += step_ms * 1'000'000, period_ms, follows); }
        CHECK(these(met.displayHz(), met.metHz(), met.late()) ==
              these(doctest::Approx(1000.0 / period_ms), doctest::Approx(met_hz), late));
    };
    show(1, 0, 10.0, 0.0, 0);
    show(150, 10, 10.0, 100.0, 0);
    show(4, 330, 10.0, 1000.0 / 330.0, 4);   // the last frame and the three before it span more than a second
    show(3, 330, 330.0, 1000.0 / 330.0, 1);  // then a runtime that reports this as its period
    show(100, 10, 10.0, 100.0, 0);
    show(50, 20, 10.0, 50.0, 50);
    show(1, 800, 10.0, 0.0, 0, false);  // the frames before were not meant to be seen
    show(50, 20, 20.0, 50.0, 0);        // a different rate
    show(1, 20, 10.0, 50.0, 0);         // and back again
    show(1, 60'000, 20.0, 0.0, 0);      // the machine slept
}

TEST_CASE("a late frame's reason is what took longer than a display") {
    for (const auto& [cost, words] :
         {std::pair(FrameCost{12, 11, 13}, "the GPU took 12.0 ms"),
          std::pair(FrameCost{9, 11, 13}, "the program took 11.0 ms of processor time"),
          std::pair(FrameCost{9, 2, 13}, "the program was held up: it took 13.0 ms, 2.0 of processor time"),
          std::pair(FrameCost{9, 2, 3},
                    "neither the GPU (9.0 ms) nor the program (3.0 ms) took that long")}) {
        CHECK(whyLate(cost, 10.0).starts_with(words));
    }
}

TEST_CASE("a picture's name has its scene and its time") {
    std::tm when{};
    when.tm_year = 126, when.tm_mon = 4, when.tm_mday = 3, when.tm_hour = 9, when.tm_min = 7, when.tm_sec = 5;
    const auto nameOf = [&](const std::string& scene) {
        const std::string name = pictureName(scene, when), time = "2026-05-03-090705";
        REQUIRE(name.ends_with(time));
        return name.substr(0, name.size() - time.size());
    };
    CHECK(these(nameOf("garden.ply"), nameOf("/a/b.c/garden.v2.ply"), nameOf("scenes/garden/")) ==
          these("garden-", "garden.v2-", "garden-"));
    CHECK(these(nameOf("builtin:atelier"), nameOf("https://a.org/x/garden.ply?dl=1"),
                nameOf("C:\\scenes\\garden.spz")) == these("atelier-", "garden-", "garden-"));
    CHECK(these(nameOf("/a/garden/meta.json"), nameOf("garden/lod-meta.json"), nameOf("/")) ==
          these("garden-", "garden-", ""));
    CHECK(nameOf("what?.ply") == "what_-");
    // Cut between letters.
    std::string umlauts;
    for (int i = 0; i < 80; ++i) { umlauts += "\u00e4"; }
    CHECK(nameOf(umlauts + "x.ply") == umlauts.substr(0, 100) + "-");
}

}  // SUITE(scene_list)
