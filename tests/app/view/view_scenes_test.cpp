// Facts about what is to be seen: the next scene, scenes that cannot be read, pictures, and where the wearer stands in them.
#include "engine/picture/metrics.h"
#include "engine/scene/ply.h"
#include "engine/scene/procedural.h"
#include "engine/scene/scene.h"
#include "tests/app/view/panel/panel_sketch.h"
#ifdef BINOSPLAT_SOG
#include "tests/engine/stream/split_scene.h"
#endif
#include "tests/app/view/view_panel.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <iterator>

TEST_SUITE_BEGIN("view_scenes");

namespace view_scenes_test {

using namespace binosplat;
using namespace binosplat::test;

namespace fs = std::filesystem;

namespace {

// The left hand points at the floor.
const std::string kLeftHand = "controller left 0 position -0.2 1.2 -0.35 turn 0 -80\n";
const std::string kDense = "rate 90\nsize 64 64\nframes none\n" + kLeftHand, kSmall = "rate 45\nsize 64 64\nframes none\n" + kLeftHand;
// Scenes load in the meantime, as long as it takes them: not in lock-step, where frames come as fast as they can.
const std::string kWhileLoading = kValidated + " SIMULATED_OPENXR_CLOCK=real";
constexpr double kSlower = 6.0;  // clicks, there

const glm::dvec2 kBeside(0.9, 0.95);

bool says(const ViewRun& run, const std::string& words) { return run.outcome.output.find(words) != std::string::npos; }

const Panel& startPanel(const Workplace& work) {
    static const Panel panel =
        panelOf(runView(work, "look", kDense + "at 0.1 exit\n", "builtin:one-splat --load-first --mode mono --hide-hands"), 8);
    return panel;
}

}  // namespace

TEST_CASE("the next scene comes while this one stays, and one that cannot be read gives a message and changes nothing") {
    const Workplace work;
    REQUIRE(work.run("scene one-splat --out a.ply").exit_code == 0);
    std::ofstream(work.path / "b.ply") << "ply\nnonsense\n";
    REQUIRE(work.run("scene slanted-wall --out c.ply").exit_code == 0);
    std::ofstream(work.path / "notes.txt") << "no scene";
    const Panel panel = startPanel(work);
    const glm::dvec2 next = placeOfScene("Next scene", work.path.string());
    const ViewRun run = runView(work, "next",
                                kSmall + clickAt(panel, placeOf("Scenes"), 1.5, kSlower) + clickAt(panel, next, 2.8, kSlower) +
                                    clickAt(panel, next, 4.3, kSlower) + "at 6 exit\n",
                                "a.ply --load-first --mode mono --hide-hands", kWhileLoading);
    checkClean(run);
    const std::string& output = run.outcome.output;
    const std::size_t first = output.find("shows a.ply"), broken = output.find("b.ply:"), third = output.find("shows c.ply");
    CHECK(first < broken);
    CHECK(broken < third);
    CHECK(third != std::string::npos);
    // There was always something to see.
    for (std::size_t frame = 4; frame + 4 < run.frames.size(); ++frame) { REQUIRE(run.layers(frame, "projection").size() == 1); }
}

#ifdef BINOSPLAT_SOG
TEST_CASE("a streamed scene is there at once, becomes finer while frames go on, and says what is missing") {
    const Workplace work;
    splitScene(makeBuiltin("builtin:atelier", 16'000), (work.path / "split").string(),
               {.leaf_splats = 1000, .levels = 4, .chunk_splats = 4000});
    fs::remove(work.path / "split" / "0_2.sog");
    const ViewRun run = runView(work, "streamed",
                                "rate 45\nsize 96 96\nframes every 1\nhead 0 position 0 1.6 0\nhead 2 position 0 1.6 0\nhead 3 position 0 "
                                "1.6 0 turn 90 0\nat 6 exit\n",
                                "split --load-first --mode shared --hide-hands --hide-panel --splat-budget 9000", kWhileLoading);
    checkClean(run);
    const std::string& output = run.outcome.output;
    CHECK(output.find("shows split") < output.find("all that is seen is there: "));
    CHECK(says(run, "all that is seen is there: "));
    CHECK(says(run, "16 levels of leaves, 0.0"));
    CHECK(says(run, " s; frames that waited for it: 0"));
    CHECK(says(run, "0_2.sog is not there, expected a chunk of the scene; what is there stays"));
    REQUIRE(run.frames.size() > 4);
    for (std::size_t frame = 2; frame + 4 < run.frames.size(); ++frame) { REQUIRE(run.layers(frame, "projection").size() == 1); }
    const Image third = run.eye(2, kLeft);
    const auto [least, most] = std::ranges::minmax(third.values);
    CHECK(most - least > 0.2f);
}
#endif

TEST_CASE("a scene is chosen on the panel, in the folder of the one that is shown, and both are remembered") {
    const Workplace work;
    // "scenes" in Hebrew: letters that the panel's font gets while it is shown.
    const std::string name = "\xd7\xa1\xd7\xa6\xd7\xa0\xd7\x95\xd7\xaa";
    const std::filesystem::path folder = work.path / name;
    std::filesystem::create_directory(folder);
    REQUIRE(work.run("scene one-splat --out " + name + "/room10.ply").exit_code == 0);
    REQUIRE(work.run("scene slanted-wall --out " + name + "/room9.ply").exit_code == 0);
    std::ofstream(folder / "room1.ply") << "ply\nnonsense\n";
    const Panel panel = startPanel(work);
    const glm::dvec2 broken = placeOfScene("room1.ply", folder.string()), other = placeOfScene("room9.ply", folder.string());
    const ViewRun run = runView(work, "choose",
                                kSmall + clickAt(panel, placeOf("Scenes"), 1.5, kSlower) + clickAt(panel, broken, 2.8, kSlower) +
                                    clickAt(panel, other, 4.3, kSlower) + "at 6 exit\n",
                                name + "/room10.ply --load-first --mode mono --hide-hands", kWhileLoading);
    checkClean(run);
    const std::string& output = run.outcome.output;
    const std::string place = (folder / "room9.ply").string(), bad = (folder / "room1.ply").string();
    CHECK(output.find("shows " + name + "/room10.ply") < output.find(bad + ":"));
    CHECK(output.find(bad + ":") < output.find("shows " + place));
    CHECK(output.find("shows " + place) != std::string::npos);
    std::ifstream file(work.base / "config" / "binosplat" / "recent-scenes.txt");
    const std::string recent(std::istreambuf_iterator<char>(file), {});
    CHECK(recent.starts_with(place + "\n" + (folder / "room10.ply").string() + "\n"));
    CHECK(recent.find(bad) == std::string::npos);
}

TEST_CASE("the scene of the command line that cannot be read ends it, with one") {
    const Workplace work;
    std::ofstream(work.path / "b.ply") << "ply\nnonsense\n";
    const ViewRun run = runView(work, "bad", kSmall + "at 3 exit\n", "b.ply", "DISPLAY=");
    CHECK(run.outcome.exit_code == 1);
    CHECK(run.outcome.errors.starts_with("binosplat: b.ply:"));
}

TEST_CASE("a picture of both eyes is a file that is not overwritten") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const ViewRun run =
        runView(work, "shots",
                "rate 45\nsize 160 160\nframes every 5\n" + kLeftHand + clickOn(panel, {placeOf("Picture"), placeOf("Picture"), kBeside}),
                "builtin:slanted-wall --load-first --mode shared --hide-hands");
    checkClean(run);
    CHECK(says(run, "picture binosplat-0001.png"));
    CHECK(says(run, "picture binosplat-0002.png"));
    const Image both = readPicture(work.path / "binosplat-0001.png");
    REQUIRE(both.size_px == glm::uvec2(320, 160));
    // As the wearer sees it, at the right, where no panel hangs.
    for (const int side : {kLeft, kRight}) {
        const Image seen = run.eye(10, side);
        std::size_t same = 0, all = 0;
        for (std::uint32_t y = 0; y < 160; ++y) {
            for (std::uint32_t x = 120; x < 160; ++x) {
                const float a = both.values[(std::size_t{y} * 320 + static_cast<std::uint32_t>(side) * 160 + x) *
                                            static_cast<std::size_t>(both.channels)];
                const float b = seen.values[(std::size_t{y} * 160 + x) * static_cast<std::size_t>(seen.channels)];
                same += std::abs(a - b) < 0.01f ? 1 : 0;
                ++all;
            }
        }
        CHECK(same > all * 99 / 100);
    }
}

TEST_CASE("what the lenses hide is there in a picture all the same") {
    const Workplace work;
    const auto take = [&](const std::string& mask) {
        const ViewRun run = runView(work, "whole",
                                    "rate 45\nsize 160 160\nframes none\nvisibility-mask " + mask + "\n" + kLeftHand +
                                        clickOn(startPanel(work), {placeOf("Picture"), kBeside}),
                                    "builtin:slanted-wall --load-first --mode shared --hide-hands");
        checkClean(run);
        CHECK(says(run, "the lenses hide ") == (mask == "on"));
        Image both = readPicture(work.path / "binosplat-0001.png");
        fs::remove(work.path / "binosplat-0001.png");
        return both;
    };
    CHECK(take("on").values == take("off").values);
}

TEST_CASE("a working directory that was deleted takes no picture, and is no end") {
    const Workplace work;
    const std::string script = kSmall + clickOn(startPanel(work), {placeOf("Picture"), kBeside});
    std::ofstream(work.path / "gone.script") << script;
    const Outcome outcome = work.runCommand(
        fmt::format("mkdir gone && cd gone && rmdir ../gone && DISPLAY= WAYLAND_DISPLAY= XDG_CONFIG_HOME='{0}/config' '" BINOSPLAT_PROGRAM
                    "' view builtin:one-splat --load-first --mode mono --simulate '{0}/gone.script' --out '{0}/seen'",
                    work.path.string()));
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.errors == "");
    CHECK(outcome.output.find("the picture cannot be written: the working directory is gone") != std::string::npos);
}

TEST_CASE("the wearer recentres by the panel's button") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const std::string head = "head 0 position 0 1.6 0\nhead 0.1 position 0 1.6 0\nhead 0.15 position 0.4 1.5 0.3 turn 50 0\n";
    const ViewRun run = runView(work, "recentre", kSmall + head + clickOn(panel, {placeOf("Recentre"), kBeside}),
                                "builtin:one-splat --load-first --mode mono --hide-hands");
    checkClean(run);
    CHECK(says(run, "the room now begins where the wearer stands, 1.50 m above the floor"));
    const std::size_t last = run.frames.size() - 5;
    const auto left = run.layers(last, "projection").at(0).at("views").at(0).at("pose").at("position").get<std::array<double, 3>>();
    CHECK(glm::length(glm::dvec3(left[0], left[1], left[2]) - glm::dvec3(-0.0315, 0.0, 0.0)) < 1e-5);
}

TEST_CASE("a scene that two hands tilted is levelled again") {
    const Workplace work;
    std::ofstream(work.path / "tilt.toml") << "[view]\ntilt = true\n";
    const Panel panel = startPanel(work);
    // Both hands hold the scene and roll it by some 30 degrees; then the right one clicks.
    const std::string roll =
        "rate 90\nsize 64 64\nframes none\n"
        "controller left 0 position -0.2 1.2 -0.35 turn 0 -80\ncontroller left 0.1 position -0.2 1.2 -0.35 turn 0 -80\n"
        "controller left 0.3 position -0.17 1.1 -0.35 turn 0 -80\n"
        "controller right 0 position 0.2 1.2 -0.35 turn 0 -80\ncontroller right 0.1 position 0.2 1.2 -0.35 turn 0 -80\n"
        "controller right 0.3 position 0.17 1.3 -0.35 turn 0 -80\ncontroller right 0.35 position 0.17 1.3 -0.35 turn 0 -80\n"
        "press left squeeze 0.05 0.32\npress right squeeze 0.05 0.32\n";
    const std::string scene = "builtin:one-splat --load-first --mode mono --hide-hands --config tilt.toml";
    // How much of the turn is not about the vertical, as it was saved.
    const auto tiltAfter = [&](const std::string& name, const std::string& clicks) {
        const ViewRun run = runView(work, name, roll + clicks + "at 1 exit\n", scene);
        checkClean(run);
        std::ifstream file(work.base / "config" / "binosplat" / "scenes" / "one-splat.view.toml");
        for (std::string line; std::getline(file, line);) {
            std::array<double, 4> q{};
            if (std::sscanf(line.c_str(), "scene-orientation = [%lf, %lf, %lf, %lf]", q.data(), &q[1], &q[2], &q[3]) == 4) {
                return std::hypot(q[1], q[3]);
            }
        }
        FAIL("nothing was saved");
        return 0.0;
    };
    CHECK(tiltAfter("tilted", clickAt(panel, placeOf("Save"), 0.5)) > 0.2);
    CHECK(tiltAfter("levelled", clickAt(panel, placeOf("Level"), 0.5) + clickAt(panel, placeOf("Save"), 0.7)) < 1e-6);
}

TEST_CASE("one goes from viewpoint to viewpoint by the panel and by the sticks, and back to them when they are kept") {
    const Workplace work;
    REQUIRE(work.run("scene one-splat --out a.ply").exit_code == 0);
    const std::string camera = R"("width": 8, "height": 8, "rotation": [[1,0,0],[0,1,0],[0,0,1]], "fx": 8, "fy": 8)";
    std::ofstream(work.path / "cameras.json") << R"([{"img_name": "door", "position": [0, 0, 0], )" << camera
                                              << R"(}, {"img_name": "window", "position": [0.5, 0, 0], )" << camera << "}]";
    const Panel panel = startPanel(work);
    std::ofstream(work.path / "scenes.toml") << "[view]\npanel-page = \"scenes\"\n";
    const std::string script = kSmall + clickAt(panel, placeOf("Next viewpoint", false, PanelPage::kScenes), 0.2) +
                               "press right thumbstick 0.5 0.55\npress left thumbstick 0.7 0.75\n" +
                               clickAt(panel, placeOf("Keep this one", false, PanelPage::kScenes), 0.9) + "at 1.3 exit\n";
    const ViewRun run = runView(work, "viewpoints", script, "a.ply --load-first --mode mono --hide-hands --config scenes.toml");
    checkClean(run);
    std::size_t from = 0;
    for (const char* said : {"viewpoint 1 of 2: door", "viewpoint 2 of 2: window", "viewpoint 1 of 2: door", "this viewpoint is kept"}) {
        INFO(said << " in " << run.outcome.output);
        from = run.outcome.output.find(said, from);
        REQUIRE(from != std::string::npos);
        ++from;
    }
}

TEST_CASE("a trained scene is levelled by the up of its cameras, or else of its floor") {
    const Workplace work;
    // The room of the atelier lies with its floor some 30 degrees aside in the file.
    const fs::path folder = work.path / "trained" / "point_cloud" / "iteration_30000";
    fs::create_directories(folder);
    const glm::dquat tilt = glm::angleAxis(0.5, glm::dvec3(0.0, 0.0, 1.0));
    Scene scene = loadScene("builtin:atelier", 3000);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        scene.positions[i] = glm::vec3(tilt * glm::dvec3(scene.positions[i]));
        scene.rotations[i] = glm::quat(tilt * glm::dquat(scene.rotations[i]));
    }
    scene.sh.assign(scene.size() * 3, 0.5f);
    scene.sh_degree = 0;
    writePly(scene, (folder / "point_cloud.ply").string());
    const auto upAfter = [&](const std::string& name, const fs::path& source) {
        const Panel& panel = startPanel(work);
        const ViewRun run =
            runView(work, name, kSmall + clickAt(panel, placeOf("Level"), 0.2) + clickAt(panel, placeOf("Save"), 0.4) + "at 0.7 exit\n",
                    source.string() + " --load-first --mode mono --hide-hands");
        checkClean(run);
        const auto q = savedNumbers(run, "scene-orientation").get<std::array<double, 4>>();
        return glm::dquat(q[0], q[1], q[2], q[3]) * glm::dvec3(0.0, -1.0, 0.0);
    };
    const fs::path file = folder / "point_cloud.ply";
    // Its files' y is down as in all scenes with cameras.
    const glm::dvec3 up = tilt * builtinView("builtin:atelier")->up;
    CHECK(glm::dot(upAfter("floor", file), up) > std::cos(glm::radians(2.0)));
    // These cameras were held otherwise, and they know better.
    std::ofstream(work.path / "trained" / "cameras.json")
        << R"([{"id": 0, "img_name": "a", "width": 64, "height": 64, "position": [0, 0, 0], "rotation": [[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]], "fx": 60, "fy": 60}])";
    CHECK(glm::length(upAfter("cameras", file) - glm::dvec3(-0.6, -0.8, 0.0)) < 1e-5);
    CHECK(glm::length(upAfter("output", work.path / "trained") - glm::dvec3(-0.6, -0.8, 0.0)) < 1e-5);
    // One that cannot be read is as none.
    std::ofstream(work.path / "trained" / "cameras.json") << "[{";
    CHECK(glm::dot(upAfter("broken", file), up) > std::cos(glm::radians(2.0)));
}

}  // namespace view_scenes_test
