// Facts about finding a scene: folders, recent scenes, what is shown of a scene, also of one that moves.
#include "app/view/scenes/scene_list.h"
#include "app/view/files/file_worker.h"
#include "app/view/files/picture_writer.h"
#include "app/view/governor/met_displays.h"
#include "app/view/panel/scene_chooser.h"
#include "app/view/scenes/natural_order.h"
#include "app/view/scenes/recent_scenes.h"
#include "app/view/scenes/scene_clock.h"
#include "app/view/scenes/scene_facts.h"
#include "app/view/scenes/seen_scenes.h"
#include "app/view/scenes/view_scenes.h"
#include "engine/files/scene_folder.h"
#include "tests/run_program.h"

#include <sys/stat.h>

#include <future>

SUITE(scene_list) {

// With scenes.
struct Scenes : Home {
    void add(const std::string& name) const { write(name, "x"); }
};

std::vector<std::string> namesOf(const SceneList& list) {
    std::vector<std::string> names;
    for (const SceneEntry& one : list.entries) { names.push_back(one.name + (one.is_folder ? "/" : "")); }
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

TEST_CASE_FIXTURE(Scenes, "a folder is listed with its folders and scenes, and with nothing else") {
    for (const char* name :
         {"room10.ply", "room2.PLY", "a.spz", ".hidden.ply", "notes.txt", "\u0411\u044e\u0441\u0442.splat"}) {
        add(name);
    }
    for (const char* name : {"zoo", "Attic", ".git", "statue", "folder.ply"}) {
        fs::create_directory(path / name);
    }
    add("statue/meta.json");
    for (const char* name : {"trained", "untrained"}) {
        fs::create_directories(path / name / "point_cloud/iteration_7");
    }
    add("trained/point_cloud/iteration_7/point_cloud.ply");
    const SceneList list = listFolder(path.string());
    CHECK(these(list.trouble.empty(), list.title, list.above) == these(true, path.string(), base.string()));
    CHECK(namesOf(list) == std::vector<std::string>{"Attic/", "folder.ply/", "untrained/", "zoo/", "a.spz",
                                                    "room2.PLY", "room10.ply", "statue", "trained",
                                                    "\u0411\u044e\u0441\u0442.splat"});
    for (const SceneEntry& entry : list.entries) { CHECK(entry.trouble.empty()); }
    CHECK(entryOf(list, "zoo").place == at("zoo"));
    // The viewer's *next scene* uses the same order.
    CHECK(these(sceneBeside(at("room2.PLY"), 1), sceneBeside(at("room10.ply"), 1)) ==
          these(at("room10.ply"), at("statue")));
}

TEST_CASE_FIXTURE(Scenes, "what cannot be opened is listed with the reason, and nothing waits for a pipe") {
    REQUIRE(mkfifo((path / "pipe.ply").c_str(), 0600) == 0);
    fs::create_symlink("nowhere.ply", path / "gone.ply");
    fs::create_symlink("loop.ply", path / "loop.ply");
    add("good.ply");
    const SceneList list = listFolder(path.string());
    const auto troubleOf = [&](const std::string& name) { return entryOf(list, name).trouble; };
    CHECK(these(troubleOf("gone.ply"), troubleOf("good.ply")) == these("is not there", ""));
    CHECK(these(troubleOf("pipe.ply").empty(), troubleOf("loop.ply").empty()) == these(false, false));
    CHECK(these(listFolder(at("nowhere")).trouble.empty(), listFolder(at("good.ply")).trouble.empty(),
                listFolder(at("nowhere")).above) == these(false, false, path.string()));
}

TEST_CASE_FIXTURE(Scenes, "the way up ends at the top, and built-in scenes have a place of their own") {
    CHECK(listFolder("/").above.empty());
    // Where drives exist, they are listed above their roots.
    const std::vector<fs::path> drives{"/", path};
    CHECK(these(listFolder("/", drives).above, listFolder(path.string(), drives).above) ==
          these(kDrives, base.string()));
    const SceneList all = listFolder(kDrives, drives);
    CHECK(all.above.empty());
    REQUIRE(all.entries.size() == 2);
    CHECK(these(all.entries[0].name, all.entries[1].place, all.entries[1].is_folder) ==
          these("/", path.string(), true));
    CHECK(listFolder("/").title == "/");
    CHECK(these(folderOf("builtin:fence"), folderOf("a/b/../c.ply"), folderOf("a/statue/"),
                folderOf("c.ply")) == these(kBuiltinFolder, (fs::current_path() / "a").string(),
                                            (fs::current_path() / "a").string(),
                                            fs::current_path().string()));
    const SceneList builtin = listFolder(kBuiltinFolder);
    CHECK(builtin.above.empty());
    CHECK(entryOf(builtin, "fence").place == "builtin:fence");
}

TEST_CASE_FIXTURE(Scenes, "the ten latest scenes are kept in the user's folder, newest first, each once") {
    CHECK(recentScenes().empty());
    add("a.ply");
    for (const std::string& scene : {at("a.ply"), at("sub/../gone.ply"), std::string("builtin:fence")}) {
        rememberScene(scene);
    }
    const std::vector<std::string> kept{"builtin:fence", at("gone.ply"), at("a.ply")};
    CHECK(recentScenes() == kept);
    const SceneList list = listScenes("Recent scenes", recentScenes());
    CHECK(namesOf(list) == std::vector<std::string>{"builtin:fence", "gone.ply", "a.ply"});
    CHECK(these(list.entries[0].trouble, list.entries[1].trouble, list.entries[2].trouble,
                list.entries[2].place) == these("", "is not there", "", kept[2]));
    // A name with a line break would read as two scenes.
    rememberScene(at("two\nlines.ply"));
    CHECK(recentScenes() == kept);
    for (int i = 0; i < 12; ++i) { rememberScene(at(fmt::format("{}.ply", i))); }
    CHECK(these(recentScenes().size(), recentScenes().front(), recentScenes().back()) ==
          these(kMostRecentScenes, at("11.ply"), at("2.ply")));
    rememberScene(at("5.ply"));
    const std::vector<std::string> latest = recentScenes();
    CHECK(these(latest.size(), latest.front(), std::ranges::count(latest, latest.front())) ==
          these(kMostRecentScenes, at("5.ply"), 1));
    // The folder holds only the list, and a list that cannot be written stays as it was.
    const fs::path folder = base / "config" / "binosplat";
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

TEST_CASE_FIXTURE(Scenes, "a scene is described in words: how much, of what kind, how large") {
    const SceneFacts facts{.splats = 1234567,
                           .left_out = 3,
                           .kind = "3D Gaussians",
                           .sh_degree = 1,
                           .sh_degree_in_file = 3,
                           .device_bytes = 64u << 20,
                           .file_bytes = 2048};
    const auto lines = describeFacts(facts, 0.25);
    std::map<std::string, std::string> valueOf(lines.begin(), lines.end());
    CHECK(these(valueOf["Splats"], valueOf["Kind"], valueOf["Colours (SH)"], valueOf["In memory"],
                valueOf["File"], valueOf["Scale"]) ==
          these("1 234 567, 3 broken ones left out", "3D Gaussians", "degree 1, 3 in the file", "64.0 MiB",
                "2.0 KiB", "0.25 metres a scene unit"));
    CHECK(describeFacts({}, 1.0).at(0).second == "0");
    // From what the loader found.
    fs::create_directory(path / "sog");
    write("sog/meta.json", std::string(100, 'x'));
    write("sog/means.webp", std::string(1000, 'x'));
    Scene scene;
    scene.positions.resize(2);
    scene.thicknesses.resize(2);
    scene.sh_degree = 2;
    LoadNotes notes;
    notes.three_scales = true;
    notes.skipped_not_finite = 4;
    notes.sh_degree_in_file = 2;
    const SceneFacts folder = factsOf(scene, notes, at("sog"));
    CHECK(these(folder.splats, folder.left_out, folder.kind, folder.file_bytes) ==
          these(2, 4, "3D Gaussians", 1100));
    CHECK(folder.device_bytes > 0);
    CHECK(these(factsOf(scene, notes, "builtin:fence").file_bytes,
                factsOf(scene, notes, at("sog/meta.json")).file_bytes) == these(0, 100));
    scene.thicknesses.clear();
    CHECK(factsOf(scene, notes, "x").kind == "3D Gaussians, drawn as discs");
    notes.three_scales = false;
    CHECK(factsOf(scene, notes, "x").kind == "2D Gaussians (discs)");
}

TEST_CASE_FIXTURE(Scenes, "a folder of many numbered scenes moves, one of a few is to be looked into") {
    for (int number = 1; number <= 23; ++number) { add(fmt::format("frame_{}.ply", number)); }
    for (int number = 1; number <= 60; ++number) { add(fmt::format("note_{}.txt", number)); }
    CHECK_FALSE(looksLikeScene(path));
    for (int number = 24; number <= 45; ++number) { add(fmt::format("frame_{}.ply", number)); }
    CHECK(looksLikeScene(path));
    for (const char* name : {"a.PLY", "a.ply.gz", "a.zip", "a.sog"}) { CHECK(looksLikeScene(path / name)); }
    for (const auto name : {"a.gz", "a.txt.gz", "a.txt", "ply"}) { CHECK_FALSE(looksLikeScene(path / name)); }
}

TEST_CASE_FIXTURE(Scenes, "a folder with one scene is that scene, unless there is more to look into") {
    const fs::path garden = path / "garden";
    fs::create_directories(garden / ".cache");
    for (const char* name : {"garden/garden.ply", "garden/readme.txt", "garden/.old.ply"}) { add(name); }
    const SceneList list = listFolder(path.string());
    CHECK(namesOf(list) == std::vector<std::string>{"garden"});
    CHECK(these(entryOf(list, "garden").place, sceneBeside(at("garden"), 1)) ==
          these(at("garden"), at("garden")));
    fs::create_directory(garden / "more");
    CHECK_FALSE(looksLikeScene(garden));
    fs::remove(garden / "more");
    // The command line opens at most this many files to find the scene.
    for (int i = 0; i < kMostFilesOpened - 2; ++i) { add(fmt::format("garden/{}.txt", i)); }
    CHECK(looksLikeScene(garden));
    add("garden/one-more.txt");
    CHECK_FALSE(looksLikeScene(garden));
    fs::remove(garden / "one-more.txt");
    add("garden/second.spz");
    CHECK_FALSE(looksLikeScene(garden));
    // A folder with several scenes opens at the first one, in natural order; the other cases have none.
    CHECK(these(firstSceneIn(at("garden")), firstSceneIn(path.string()),
                firstSceneIn(at("garden/garden.ply")),
                firstSceneIn("builtin:atelier")) == these(at("garden/garden.ply"), "", "", ""));
}

TEST_CASE_FIXTURE(Scenes, "a scene that was shown has a small picture and a line; favourites come first") {
    for (const char* name : {"a.ply", "b.ply", "c.ply"}) { add(name); }
    Image wide{{400, 100}, 4, {}};
    for (int i = 0; i < 100 * 400; ++i) {
        wide.values.insert(wide.values.end(), {i % 400 < 200 ? 0.0f : 1.0f, 0.5f, 0.0f, 1.0f});
    }
    const Image small = makeScenePicture(wide);
    CHECK(these(small.size_px, small.values.size(), small.values[0], small.values[small.values.size() - 3]) ==
          these(kScenePicturePx, small.pixelCount() * 3, 0.0f, 1.0f));
    keepSeenScene(at("b.ply"), small, "7 splats, discs");
    for (const char* name : {"a.ply", "b.ply"}) { rememberScene(at(name)); }
    for (const char* name : {"c.ply", "a.ply"}) { toggleFavourite(at(name)); }
    CHECK(favouriteAndRecentScenes() == std::vector<std::string>{at("c.ply"), at("a.ply"), at("b.ply")});
    const SceneList recent = makeSceneList({.recent = true, .folder = {}, .number = 1});
    REQUIRE(recent.entries.size() == 3);
    CHECK(these(recent.entries[0].name, recent.entries[1].is_favourite, recent.entries[2].is_favourite) ==
          these("c.ply", true, false));
    toggleFavourite(at("a.ply"));
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

TEST_CASE("the rate is that of the last second's frames; late are those more than a display after another") {
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

TEST_CASE("the time of a scene that moves goes on while it plays, rests, steps around, and goes to a frame") {
    SceneClock clock(10.0, 5);
    CHECK(clock.frame() == 0);
    for (int i = 0; i < 7; ++i) { clock.pass(0.1); }
    CHECK(these(clock.time_s(), clock.frame()) == these(doctest::Approx(0.7), 2));
    clock.togglePlaying();
    clock.pass(10.0);
    CHECK(clock.frame() == 2);
    for (const auto& [step, frame] : {std::pair(1, 3u), std::pair(2, 0u), std::pair(-1, 4u)}) {
        clock.step(step);
        CHECK(these(clock.frame(), clock.plays()) == these(frame, false));
    }
    clock.togglePlaying();
    clock.goTo(1);
    clock.pass(0.1);
    CHECK(clock.frame() == 2);
    clock.goTo(99);
    CHECK(clock.frame() == 4);
    clock.step(1);
    CHECK_FALSE(clock.plays());
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
    for (const auto& [scene, name] :
         {std::pair("garden.ply", "garden-"), std::pair("/a/b.c/garden.v2.ply", "garden.v2-"),
          std::pair("scenes/garden/", "garden-"), std::pair("builtin:atelier", "atelier-"),
          std::pair("https://a.org/x/garden.ply?dl=1", "garden-"),
          std::pair("C:\\scenes\\garden.spz", "garden-"), std::pair("/a/garden/meta.json", "garden-"),
          std::pair("garden/lod-meta.json", "garden-"), std::pair("/", ""),
          std::pair("what?.ply", "what_-")}) {
        CHECK(nameOf(scene) == name);
    }
    // Cut between letters.
    std::string umlauts;
    for (int i = 0; i < 80; ++i) { umlauts += "\u00e4"; }
    CHECK(nameOf(umlauts + "x.ply") == umlauts.substr(0, 100) + "-");
}

}  // SUITE(scene_list)
