// Facts about operations in frames that may wait, as counted by two layers (tests/faults/waits.h): the frames
// of a running viewer do none of them.
#include "tests/app/view/view_quiet.h"
#include "app/view/scenes/kernels_ahead.h"
#include "tests/engine/stream/moving_frames.h"
#ifdef BINOSPLAT_SOG
#include "tests/engine/stream/split_scene.h"
#endif
#ifdef BINOSPLAT_WEB_TESTS
#include "tests/engine/files/web/web_server.h"
#endif

SUITE(view_quiet) {

// A snap turn, a step, the panel away and back again, a hand that points at it; then the session is lost.
const std::string kStay =
    "rate 45\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\nhead 4 position 0.2 1.6 -0.1 turn 15 0\n"
    "axis right thumbstick 1.2 0 0\naxis right thumbstick 1.21 1 0\naxis right thumbstick 1.3 1 0\naxis "
    "right thumbstick 1.31 0 0\n"
    "axis left thumbstick 1.6 0 0\naxis left thumbstick 1.61 0 1\naxis left thumbstick 1.9 0 1\naxis left "
    "thumbstick 1.91 0 0\n"
    "press left y 2.2 2.25\npress left y 2.5 2.55\ncontroller right 2.7 position 0.2 1.2 -0.35\n"
    "controller right 2.8 position 0.2 1.2 -0.35 look -0.45 1.5 -0.9\nat 3.2 lose-session\nat 3.6 exit\n";
// In which kernels and frames of another method are made, on a thread.
constexpr double kMethodSeconds = 5.0;

// What frames still create or wait for between two times, until it is fixed.
struct Known {
    double begin_s, end_s;
    const char* kinds;
};
constexpr Known kKnown[]{
    // Images are created once the eyes' angles are known.
    {0.0, 1.0, "buffer fence-of-this-frame memory swapchain"},
    {3.2, 9.0, "buffer fence-of-this-frame memory queue swapchain"},
};

TEST_CASE(
    "no frame of a running viewer waits or makes anything after the first second, until its session is "
    "lost") {
    for (const std::string mode : {"temporal", "predicted"}) {
        CAPTURE(mode);
        const Workplace work;
        const ViewRun run =
            runView(work, "stay", kStay, "builtin:slanted-wall --load-first --mode " + mode, kWatched);
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
        std::map<const Known*, std::set<std::string>> found;
        const std::vector<std::set<std::string>> waits = waitsOf(work);
        for (std::size_t frame = 0; frame < waits.size(); ++frame) {
            const double time_s = static_cast<double>(frame) / 45.0;
            const Known* const known = std::ranges::find_if(
                kKnown, [&](const Known& one) { return time_s >= one.begin_s && time_s < one.end_s; });
            CHECK_MESSAGE((known != std::end(kKnown) || waits[frame].empty()), frame, ": ",
                          listed(waits[frame]));
            found[known].insert(waits[frame].begin(), waits[frame].end());
        }
        CHECK(waits.size() == run.frames.size());
        CHECK(run.panels(waits.size() * 2 / 3).empty());
        // All of it must occur, or it must be removed from the list.
        for (const Known& known : kKnown) { CHECK(listed(found[&known]) == known.kinds); }
    }
}

TEST_CASE("the cut to the other scene of a comparison, and back, waits for nothing") {
    // In the first second everything is made, for both.
    const std::string script =
        "rate 45\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\npress right a 1.4 1.8\npress right a 2 "
        "2.4\nat 3 exit\n";
    for (const std::string mode : {"temporal", "predicted", "shared"}) {
        CAPTURE(mode);
        const Workplace work;
        const ViewRun run =
            runView(work, "cut", script,
                    "builtin:slanted-wall --compare builtin:fence --load-first --hide-hands --mode " + mode,
                    kWatched);
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
        CHECK(run.lines("shows builtin:fence").size() == 2);
        std::ifstream file(work.path / "waits.txt");
        std::size_t frames = 0;
        for (std::string line; std::getline(file, line); ++frames) {
            CHECK_MESSAGE((frames < 45 || line == std::to_string(frames)), line);
        }
        CHECK(frames == run.frames.size());
    }
}

// A wall with viewpoints: one beside the start, one that looks the other way.
std::string wallWithViewpoints(const Workplace& work) {
    REQUIRE(work.run("scene slanted-wall --out wall.ply").exit_code == 0);
    work.write("wall.viewpoints.json", R"({"viewpoints": [
        {"name": "beside", "eye": [0.6, 0, -0.4], "look": [0, 0, 3], "up": [0, -1, 0]},
        {"name": "away", "eye": [0, 0, 0], "look": [0, 0, -3], "up": [0, -1, 0]}]})");
    return "wall.ply";
}

TEST_CASE(
    "nor does one while pictures are taken, a message appears, and the wearer jumps, turns and comes back") {
    for (const std::string mode : {"temporal", "predicted", "shared"}) {
        CAPTURE(mode);
        const Workplace work;
        picturesInto(work);
        const std::string scene = wallWithViewpoints(work);
        Acts acts("rate 45\nsize 64 64\nframes none\n");
        acts.wait(1.0)
            .click(placeOf("Picture"))
            .click(placeOf("Picture"))
            .press("left y")
            .move("controller right", kRightDown);
        // From one viewpoint to the next.
        for (int round = 0; round < 3; ++round) { acts.press("right thumbstick").wait(0.2); }
        for (const double aside : {1.0, -1.0}) { acts.push("right thumbstick", {aside, 0.0}, 0.1).wait(0.2); }
        acts.press("left y").click(placeOf("Picture")).wait(0.2);
        const ViewRun run = runView(work, "jumps", acts.script(),
                                    scene + " --load-first --hide-hands --mode " + mode, kWatched);
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
        checkOrder(run, {"viewpoint 1 of 2: beside", "viewpoint 2 of 2: away", "viewpoint 1 of 2: beside"});
        CHECK(run.lines("picture " + work.path.string() + "/pictures/wall-20").size() == 3);
        CHECK_FALSE(run.says("frames shown incomplete"));
        checkQuiet(work);
    }
}

TEST_CASE("a scene is exchanged for another one, and a picture of it kept, without a wait") {
    for (const std::string mode : {"temporal", "predicted", "shared"}) {
        CAPTURE(mode);
        const Workplace work;
        std::filesystem::create_directory(work.path / "scenes");
        for (const char* const scene : {"slanted-wall", "one-splat"}) {
            REQUIRE(work.run(fmt::format("scene {0} --out scenes/{0}.ply", scene)).exit_code == 0);
        }
        Acts acts("rate 45\nsize 64 64\nframes none\nvisibility-mask on\n");
        // Frames may be late, and the scene must have been seen in thirty of them.
        acts.wait(4.0)
            .point(placeOfScene("Next scene", (work.path / "scenes").string()))
            .wait(0.25)
            .press("right trigger", 0.3)
            .wait(2.0);
        const ViewRun run = runView(work, "goes", acts.script(),
                                    "scenes/slanted-wall.ply --load-first --hide-hands --mode " + mode +
                                        withConfig(work, "[view]\npanel-page = \"scenes\"\n"),
                                    kWatched + " SIMULATED_OPENXR_CLOCK=real");
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
        checkOrder(run, {"shows scenes/slanted-wall.ply", "shows scenes/one-splat.ply"});
        CHECK_FALSE(run.says("frames shown incomplete"));
        checkQuiet(work, 20);
        std::size_t pictures = 0;
        for (const auto& file :
             std::filesystem::recursive_directory_iterator(work.base / "config" / "binosplat")) {
            pictures += file.path().extension() == ".png" ? 1 : 0;
        }
        CHECK(pictures > 0);
    }
}

TEST_CASE("a scene to compare with comes, and goes, without a wait") {
    const Workplace work;
    std::filesystem::create_directory(work.path / "scenes");
    for (const char* const scene : {"slanted-wall", "one-splat"}) {
        REQUIRE(work.run(fmt::format("scene {0} --out scenes/{0}.ply", scene)).exit_code == 0);
    }
    const std::string folder = (work.path / "scenes").string();
    Acts acts("rate 45\nsize 64 64\nframes none\n");
    acts.wait(2.0);
    for (const char* const widget : {"Compare", "one-splat.ply"}) {
        acts.point(placeOfScene(widget, folder)).wait(0.25).press("right trigger", 0.3);
    }
    acts.wait(2.0).hold("right a", 0.5).wait(1.0);
    acts.point(placeOfScene("Compare", folder)).wait(0.25).press("right trigger", 0.3).wait(0.5);
    const ViewRun run = runView(work, "with", acts.script(),
                                "scenes/slanted-wall.ply --load-first --hide-hands --mode temporal" +
                                    withConfig(work, "[view]\npanel-page = \"scenes\"\n"),
                                kWatched + " SIMULATED_OPENXR_CLOCK=real");
    INFO(run.outcome.output << run.outcome.errors);
    CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
    checkOrder(run, {"to compare with", "compares scenes/slanted-wall.ply with", "shows " + folder,
                     "shows scenes/slanted-wall.ply", "is no longer compared with"});
    checkQuiet(work, 20);
}

TEST_CASE("lists that are too short for what comes into view grow without a wait, and a few frames lack it") {
    for (const std::string mode : {"temporal", "shared"}) {
        CAPTURE(mode);
        const Workplace work;
        REQUIRE(work.run("scene atelier --splats 80000 --out many.ply").exit_code == 0);
        // From afar, where all of them are in a few tiles; first the other way.
        const std::string script =
            "rate 45\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\nhead 1.5 position 0 1.6 0\n"
            "head 1.51 position 0 1.6 0 turn 180 0\nat 2.4 exit\n";
        const ViewRun run = runView(
            work, "fill", script,
            "many.ply --load-first --hide-hands --hide-panel --eye 0,0,-30 --look 0,0,-60 --up 0,-1,0 "
            "--mode " +
                mode,
            kWatched);
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
        const std::vector<std::string> incomplete = run.lines("frames shown incomplete because a list was ");
        REQUIRE_FALSE(incomplete.empty());
        // Not to the end.
        const auto frameOf = [](const std::string& line) {
            return std::stoul(line.substr(line.find_first_of("0123456789")));
        };
        CHECK(frameOf(incomplete.back()) + 20 < run.frames.size());
        checkQuiet(work);
    }
}

TEST_CASE("a scene that moves, or whose parts come and go, is shown without a wait") {
    const Workplace work;
    std::vector<std::string> scenes{"slide --scene-rate 15"};
    writeSliding((work.path / "slide").string(), 12, 2000);
#ifdef BINOSPLAT_SOG
    splitScene(makeBuiltin("builtin:atelier", 16'000), (work.path / "split").string(),
               {.leaf_splats = 1000, .levels = 4, .chunk_splats = 4000});
    scenes.emplace_back("split --splat-budget 9000");
#endif
    for (const std::string& scene : scenes) {
        for (const std::string mode : {"temporal", "shared"}) {
            CAPTURE(scene);
            CAPTURE(mode);
            const ViewRun run = runView(
                work, "parts",
                "rate 45\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\nhead 1.5 position 0 1.6 0\n"
                "head 2 position 0 1.6 0 turn 90 0\nat 4 exit\n",
                scene + " --load-first --hide-hands --mode " + mode, kWatched);
            INFO(run.outcome.output << run.outcome.errors);
            CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
            checkQuiet(work);
        }
    }
}

#ifdef BINOSPLAT_WEB_TESTS
TEST_CASE("while there is no scene frames wait for nothing, nor does the first that shows one") {
    for (const std::string mode : {"temporal", "predicted", "shared"}) {
        CAPTURE(mode);
        const Workplace work;
        REQUIRE(work.run("scene slanted-wall --out wall.ply").exit_code == 0);
        // The scene comes once two seconds of frames were shown.
        std::atomic<bool> is_over = false;
        WebServer server([&, bytes = work.bytesOf("wall.ply")](const WebRequest&) {
            while (!is_over && std::ranges::count(textIn(work.path / "waits.txt"), '\n') < 90) {
                std::this_thread::yield();
            }
            return answer("200 OK", "ETag: \"1\"\r\n", bytes);
        });
        const std::string script = "rate 45\nsize 64 64\nframes none\nvisibility-mask on\n";
        const ViewRun run =
            runView(work, "late", script, server.at("/wall.ply") + " --hide-hands --frames 60 --mode " + mode,
                    kWatched +
                        " SIMULATED_OPENXR_CLOCK=real no_proxy=127.0.0.1 "
                        "XDG_CACHE_HOME=\"$PWD/../caches\"");
        is_over = true;
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
        CHECK(run.says("shows " + server.at("/wall.ply")));
        CHECK_FALSE(run.says("frames shown incomplete"));
        checkQuiet(work);
    }
}
#endif

TEST_CASE("the governor's steps, to other resolutions and back, wait for nothing") {
    // From frame 110 on they take too long, from 130 on three periods, and from 200 on a third of one.
    const std::string script =
        "rate 90\nsize 100 100\nframes none\nvisibility-mask on\nhead 0 position 0 1.6 0\n"
        "head 1 position 0 1.6 0\nhead 6 position 0.4 1.6 0.2 turn 40 0\nat 6 exit\n";
    for (const std::string mode : {"temporal", "alternate", "predicted", "shared", "two-pass", "mono"}) {
        for (const std::string axes : {"view", "stay"}) {
            if (axes == "stay" && mode != "temporal") { continue; }
            CAPTURE(mode);
            CAPTURE(axes);
            const Workplace work;
            const ViewRun run =
                runView(work, "steps", script,
                        fmt::format("builtin:slanted-wall --load-first --hide-hands --axes {} --mode {}{}",
                                    axes, mode, withConfig(work, "[view]\nquality = \"fast\"\n")),
                        kWatched + " BINOSPLAT_FAULT_LOAD=0:9.7,110:14,130:33,200:4");
            INFO(run.outcome.output << run.outcome.errors);
            CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
            CHECK_FALSE(run.says("frames shown incomplete"));
            int before = 0, downs = 0, ups = 0;
            for (std::size_t frame = 90; frame < run.frames.size(); ++frame) {
                // The last frames show nothing.
                if (run.layers(frame, "projection").empty()) { continue; }
                const int now = run.width(frame);
                downs += before > 0 && now < before ? 1 : 0;
                ups += before > 0 && now > before ? 1 : 0;
                before = now;
            }
            CHECK(these(downs > 0, ups > 0) == these(true, true));
            checkQuiet(work, 90);
        }
    }
}

TEST_CASE("another method is drawn once its frames are made, and no frame waits for them") {
    const Workplace work;
    Acts acts("rate 45\nsize 64 64\nframes none\nvisibility-mask on\n");
    acts.wait(kMethodSeconds);
    const std::vector<std::string> methods{"temporal", "alternate", "predicted",
                                           "two-pass", "mono",      "shared"};
    for (const std::string& method : methods) {
        acts.point(onMethod(method)).wait(0.25).press("right trigger", 0.3).wait(kMethodSeconds);
    }
    const ViewRun run =
        runView(work, "methods", acts.script(),
                "builtin:slanted-wall --hide-hands --mode shared" + withConfig(work, kMethodPage),
                kWatched + " SIMULATED_OPENXR_CLOCK=real");
    INFO(run.outcome.output << run.outcome.errors);
    CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
    // On a busy machine some may be chosen before the one before is ready.
    CHECK(run.lines(" is ready").size() >= methods.size() / 2);
    CHECK_FALSE(run.says("frames shown incomplete"));
    checkQuiet(work);
}

TEST_CASE("the wearer's own resolution, and axes that stay or do not, come without a wait") {
    const std::string alone = "--mode ", compared = "--compare builtin:fence --mode ";
    for (const std::string& mode :
         {alone + "temporal", alone + "predicted", alone + "shared", compared + "temporal"}) {
        CAPTURE(mode);
        const Workplace work;
        Acts acts("rate 45\nsize 100 100\nframes none\nvisibility-mask on\n");
        acts.wait(kMethodSeconds);
        for (const char* const widget : {"resolution", "Axes stay", "Axes stay"}) {
            acts.point(onMethod(widget)).wait(0.25).press("right trigger", 0.3).wait(kMethodSeconds);
            if (mode.starts_with(compared)) { acts.hold("right a", 0.5).wait(0.5); }
        }
        const ViewRun run = runView(work, "resolution", acts.script(),
                                    "builtin:slanted-wall --hide-hands --axes view " + mode +
                                        withConfig(work, kMethodPage + "resolution-scale = 0.5\n"),
                                    kWatched + " SIMULATED_OPENXR_CLOCK=real");
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
        CHECK_FALSE(run.says("frames shown incomplete"));
        std::set<int> widths;
        for (std::size_t frame = 30; frame < run.frames.size(); ++frame) {
            if (run.layers(frame, "projection").empty()) { continue; }
            widths.insert(run.view(frame).at("rect").at(2).get<int>());
        }
        // Small, large, and large with room around; the governor may choose others.
        CHECK(widths.size() > 2);
        checkQuiet(work);
    }
}

TEST_CASE("frames of another resolution are made ahead even where a limit makes their images as large") {
    FramesAhead frames;
    frames.images_px = {64, 64};
    FramesAhead larger = frames;
    CHECK(frames.hasFramesOf(larger));
    larger.resolution_scale = 2.0;
    CHECK_FALSE(frames.hasFramesOf(larger));
    CHECK(FramesAhead{}.hasFramesOf(larger));
}

TEST_CASE("new letters come without a wait") {
    const Workplace work;
    REQUIRE(work.run("scene one-splat --out '\u05d7\u05d3\u05e8.ply'").exit_code == 0);
    const std::string script = "rate 45\nsize 64 64\nframes none\nat 4 exit\n";
    const ViewRun run = runView(work, "letters", script, "'\u05d7\u05d3\u05e8.ply' --load-first",
                                kWatched + " SIMULATED_OPENXR_CLOCK=real");
    INFO(run.outcome.output << run.outcome.errors);
    CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
    checkQuiet(work, 20);
}

TEST_CASE("what is drawn is where the eyes are by the last that the runtime said") {
    const Workplace work;
    const std::string script = "rate 45\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\nat 1 exit\n";
    const ViewRun run =
        runView(work, "late", script, "builtin:one-splat --load-first --mode predicted --axes view",
                kWatched + " BINOSPLAT_XR_EARLY=0.01");
    INFO(run.outcome.output << run.outcome.errors);
    REQUIRE(run.frames.size() > 10);
    const std::size_t frame = run.frames.size() / 2;
    const nlohmann::json layer = run.layers(frame, "projection").at(0);
    const LoggedPose room = poseOf(layer.at("stage_from_space"));
    const glm::dvec3 drawn = room.position + room.orientation * run.viewPlace(frame, kLeft);
    CHECK(drawn.y == doctest::Approx(run.loggedEye(frame, kLeft).position.y).epsilon(1e-5));
}

}  // SUITE(view_quiet)
