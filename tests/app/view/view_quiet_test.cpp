// Facts about operations that may wait, as two layers count them (tests/faults/waits.h): frames do none of
// them.
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

const std::string kBlind = "rate 45\nsize 64 64\nframes none\n", kMasked = "visibility-mask on\n",
                  kStill = kBlind + "head 0 position 0 1.6 0\n", kRealClock = "SIMULATED_OPENXR_CLOCK=real",
                  kWallIn = "builtin:slanted-wall --load-first --mode ";
// A snap turn, a step, the panel away and back again, a hand that points at it; then the session is lost.
const std::string kStay =
    kStill +
    "head 4 position 0.2 1.6 -0.1 turn 15 0\naxis right thumbstick 1.2 0 0\naxis right thumbstick 1.21 1 0\n"
    "axis right thumbstick 1.3 1 0\naxis right thumbstick 1.31 0 0\naxis left thumbstick 1.6 0 0\n"
    "axis left thumbstick 1.61 0 1\naxis left thumbstick 1.9 0 1\naxis left thumbstick 1.91 0 0\n"
    "press left y 2.2 2.25\npress left y 2.5 2.55\ncontroller right 2.7 position 0.2 1.2 -0.35\n"
    "controller right 2.8 position 0.2 1.2 -0.35 look -0.45 1.5 -0.9\nat 3.2 lose-session\n"
    "head 4.4 position 0.2 1.6 -0.1 turn 15 0\nhead 5 position 0 1.6 0 turn 0 0\nat 5.5 exit\n";
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
    // A second after the first frame of the next session.
    {3.2, 4.25, "buffer fence-of-this-frame memory queue swapchain"},
};

using Modes = std::vector<std::string>;
void eachMode(const Modes& modes, const std::function<void(const Workplace&, const std::string& mode)>& run) {
    for (const std::string& mode : modes) {
        CAPTURE(mode);
        run(Workplace(), mode);
    }
}
const Modes kThreeModes{"temporal", "predicted", "shared"};

// Frames may be late.
void clickSlowly(Acts& acts, const glm::dvec2& at) { acts.point(at).wait(0.25).press("right trigger", 0.3); }

// The pixels of the left eye's pictures, in frames that show something.
std::vector<int> widthsOf(const ViewRun& run, std::size_t first_frame) {
    std::vector<int> widths;
    for (std::size_t frame = first_frame; frame < run.frames.size(); ++frame) {
        if (run.layers(frame, "projection").empty()) { continue; }
        widths.push_back(run.view(frame).at("rect").at(2).get<int>());
    }
    return widths;
}

TEST_CASE("after the first second, also of a new session, no frame waits for or makes anything") {
    eachMode({"temporal", "predicted"}, [](const Workplace& work, const std::string& mode) {
        const ViewRun run = runWatched(work, kStay, kWallIn + mode);
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
        CHECK(run.panels(run.frameAt(2.45)).empty());
        // All of it must occur, or it must be removed from the list.
        for (const Known& known : kKnown) { CHECK(listed(found[&known]) == known.kinds); }
    });
}

TEST_CASE("the cut to the other scene of a comparison, and back, waits for nothing") {
    // In the first second everything is made, for both.
    eachMode(kThreeModes, [](const Workplace& work, const std::string& mode) {
        const ViewRun run = runQuiet(work, kStill + "press right a 1.4 1.8\npress right a 2 2.4\nat 3 exit\n",
                                     kWallIn + mode + " --compare builtin:fence");
        CHECK(run.lines("shows builtin:fence").size() == 2);
    });
}

TEST_CASE("nor does one while pictures are taken, messages come, and the wearer jumps, turns and returns") {
    eachMode(kThreeModes, [](const Workplace& work, const std::string& mode) {
        picturesInto(work);
        // One viewpoint is beside the start, one looks the other way.
        work.go("scene slanted-wall --out wall.ply");
        work.write("wall.viewpoints.json", R"({"viewpoints": [
            {"name": "beside", "eye": [0.6, 0, -0.4], "look": [0, 0, 3], "up": [0, -1, 0]},
            {"name": "away", "eye": [0, 0, 0], "look": [0, 0, -3], "up": [0, -1, 0]}]})");
        Acts acts(kBlind);
        acts.wait(1.0).click(placeOf("Picture")).click(placeOf("Picture"));
        acts.press("left y").right(kRightDown);
        // From one viewpoint to the next.
        for (int round = 0; round < 3; ++round) { acts.press("right thumbstick").wait(0.2); }
        for (const double aside : {1.0, -1.0}) { acts.push("right thumbstick", {aside, 0.0}, 0.1).wait(0.2); }
        acts.press("left y").click(placeOf("Picture")).wait(0.2);
        const ViewRun run = runQuiet(work, acts, "wall.ply --load-first --mode " + mode);
        checkOrder(run, {"viewpoint 1 of 2: beside", "viewpoint 2 of 2: away", "viewpoint 1 of 2: beside"});
        CHECK(run.lines("picture " + work.path.string() + "/pictures/wall-20").size() == 3);
    });
}

// Two scenes in a folder, the latter with new letters in its name, and a broken one in between.
const std::string kFirst = "slanted-wall.ply", kOther = "\u05d7\u05d3\u05e8.ply", kBroken = "torn.ply";
fs::path makeScenes(const Workplace& work) {
    fs::create_directory(work.path / "scenes");
    work.go("scene slanted-wall --out scenes/" + kFirst);
    work.go("scene one-splat --out scenes/" + kOther);
    work.write("scenes/" + kBroken, "ply\nnonsense\n");
    return work.path / "scenes";
}
ViewRun runScenes(const Workplace& work, const Acts& acts, const std::string& mode) {
    return runQuiet(work, acts,
                    "scenes/" + kFirst + " --load-first --mode " + mode + withConfig(work, kScenesPage),
                    kRealClock, 20);
}

TEST_CASE("a scene is exchanged, and a picture of it kept, without a wait; a broken one gives a message") {
    eachMode(kThreeModes, [](const Workplace& work, const std::string& mode) {
        const fs::path scenes = makeScenes(work);
        Acts acts(kBlind + kMasked);
        // The scene must have been seen in thirty frames.
        acts.wait(4.0);
        for (const std::string& widget : {kBroken, std::string("Next scene"), kFirst}) {
            clickSlowly(acts, placeOfScene(widget, scenes.string()));
            acts.wait(1.0);
        }
        const ViewRun run = runScenes(work, acts.wait(1.0), mode);
        const std::string first = (scenes / kFirst).string(), next = (scenes / kOther).string();
        checkOrder(run, {"shows scenes/" + kFirst, (scenes / kBroken).string() + ":", "shows " + next,
                         "shows " + first});
        checkAlwaysShown(run);
        const fs::path kept = work.base / "config" / "binosplat";
        CHECK(textIn(kept / "recent-scenes.txt").starts_with(first + "\n" + next + "\n"));
        CHECK_FALSE(contains(textIn(kept / "recent-scenes.txt"), kBroken));
        CHECK(std::ranges::any_of(fs::recursive_directory_iterator(kept),
                                  [](const auto& file) { return file.path().extension() == ".png"; }));
    });
}

TEST_CASE_FIXTURE(AtWork, "the scene chosen next is compared with, and goes, without a wait") {
    const fs::path scenes = makeScenes(work);
    const std::string other = (scenes / kOther).string(), compare = "Compare", show = "Other";
    Acts acts(kBlind);
    acts.wait(2.0);
    for (const std::string& widget : {compare, kBroken, compare, kOther, show, show, compare}) {
        clickSlowly(acts, placeOfScene(widget, scenes.string()));
        acts.wait(widget == kOther ? 2.0 : 0.5);
    }
    const ViewRun run = runScenes(work, acts, "temporal");
    checkOrder(run, {"to compare with scenes/" + kFirst, kBroken + ":", "to compare with scenes/" + kFirst,
                     "compares scenes/" + kFirst + " with " + other, "shows " + other,
                     "shows scenes/" + kFirst, other + " is no longer compared with"});
}

TEST_CASE("lists that are too short for what comes into view grow without a wait, and a few frames lack it") {
    eachMode({"temporal", "shared"}, [](const Workplace& work, const std::string& mode) {
        work.go("scene atelier --splats 80000 --out many.ply");
        // From afar, where all of them are in a few tiles; first the other way.
        const ViewRun run = runWatched(
            work, kStill + "head 1.5 position 0 1.6 0\nhead 1.51 position 0 1.6 0 turn 180 0\nat 2.4 exit\n",
            "many.ply --load-first --hide-hands --hide-panel --eye 0,0,-30 --look 0,0,-60 --up 0,-1,0 "
            "--mode " +
                mode);
        const std::vector<std::string> incomplete = run.lines("frames shown incomplete because a list was ");
        REQUIRE_FALSE(incomplete.empty());
        // Not to the end.
        const std::string last = incomplete.back();
        CHECK(std::stoul(last.substr(last.find_first_of("0123456789"))) + 20 < run.frames.size());
        checkQuiet(work);
    });
}

const std::string kTurnsAway =
    "rate 45\nsize 64 64\nframes from 2 to 2\nhead 0 position 0 1.6 0\nhead 1.5 position 0 1.6 0\n"
    "head 2 position 0 1.6 0 turn 90 0\nat 4 exit\n";

TEST_CASE("a scene that moves is shown without a wait") {
    eachMode({"temporal", "shared"}, [](const Workplace& work, const std::string& mode) {
        writeSliding((work.path / "slide").string(), 12, 2000);
        runQuiet(work, kTurnsAway, "slide --scene-rate 15 --load-first --mode " + mode);
    });
}

#ifdef BINOSPLAT_SOG
TEST_CASE("a streamed scene is there at once, becomes finer without a wait, and says what is missing") {
    eachMode({"temporal", "shared"}, [](const Workplace& work, const std::string& mode) {
        splitScene(makeBuiltin("builtin:atelier", 16'000), (work.path / "split").string(),
                   {.leaf_splats = 1000, .levels = 4, .chunk_splats = 4000});
        fs::remove(work.path / "split" / "0_2.sog");
        const ViewRun run =
            runQuiet(work, kTurnsAway, "split --splat-budget 9000 --load-first --hide-panel --mode " + mode,
                     kRealClock, 20);
        checkOrder(run, {"shows split", "everything in view is loaded: "});
        CHECK(run.says("17 levels of leaves, 0.0"));
        CHECK(run.says(" s; frames that waited for it: 0"));
        CHECK(run.says("0_2.sog is not there, expected a chunk of the scene; what is there stays"));
        checkAlwaysShown(run);
        const Image third = run.eye(2, kLeft);
        const auto [least, most] = std::ranges::minmax(third.values);
        CHECK(most - least > 0.2f);
    });
}
#endif

#ifdef BINOSPLAT_WEB_TESTS
TEST_CASE("while there is no scene frames wait for nothing, nor does the first that shows one") {
    eachMode(kThreeModes, [](const Workplace& work, const std::string& mode) {
        work.go("scene slanted-wall --out wall.ply");
        // The scene comes once two seconds of frames were shown.
        std::atomic<bool> is_over = false;
        WebServer server([&, bytes = work.bytesOf("wall.ply")](const WebRequest&) {
            while (!is_over && std::ranges::count(textIn(work.path / "waits.txt"), '\n') < 90) {
                std::this_thread::yield();
            }
            return answer("200 OK", "ETag: \"1\"\r\n", bytes);
        });
        const ViewRun run =
            runQuiet(work, kBlind + kMasked, server.at("/wall.ply") + " --frames 60 --mode " + mode,
                     kRealClock + " no_proxy=127.0.0.1 XDG_CACHE_HOME=\"$PWD/../caches\"");
        is_over = true;
        CHECK(run.says("shows " + server.at("/wall.ply")));
    });
}
#endif

TEST_CASE("the governor's steps, to other resolutions and back, wait for nothing") {
    // From frame 110 on they take too long, from 130 on three periods, and from 200 on a third of one.
    const std::string script =
        "rate 90\nsize 100 100\nframes none\nvisibility-mask on\nhead 0 position 0 1.6 0\n"
        "head 1 position 0 1.6 0\nhead 6 position 0.4 1.6 0.2 turn 40 0\n"
        // The wearer turns the wheel of the lenses' distance.
        "at 5 eye left angles -46 44 45 -45\nat 5 eye right angles -44 46 45 -45\nat 6 exit\n";
    eachMode({"temporal --axes stay", "temporal", "alternate", "predicted", "shared", "two-pass", "mono"},
             [&](const Workplace& work, const std::string& mode) {
                 const std::string axes = contains(mode, "--axes") ? "" : " --axes view";
                 const ViewRun run = runQuiet(
                     work, script, kWallIn + mode + axes + withConfig(work, "[view]\nquality = \"fast\"\n"),
                     "BINOSPLAT_FAULT_LOAD=0:9.7,110:14,130:33,200:4", 90);
                 const std::vector<int> widths = widthsOf(run, 90);
                 CHECK(std::ranges::adjacent_find(widths, std::greater()) != widths.end());
                 CHECK(std::ranges::adjacent_find(widths, std::less()) != widths.end());
             });
}

TEST_CASE_FIXTURE(AtWork, "another method is drawn once its frames are made, and no frame waits for them") {
    Acts acts(kBlind + kMasked);
    acts.wait(kMethodSeconds);
    const Modes methods{"temporal", "alternate", "predicted", "two-pass", "mono", "shared"};
    for (const std::string& method : methods) {
        clickSlowly(acts, onMethod(method));
        acts.wait(kMethodSeconds);
    }
    const ViewRun run = runQuiet(
        work, acts, "builtin:slanted-wall --mode shared" + withConfig(work, kMethodPage), kRealClock);
    // On a busy machine some may be chosen before the one before is ready.
    CHECK(run.lines(" is ready").size() >= methods.size() / 2);
}

TEST_CASE("the wearer's own resolution, and axes that stay or do not, come without a wait") {
    const std::string compared = "temporal --compare builtin:fence";
    eachMode({"temporal", "predicted", "shared", compared},
             [&](const Workplace& work, const std::string& mode) {
                 Acts acts("rate 45\nsize 100 100\nframes none\n" + kMasked);
                 acts.wait(kMethodSeconds);
                 for (const char* const widget : {"resolution", "Axes stay", "Axes stay"}) {
                     clickSlowly(acts, onMethod(widget));
                     acts.wait(kMethodSeconds);
                     if (mode == compared) { acts.hold("right a", 0.5).wait(0.5); }
                 }
                 const ViewRun run = runQuiet(work, acts,
                                              "builtin:slanted-wall --axes view --mode " + mode +
                                                  withConfig(work, kMethodPage + "resolution-scale = 0.5\n"),
                                              kRealClock);
                 const std::vector<int> all = widthsOf(run, 30);
                 // Small, large, and large with room around; the governor may choose others.
                 CHECK(std::set<int>(all.begin(), all.end()).size() > 2);
             });
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

TEST_CASE_FIXTURE(AtWork, "what is drawn is where the eyes are by the last that the runtime said") {
    const ViewRun run =
        runWatched(work, kStill + "at 1 exit\n",
                   "builtin:one-splat --load-first --mode predicted --axes view", "BINOSPLAT_XR_EARLY=0.01");
    REQUIRE(run.frames.size() > 10);
    const std::size_t frame = run.frames.size() / 2;
    const nlohmann::json layer = run.layers(frame, "projection").at(0);
    const glm::dvec3 drawn = transform(poseOf(layer.at("stage_from_space")), run.viewPlace(frame, kLeft));
    CHECK(drawn.y == doctest::Approx(run.loggedEye(frame, kLeft).position.y).epsilon(1e-5));
}

}  // SUITE(view_quiet)
