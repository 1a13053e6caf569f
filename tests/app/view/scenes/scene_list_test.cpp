// Facts about looking for a scene: what a folder holds, in which order, which scenes were shown last, and what is said of one.
#include "app/view/scenes/scene_list.h"
#include "app/view/files/file_worker.h"
#include "app/view/scenes/natural_order.h"
#include "app/view/scenes/recent_scenes.h"
#include "app/view/scenes/scene_facts.h"
#include "app/view/scenes/view_scenes.h"
#include "engine/error.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

TEST_SUITE_BEGIN("scene_list");

namespace scene_list_test {

namespace fs = std::filesystem;
using namespace binosplat;
using binosplat::test::Workplace;

namespace {

void write(const fs::path& path, const std::string& text = "x") { std::ofstream(path) << text; }

std::vector<std::string> namesOf(const SceneList& list) {
    std::vector<std::string> names;
    for (const SceneEntry& entry : list.entries) { names.push_back(entry.name + (entry.is_folder ? "/" : "")); }
    return names;
}

const SceneEntry& entryOf(const SceneList& list, const std::string& name) {
    const auto found = std::ranges::find(list.entries, name, &SceneEntry::name);
    REQUIRE(found != list.entries.end());
    return *found;
}

}  // namespace

TEST_CASE("numbers in names count as numbers, capitals do not count, and every two names have an order") {
    const std::vector<std::string> ordered{"",    "2",       "10",        "a",          "A1", "a2",       "a02b",
                                           "a10", "a00010c", "room2.ply", "Room10.ply", "z",  "\xc3\xa4", "\xd0\x96"};
    for (std::size_t i = 0; i < ordered.size(); ++i) {
        for (std::size_t j = 0; j < ordered.size(); ++j) {
            CAPTURE(ordered[i]);
            CAPTURE(ordered[j]);
            CHECK(comesBefore(ordered[i], ordered[j]) == (i < j));
        }
    }
    // Longer than any number a machine has.
    CHECK(comesBefore("a99999999999999999999999998", "a99999999999999999999999999"));
    CHECK(comesBefore("A", "a") != comesBefore("a", "A"));
    CHECK(comesBefore("a1", "a01") != comesBefore("a01", "a1"));
}

TEST_CASE("a folder is listed with its folders and scenes, and without what is hidden or something else") {
    const Workplace work;
    for (const char* name : {"room10.ply", "room2.PLY", "a.spz", ".hidden.ply", "notes.txt", "\xd0\x91\xd1\x8e\xd1\x81\xd1\x82.splat"}) {
        write(work.path / name);
    }
    for (const char* name : {"zoo", "Attic", ".git", "statue", "folder.ply"}) { fs::create_directory(work.path / name); }
    write(work.path / "statue" / "meta.json");
    fs::create_directories(work.path / "trained/point_cloud/iteration_7");
    write(work.path / "trained/point_cloud/iteration_7/point_cloud.ply");
    fs::create_directories(work.path / "untrained/point_cloud/iteration_7");
    const SceneList list = listFolder(work.path.string());
    CHECK(list.trouble.empty());
    CHECK(list.title == work.path.string());
    CHECK(list.above == work.base.string());
    CHECK(namesOf(list) == std::vector<std::string>{"Attic/", "folder.ply/", "untrained/", "zoo/", "a.spz", "room2.PLY", "room10.ply",
                                                    "statue", "trained", "\xd0\x91\xd1\x8e\xd1\x81\xd1\x82.splat"});
    for (const SceneEntry& entry : list.entries) { CHECK(entry.trouble.empty()); }
    CHECK(entryOf(list, "zoo").place == (work.path / "zoo").string());
    // The viewer's next scene goes the same way.
    CHECK(sceneBeside((work.path / "room2.PLY").string(), 1) == (work.path / "room10.ply").string());
    CHECK(sceneBeside((work.path / "room10.ply").string(), 1) == (work.path / "statue").string());
}

TEST_CASE("what cannot be opened is listed with the reason, and nothing waits for a pipe") {
    const Workplace work;
    REQUIRE(mkfifo((work.path / "pipe.ply").c_str(), 0600) == 0);
    fs::create_symlink("nowhere.ply", work.path / "gone.ply");
    fs::create_symlink("loop.ply", work.path / "loop.ply");
    write(work.path / "good.ply");
    const SceneList list = listFolder(work.path.string());
    CHECK_FALSE(entryOf(list, "pipe.ply").trouble.empty());
    CHECK(entryOf(list, "gone.ply").trouble == "is not there");
    CHECK_FALSE(entryOf(list, "loop.ply").trouble.empty());
    CHECK(entryOf(list, "good.ply").trouble.empty());
    CHECK_FALSE(listFolder((work.path / "nowhere").string()).trouble.empty());
    CHECK_FALSE(listFolder((work.path / "good.ply").string()).trouble.empty());
    CHECK(listFolder((work.path / "nowhere").string()).above == work.path.string());
}

TEST_CASE("the way up ends at the top, and built-in scenes have a place of their own") {
    CHECK(listFolder("/").above.empty());
    CHECK(listFolder("/").title == "/");
    CHECK(folderOf("builtin:fence") == kBuiltinFolder);
    CHECK(folderOf("a/b/../c.ply") == (fs::current_path() / "a").string());
    CHECK(folderOf("a/statue/") == (fs::current_path() / "a").string());
    CHECK(folderOf("c.ply") == fs::current_path().string());
    const SceneList builtin = listFolder(kBuiltinFolder);
    CHECK(builtin.above.empty());
    CHECK(entryOf(builtin, "fence").place == "builtin:fence");
}

TEST_CASE("the latest scenes come first, each once, ten at most") {
    std::vector<std::string> scenes;
    for (int i = 0; i < 12; ++i) { scenes = withLatest(scenes, fmt::format("{}.ply", i)); }
    CHECK(scenes.size() == kMostRecentScenes);
    CHECK(scenes.front() == "11.ply");
    CHECK(scenes.back() == "2.ply");
    scenes = withLatest(scenes, "5.ply");
    CHECK(scenes.size() == kMostRecentScenes);
    CHECK(scenes.front() == "5.ply");
    CHECK(std::ranges::count(scenes, "5.ply") == 1);
}

TEST_CASE("recent scenes are kept in the user's folder, whole or as they were, and missing ones are marked") {
    const Workplace work;
    setenv("XDG_CONFIG_HOME", (work.base / "config").c_str(), 1);
    CHECK(recentScenes().empty());
    write(work.path / "a.ply");
    rememberScene((work.path / "a.ply").string());
    rememberScene((work.path / "sub" / ".." / "gone.ply").string());
    rememberScene("builtin:fence");
    const std::vector<std::string> kept{"builtin:fence", (work.path / "gone.ply").string(), (work.path / "a.ply").string()};
    CHECK(recentScenes() == kept);
    const SceneList list = listScenes("Recent scenes", recentScenes());
    CHECK(namesOf(list) == std::vector<std::string>{"builtin:fence", "gone.ply", "a.ply"});
    CHECK(list.entries[0].trouble.empty());
    CHECK(list.entries[1].trouble == "is not there");
    CHECK(list.entries[2].trouble.empty());
    CHECK(list.entries[2].place == kept[2]);
    // A name of two lines would be two scenes.
    rememberScene((work.path / "two\nlines.ply").string());
    CHECK(recentScenes() == kept);
    // Nothing but the list lies there, and one that cannot be written stays as it was.
    const fs::path folder = work.base / "config" / "binosplat";
    CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
    fs::remove(folder / "recent-scenes.txt");
    fs::create_directory(folder / "recent-scenes.txt");
    CHECK(recentScenes().empty());
    CHECK_THROWS_AS(rememberScene("builtin:fence"), Error);
    CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
    unsetenv("XDG_CONFIG_HOME");
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
            return [&, by = std::this_thread::get_id()] { delivered.push_back(by == std::this_thread::get_id() ? "here" : "far"); };
        });
        files.write("saving", [&]() -> FileWorker::Done { return [&] { delivered.push_back("saved"); }; });
        // However long that takes, frames go on, and say what they have not got yet.
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
    CHECK(valueOf("Splats") == "1 234 567, 3 broken ones left out");
    CHECK(valueOf("Kind") == "3D Gaussians");
    CHECK(valueOf("Colours (SH)") == "degree 1, 3 in the file");
    CHECK(valueOf("In memory") == "64.0 MiB");
    CHECK(valueOf("File") == "2.0 KiB");
    CHECK(valueOf("Scale") == "0.25 metres a scene unit");
    CHECK(describeFacts({}, 1.0).at(0).second == "0");
    // From what loading met.
    const Workplace work;
    fs::create_directory(work.path / "sog");
    write(work.path / "sog" / "meta.json", std::string(100, 'x'));
    write(work.path / "sog" / "means.webp", std::string(1000, 'x'));
    Scene scene;
    scene.positions.resize(2);
    scene.thicknesses.resize(2);
    scene.sh_degree = 2;
    LoadNotes notes;
    notes.three_scales = true;
    notes.skipped_not_finite = 4;
    notes.sh_degree_in_file = 2;
    const SceneFacts folder = factsOf(scene, notes, (work.path / "sog").string());
    CHECK(folder.splats == 2);
    CHECK(folder.left_out == 4);
    CHECK(folder.kind == "3D Gaussians");
    CHECK(folder.file_bytes == 1100);
    CHECK(folder.device_bytes > 0);
    CHECK(factsOf(scene, notes, "builtin:fence").file_bytes == 0);
    CHECK(factsOf(scene, notes, (work.path / "sog" / "meta.json").string()).file_bytes == 100);
    scene.thicknesses.clear();
    CHECK(factsOf(scene, notes, "x").kind == "3D Gaussians, drawn as discs");
    notes.three_scales = false;
    CHECK(factsOf(scene, notes, "x").kind == "2D Gaussians (discs)");
}

TEST_CASE("a folder of many numbered scenes is one that moves; of a few it is one to look into") {
    const Workplace work;
    for (int number = 1; number <= 23; ++number) { write(work.path / fmt::format("frame_{}.ply", number)); }
    for (int number = 1; number <= 60; ++number) { write(work.path / fmt::format("note_{}.txt", number)); }
    CHECK_FALSE(looksLikeScene(work.path));
    for (int number = 24; number <= 45; ++number) { write(work.path / fmt::format("frame_{}.ply", number)); }
    CHECK(looksLikeScene(work.path));
}

}  // namespace scene_list_test
