// Facts about `binosplat view` when the headset misbehaves: it carries on or ends cleanly.
#include "tests/app/view/view_acts.h"

SUITE(view_trouble) {

const std::string kSmall = "rate 90\nsize 64 64\nframes none\n";
// If the end that the script causes never came, the limit of frames would end the run.
const std::string kOneEye = kOneSplat + " --mode mono --frames 900";

std::size_t countFramesWithLayers(const ViewRun& run, double until_s = 1e9) {
    return static_cast<std::size_t>(std::ranges::count_if(run.frames, [&](const nlohmann::json& frame) {
        return ViewRun::secondsOf(frame) < until_s && !frame.at("layers").empty();
    }));
}

TEST_CASE_FIXTURE(AtWork, "whatever becomes of session, head and hands it carries on, and ends while off") {
    // A runtime that adds Vulkan features of its own, ends any program that asks it for the mask, and has no
    // headset at first. Sessions are lost before their first frame, during it, and soon after it.
    Acts acts(
        "rate 100\nsize 64 64\nframes none\nvulkan-additions on\nvisibility-mask broken\nno-headset-for 3\n"
        "at 0 lose-session\nat 0.02 lose-session\nat 0.06 lose-session\n");
    const double shown = acts.wait(0.1).look(0.05);
    acts.at("lose-session").wait(0.15);
    const double hidden = acts.at("visible off").look(0.05);
    const double unfocused = acts.at("visible on").wait(0.03).at("focused off").look(0.05);
    acts.at("focused on").wait(0.05);
    const double unseen = acts.at("should-render off").look();
    acts.at("should-render on").wait(0.05).at("slow-images 7").wait(0.1);
    const double off = acts.at("worn off").look(0.3);
    acts.at("worn on").wait(0.15);
    const double lost = acts.at("head off").look(0.06);
    acts.at("head on").wait(0.05).head("position 0.3 1.5 0.2 turn 0 0").wait(0.05).at("head turn-only");
    const double turning = acts.look(0.01);
    acts.head("position 0.5 1.4 0 turn 20 10", 0.1);
    const double turned = acts.look(0.02);
    acts.at("head on").wait(0.05);
    const double other =
        acts.at("eye left angles -60 20 30 -50").at("eye right angles -20 60 50 -20").wait(0.02).look(0.05);
    acts.at("controller right off").wait(0.01).at("controller left off").wait(0.05);
    acts.at("controller right on").wait(0.05);
    const double end = acts.look(0.05);
    acts.at("worn off").wait(0.2);
    const ViewRun run = runClean(work, acts,
                                 "builtin:one-splat --load-first --mode shared --frames 900" +
                                     withConfig(work, "[view]\nvisibility-mask = false\n"));
    CHECK(run.says("the runtime asked for the end"));
    CHECK(these(run.lines("has no headset yet: waiting for it").size(),
                run.lines("another one begins").size()) == these(1, 4));
    for (const double seconds :
         {shown, hidden - 0.03, unseen - 0.02, off - 0.02, lost - 0.02, turning, other, end}) {
        CAPTURE(seconds);
        REQUIRE(run.layers(run.frameAt(seconds), "projection").size() == 1);
        // The scene, not the colour shown while waiting.
        CHECK(run.view(run.frameAt(seconds)).contains("depth"));
    }
    for (const auto& [seconds, state] : {std::pair(hidden + 0.03, "SYNCHRONIZED"),
                                         std::pair(unfocused + 0.03, "VISIBLE"), std::pair(end, "FOCUSED")}) {
        CHECK(run.at(seconds).at("session_state") == state);
    }
    // No picture is drawn when none is requested.
    CHECK(run.at(unseen + 0.02).at("should_render") == false);
    for (const auto& frame : run.frames) {
        CHECK((frame.at("should_render") == true || frame.at("layers").empty()));
    }
    // Nor while the headset is off.
    CHECK(run.frameAt(off + 0.29) - run.frameAt(off) < 8);
    // A head without a known pose shows nothing; if only its orientation is known, it stays where it was.
    for (std::size_t frame = run.frameAt(lost + 0.01); frame <= run.frameAt(lost + 0.05); ++frame) {
        CHECK(run.layers(frame, "projection").empty());
    }
    const auto step = [&](std::size_t from, std::size_t to) {
        return glm::length(run.viewPlace(to, 0) + run.viewPlace(to, 1) - run.viewPlace(from, 0) -
                           run.viewPlace(from, 1));
    };
    const std::size_t first = run.frameAt(turning + 0.01);
    CHECK(step(first - 2, first) < 4e-3);
    for (std::size_t frame = first + 1; frame <= run.frameAt(turned); ++frame) {
        CHECK(step(frame - 1, frame) < 2e-5);
    }
    for (const std::size_t side : {0, 1}) { CHECK(run.sizePx(run.frameAt(other), side) == glm::ivec2(64)); }
    CHECK(run.view(run.frameAt(other), 0).at("fov").at("left") < -1.047);
    CHECK(run.view(run.frameAt(other), 1).at("fov").at("up") > 0.872);
}

TEST_CASE_FIXTURE(AtWork, "a headset on the desk or unplugged is waited for, and the scene goes on") {
    const ViewRun run = runClean(
        work,
        "rate 90\nsize 256 256\nframes every 5\nvisibility-mask broken\nno-headset-for 2 after-loss\n"
        "at -1 worn off\nat -1 should-render off\nat 0.1 worn on\nat 0.2 should-render on\n"
        "at 0.5 lose-session\nat 0.8 exit\n",
        kOneEye, kValidated + " BINOSPLAT_VISIBILITY_MASK=0");
    checkOrder(
        run, {"the headset is gone: waiting for it", "the headset is back", "the runtime asked for the end"});
    // The panel says so as well, below its widgets.
    const auto pixelOf = [](const glm::dvec2& share) {
        const Pose panel = panelBefore({0.0315, 0.0, 0.0});  // for the left eye
        const glm::dvec3 at = transform(panel, {(share - 0.5) * glm::dvec2(1.0, -1.0) * kPanelMetres, 0.0});
        return glm::uvec2(128.0 * (glm::dvec2(1.0) + glm::dvec2(at.x, -at.y) / -at.z));
    };
    const auto said = [&](double seconds) {
        return partOf(run.eye(run.pictureAt(seconds), kLeft), pixelOf({0.05, 0.82}), pixelOf({0.8, 0.95}));
    };
    CHECK(said(0.3).values == said(0.4).values);
    CHECK(countPixels(said(0.4), said(0.72), std::not_equal_to{}) > 10);
    CHECK(countFramesWithLayers(run, 0.19) == 0);
    CHECK(countFramesWithLayers(run, 0.5) > 10);
    CHECK(run.layers(run.frames.size() - 4, "projection").size() == 1);
    // With the mask, the run would fail.
    CHECK(runView(work, "with", kSmall + "visibility-mask broken\nat 0.1 exit\n", kOneEye, "2>/dev/null")
              .outcome.exit_code != 0);
}

TEST_CASE("Ctrl-C ends it as the wearer would, be the headset worn, off, gone or not there yet") {
    for (const auto& [script, until] :
         {std::pair("size 64 64\n", "[ -e seen/frame_000005.png ]"),
          std::pair("frames none\nat -1 worn off\n", "[ -e seen/frames.jsonl ]"),
          std::pair("frames none\nno-headset-for 1000000 after-loss\nat 0.1 lose-session\n",
                    "grep -q 'waiting for it' said"),
          std::pair("no-headset-for 1000000\n", "grep -q 'no headset yet' said")}) {
        CAPTURE(script);
        const Workplace work;
        work.write("endless.script", script);
        const Outcome outcome = work.run(
            fmt::format(
                "view {} --mode mono --simulate endless.script --out seen > said & child=$!; until {} || ! "
                "kill -0 $child; do sleep 0.02; done; kill -INT $child; wait $child; code=$?; cat said; "
                "exit $code",
                kOneSplat, until),
            "DISPLAY= WAYLAND_DISPLAY=");
        INFO(outcome.errors);
        CHECK(outcome.exit_code == 0);
        CHECK(contains(outcome.output, " frames; "));
    }
}

TEST_CASE_FIXTURE(AtWork, "sessions lost before they show anything are given up in one line, with three") {
    std::string script = kSmall;
    for (int i = 0; i < 12; ++i) { script += fmt::format("at {} lose-session\n", 0.001 + 0.015 * i); }
    const ViewRun run = runView(work, "again", script, kOneEye, "");
    INFO(run.outcome.errors);
    CHECK(these(run.outcome.exit_code, isOneLine(run.outcome.errors)) == these(3, true));
    CHECK(contains(run.outcome.errors, "times in a row"));
}

TEST_CASE_FIXTURE(AtWork, "what only decorates and fails is said once, and a lost session is followed") {
    // The hand points at the panel, which pulses. The fifth action space is that of the gaze.
    const std::string script =
        kSmall + "controller right 0 position 0.2 1.2 -0.35 look -0.45 1.5 -0.9\nat 0.3 exit\n";
    const std::string arguments = "builtin:one-splat --load-first --mode mono --frames 200" +
                                  withConfig(work, "[view]\nrefresh-rate = 72\neye-tracking = true\n");
    const auto runFaulty = [&](const std::string& faults) {
        return runView(work, "run", script, arguments, withXrFaults("BINOSPLAT_XR_FAULT=" + faults));
    };
    const auto checkOnce = [](const ViewRun& run, const std::vector<std::string>& all) {
        for (const std::string& said : all) { CHECK_MESSAGE(run.lines(said).size() == 1, said); }
    };
    const std::string failed = " failed: XR_ERROR_RUNTIME_FAILURE; going on without ",
                      lacks = " failed: XR_ERROR_FUNCTION_UNSUPPORTED; going on without ";
    const ViewRun run = runFaulty(
        "xrCreateSession:-17:1,xrSuggestInteractionProfileBindings:-22:1,xrApplyHapticFeedback:-2,"
        "xrLocateHandJointsEXT:-2,xrGetDisplayRefreshRateFB:missing,xrRequestDisplayRefreshRateFB:missing,"
        "xrEnumerateReferenceSpaces:-2,xrCreateActionSpace:-2:1:4,xrEndFrame:-2:1:10");
    INFO(run.outcome.output);
    CHECK(these(run.outcome.errors, run.outcome.exit_code) == these("", 0));
    CHECK(run.says("the runtime asked for the end"));
    CHECK(run.view(run.frames.size() - 4).contains("depth"));
    checkOnce(
        run,
        {"xrCreateSession failed: XR_ERROR_SESSION_LOST; another one begins",
         "controllers that the OpenXR runtime rejects: khr/simple_controller (XR_ERROR_PATH_UNSUPPORTED)",
         "xrApplyHapticFeedback" + failed + "pulses", "xrLocateHandJointsEXT" + failed + "hand tracking",
         "xrGetDisplayRefreshRateFB" + lacks + "the display's refresh rate",
         "refresh-rate is 72, this headset refuses it (XR_ERROR_FUNCTION_UNSUPPORTED)",
         "xrEnumerateReferenceSpaces" + failed + "the stage's floor",
         "xrCreateActionSpace" + failed + "eye tracking",
         "xrEndFrame" + failed + "hands, rays and the vignette: it refuses a ray"});
    // The panel gets its images first, what hangs beside it none. Lines are written before the crash.
    const ViewRun crash = runFaulty(
        "xrCreateSwapchain:-2:1:1,xrCreateHandTrackerEXT:missing,xrEnumerateDisplayRefreshRatesFB:missing,"
        "xrApplyHapticFeedback:crash");
    INFO(crash.outcome.output);
    CHECK(crash.outcome.exit_code != 0);
    checkOnce(crash, {"xrCreateSwapchain" + failed + "rays, controllers and the vignette",
                      "xrCreateHandTrackerEXT" + lacks + "hand tracking",
                      "xrEnumerateDisplayRefreshRatesFB" + lacks + "a choice of refresh rates",
                      ": the room now begins where the wearer stands"});
}

TEST_CASE_FIXTURE(AtWork, "a panel or room that the runtime refuses is left out, only eyes end the program") {
    const auto runRefusing = [&](int times) {
        return runView(work, "refusing", kSmall + "passthrough on\nat 0.4 exit\n",
                       kOneEye + " --hide-hands" + withConfig(work, "[view]\npassthrough = true\n"),
                       withXrFaults(fmt::format("BINOSPLAT_XR_FAULT=xrEndFrame:-2:{}:10", times)));
    };
    const std::string refused = "xrEndFrame failed: XR_ERROR_RUNTIME_FAILURE; going on without ",
                      panel = refused + "the panel: it refuses it",
                      room = refused + "the room behind the scene: it refuses it";
    // As often as it takes: with all, with fewer rays, without any, without the panel, without the room.
    for (const int times : {3, 4, 5}) {
        CAPTURE(times);
        const ViewRun run = runRefusing(times);
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(run.outcome.exit_code == 0);
        const std::size_t last = run.frames.size() - 4;
        const bool has_panel = times == 4, has_room = times == 3;
        CHECK(these(run.says(panel), run.says(room)) == these(!has_panel, !has_room));
        CHECK(these(run.panels(last).empty(), run.layers(last, "passthrough").empty()) ==
              these(!has_panel, !has_room));
        CHECK(run.layers(last, "projection").size() == 1);
    }
    const ViewRun run = runRefusing(1000);
    CHECK(run.outcome.exit_code == 3);
    CHECK(contains(run.outcome.errors, "it refuses the eyes' pictures\n"));
}

TEST_CASE_FIXTURE(AtWork, "a lost runtime gives one line and code 3; without a stage LOCAL_FLOOR counts") {
    const std::string floor = "stage off\nhead 0 position 0.2 1.45 0.1\n";
    for (const char* time : {"0", "0.02", "0.2"}) {
        // Older validation layers do not know that space.
        const ViewRun run = runView(work, "gone", kSmall + floor + fmt::format("at {} lose-instance\n", time),
                                    kOneEye, "DISPLAY= BINOSPLAT_VALIDATION=1");
        INFO(run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors) ==
              these(3, "binosplat: the OpenXR runtime is going away\n"));
        if (std::string(time) == "0.2") {
            CHECK(run.says("the room now begins where the wearer stands, 1.45 m above the floor"));
        }
    }
    // A runtime that offers the space and does not create it does not prevent the start.
    const ViewRun refused = runView(work, "refused", kSmall + floor + "at 0.1 exit\n", kOneEye);
    CHECK(refused.outcome.exit_code == 0);
    CHECK((refused.says("the room now begins where the wearer stands\n") ||
           refused.says("1.45 m above the floor")));
}

TEST_CASE_FIXTURE(AtWork, "depth is left out where the runtime refuses it, or the config or panel says so") {
    for (const auto& [line, toml] :
         {std::pair("refuse-depth images\n", "[view]\n"), std::pair("refuse-depth layers\n", "[view]\n"),
          std::pair("", "[view]\nsubmit-depth = false\n")}) {
        INFO(line, toml);
        const ViewRun run = runClean(work, kSmall + line + "at 0.1 exit\n", kOneEye + withConfig(work, toml));
        CHECK(countFramesWithLayers(run) > 5);
        for (std::size_t frame = 0; frame < run.frames.size(); ++frame) {
            for (const auto& layer : run.layers(frame, "projection")) {
                CHECK_FALSE(layer.at("views").at(0).contains("depth"));
            }
        }
        CHECK(run.says("going on without depth") == contains(line, "layers"));
    }
    Acts acts(kSmall);
    const double given = acts.look();
    const double kept = acts.click(onMethod("Give the headset depth", true)).look();
    const double given_again = acts.click(onMethod("Give the headset depth", true)).look();
    const ViewRun switched = runClean(work, acts, kOneEye + withConfig(work, kMethodPage));
    for (const double seconds : {given, kept, given_again}) {
        CHECK(switched.view(switched.frameAt(seconds)).contains("depth") == (seconds != kept));
    }
}

TEST_CASE_FIXTURE(AtWork, "while a scene loads frames go on, the room behind it, and one may leave") {
    const ViewRun run =
        runClean(work,
                 "rate 90\nsize 32 32\nframes from 3 to 3\nblend-modes alpha-blend opaque\n"
                 "room-colour 0.2 0.9 0.4\nat 0.2 exit\n",
                 "builtin:atelier --hide-hands" + withConfig(work, "[view]\npassthrough = true\n"));
    // The background and the panel's progress were there from the first visible frame on.
    CHECK(countFramesWithLayers(run) >= 15);
    CHECK(run.frames.size() < 40);
    CHECK(colourOf(run.eye(3, kLeft), 31, 0).g == doctest::Approx(0.9).epsilon(0.01));
    // The same before the first picture.
    CHECK(runClean(work, kSmall + "at 0 exit\n", kOneEye).frames.size() < 20);
}

TEST_CASE_FIXTURE(AtWork, "whoever leaves while a large scene loads does not wait for the rest of it") {
    // Identical discs, in a file with no blocks on the disk.
    constexpr std::uintmax_t kSplats = 4'000'000;
    std::string header = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", kSplats);
    const std::vector<std::string> names =
        wordsIn("x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 rot_0 rot_1 rot_2 rot_3");
    for (const std::string& name : names) { header += "property float " + name + "\n"; }
    std::ofstream(work.path / "large.ply") << header << "end_header\n";
    const std::uintmax_t bytes = kSplats * sizeof(float) * names.size();
    fs::resize_file(work.path / "large.ply", fs::file_size(work.path / "large.ply") + bytes);
    std::ofstream(work.path / "leave.script") << kSmall << "at 0 exit\n";
    const Outcome outcome = work.run("view large.ply --hide-panel --simulate leave.script",
                                     withFaults("BINOSPLAT_FAULT_READ=read"));
    CHECK(outcome.exit_code == 0);
    std::uintmax_t read = 0;
    std::ifstream(work.path / "read") >> read;
    CHECK(read == between(0, bytes / 2));
}

TEST_CASE_FIXTURE(AtWork, "what the lenses hide is not rendered, and nothing else changes") {
    // 13 x 13 tiles, whose corners lie outside the lens; then wider on one side, with another mask.
    std::vector<double> looks;
    double shared = 0.0;
    const auto runMasked = [&](const std::string& mask) {
        Acts acts("rate 50\nsize 200 200\nframes every 5\nvisibility-mask " + mask + "\n");
        looks = {acts.look()};
        for (const char* mode : {"shared", "predicted"}) {
            acts.press("right b").click(onMethod(mode)).press("right b");
            if (std::string(mode) == "shared") {
                shared = acts.look();
                acts.at("eye left angles -45 60 45 -45").wait(0.05);
            }
            looks.push_back(acts.look());
        }
        return runClean(work, acts, kWall + " --hide-panel --mode mono" + withConfig(work, kMethodPage));
    };
    const ViewRun without = runMasked("off"), with = runMasked("on");
    CHECK_FALSE(without.says("the lenses hide"));
    // In a picture for either eye, both lenses hide no tile.
    const std::vector<std::string> said = with.lines(": the lenses hide ");
    REQUIRE_FALSE(said.empty());
    CHECK(std::stod(said[0].substr(6)) == between(50.0 * looks[0] + 5, 50.0 * shared));
    // Each mask touches its view's edges.
    for (const std::string& line : {said.front(), said.back()}) {
        CHECK(contains(line, ": the lenses hide 21 and 21 of 169 tiles"));
    }
    const auto isBlack = [](const glm::vec3&, const glm::vec3& after) { return after == glm::vec3(0); };
    for (std::size_t look = 0; look < looks.size(); ++look) {
        const std::size_t frame = with.pictureAt(looks[look]);
        for (const int side : {kLeft, kRight}) {
            INFO("look ", look, ", side ", side);
            const Image a = without.eye(frame, side), b = with.eye(frame, side);
            const auto isOther = [](const glm::vec3& before, const glm::vec3& after) {
                return after != glm::vec3(0) && after != before;
            };
            if (look == 0) {
                CHECK(a.values == b.values);
                continue;
            }
            CHECK(countPixels(a, b, isBlack) > 20 * 120);
            // In the eye that is reprojected, other tiles may be rendered.
            if (look == 1 || side == kLeft) { CHECK(countPixels(a, b, isOther) == 0); }
        }
    }
}

TEST_CASE_FIXTURE(AtWork, "events that the runtime loses are made up for") {
    Acts acts("rate 50\nsize 200 200\nframes none\nvisibility-mask on\n");
    acts.wait(0.2).at("eye left angles -45 60 45 -45").wait(0.3);
    const auto lines = [&](const std::string& lost, const std::string& script, const std::string& words) {
        const ViewRun run =
            runView(work, "run", script, kWall + " --hide-panel --mode shared", withXrFaults(lost));
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(run.outcome.exit_code == 0);
        CHECK(run.lines("the OpenXR runtime lost ").size() == (lost.empty() ? 0 : 1));
        return run.lines(words);
    };
    // The mask for the new angles (XrEventDataVisibilityMaskChangedKHR): the old one would hide other tiles.
    for (const std::string lost : {"", "BINOSPLAT_XR_LOSE=1000031001"}) {
        const std::vector<std::string> told = lines(lost, acts, ": the lenses hide ");
        REQUIRE_FALSE(told.empty());
        CHECK(contains(told.back(), " 21 and 21 of 169 tiles"));
    }
    // Another rate, which the frames' periods alone would not show: it is asked for once more.
    CHECK(lines("BINOSPLAT_XR_LOSE=1000101000 BINOSPLAT_XR_FAULT=xrGetDisplayRefreshRateFB:-2:1:1",
                kSmall + "at 0.3 rate 90.5\nat 0.6 exit\n", "going on without the display's refresh rate")
              .size() == 1);
    // That somebody puts the headset on, which then shows in its movement.
    CHECK(lines("BINOSPLAT_XR_LOSE=1000470000:1",
                kSmall + "head 0 position 0 0.8 0\nhead 0.5 position 0 0.8 0\nhead 0.7 position 1 1.6 0 turn "
                         "40 0\nat 0 present off\nat 0.6 present on\nat 2 exit\n",
                "the room now begins where the wearer stands")
              .size() == 2);
}

}  // SUITE(view_trouble)
