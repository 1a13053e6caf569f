// Facts about `binosplat view` when the headset misbehaves: it carries on or ends cleanly, within the frames of the script.
#include "engine/geometry.h"
#include "tests/app/view/view_runs.h"

#include <doctest/doctest.h>

TEST_SUITE_BEGIN("view_trouble");

namespace view_trouble_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::string kSmall = "rate 90\nsize 64 64\nframes none\n";

const std::string kWithHands = "builtin:one-splat --load-first --mode mono", kOneEye = kWithHands + " --hide-hands",
                  kBothEyes = "builtin:one-splat --load-first --mode shared --hide-hands";

ViewRun runTrouble(const Workplace& work, const std::string& lines, const std::string& arguments = kOneEye) {
    CAPTURE(lines);
    // Without the end that the script brings about, the frames would.
    const ViewRun run = runView(work, "trouble", kSmall + lines, arguments + " --frames 200");
    checkClean(run);
    CHECK(run.frames.size() < 100);
    return run;
}

std::size_t countFramesWithLayers(const ViewRun& run) {
    std::size_t count = 0;
    for (const auto& frame : run.frames) { count += frame.at("layers").empty() ? 0 : 1; }
    return count;
}

}  // namespace

TEST_CASE("a lost session is followed by another one, whenever it comes, with the scene as it was") {
    const Workplace work;
    for (const char* time : {"0", "0.01", "0.02", "0.2"}) {
        const ViewRun run = runTrouble(work, fmt::format("at {} lose-session\nat 0.4 exit\n", time));
        CHECK(run.outcome.output.find("another one begins") != std::string::npos);
        CHECK(run.outcome.output.find("the runtime asked for the end") != std::string::npos);
        const auto shown = run.layers(run.frames.size() - 4, "projection");
        REQUIRE(shown.size() == 1);
        CHECK(shown.at(0).at("views").at(0).contains("depth"));  // the scene's, not the colour of waiting
        CHECK(countFramesWithLayers(run) > 15);
    }
}

TEST_CASE("sessions that are lost again and again before they show anything are given up in one line, with three") {
    const Workplace work;
    std::string script = kSmall;
    for (int i = 0; i < 12; ++i) { script += fmt::format("at {} lose-session\n", 0.001 + 0.015 * i); }
    const ViewRun run = runView(work, "again", script, kOneEye + " --frames 200", "");
    CHECK(run.outcome.exit_code == 3);
    CHECK(run.outcome.errors.find("times in a row") != std::string::npos);
    CHECK(std::count(run.outcome.errors.begin(), run.outcome.errors.end(), '\n') == 1);
}

TEST_CASE("what only decorates and fails is said once and done without, and a first session that is lost is followed by another one") {
    const Workplace work;
    std::ofstream(work.path / "wishes.toml") << "[view]\nrefresh-rate = 72\neye-tracking = true\n";
    // The hand points at the panel, which pulses; the fifth action space is the gaze's, the tenth frame has layers.
    const std::string script = kSmall + "controller right 0 position 0.2 1.2 -0.35 look -0.45 1.5 -0.9\nat 0.3 exit\n";
    const std::string arguments = kWithHands + " --frames 200 --config wishes.toml";
    const auto runFaulty = [&](const std::string& name, const std::string& faults) {
        return runView(work, name, script, arguments,
                       "DISPLAY= WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1 XR_ENABLE_API_LAYERS=XR_APILAYER_BINOSPLAT_faults "
                       "XR_API_LAYER_PATH='" BINOSPLAT_FAULT_LAYER "/openxr' BINOSPLAT_XR_FAULT=" +
                           faults);
    };
    const ViewRun run = runFaulty("decorations",
                                  "xrCreateSession:-17:1,xrSuggestInteractionProfileBindings:-22:1,xrApplyHapticFeedback:-2,"
                                  "xrLocateHandJointsEXT:-2,xrGetDisplayRefreshRateFB:missing,xrRequestDisplayRefreshRateFB:missing,"
                                  "xrEnumerateReferenceSpaces:-2,xrCreateActionSpace:-2:1:4,xrEndFrame:-2:1:10");
    INFO(run.outcome.output);
    CHECK(run.outcome.errors == "");
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.output.find("the runtime asked for the end") != std::string::npos);
    CHECK(run.layers(run.frames.size() - 4, "projection").at(0).at("views").at(0).contains("depth"));
    const auto checkOnce = [](const ViewRun& in, const std::string& sentence) {
        CAPTURE(sentence);
        const std::size_t first = in.outcome.output.find(sentence);
        CHECK(first != std::string::npos);
        CHECK(in.outcome.output.find(sentence, first + 1) == std::string::npos);
    };
    checkOnce(run, "xrCreateSession failed: XR_ERROR_SESSION_LOST; another one begins\n");
    checkOnce(run, "controllers that the OpenXR runtime does not take: khr/simple_controller (XR_ERROR_PATH_UNSUPPORTED)\n");
    checkOnce(run, "xrApplyHapticFeedback failed: XR_ERROR_RUNTIME_FAILURE; on without pulses\n");
    checkOnce(run, "xrLocateHandJointsEXT failed: XR_ERROR_RUNTIME_FAILURE; on without hand tracking\n");
    checkOnce(run, "xrGetDisplayRefreshRateFB failed: XR_ERROR_FUNCTION_UNSUPPORTED; on without the display's refresh rate\n");
    checkOnce(run, "refresh-rate is 72, this headset refuses it (XR_ERROR_FUNCTION_UNSUPPORTED)\n");
    checkOnce(run, "xrEnumerateReferenceSpaces failed: XR_ERROR_RUNTIME_FAILURE; on without the stage's floor\n");
    checkOnce(run, "xrCreateActionSpace failed: XR_ERROR_RUNTIME_FAILURE; on without eye tracking\n");
    checkOnce(run, "xrEndFrame failed: XR_ERROR_RUNTIME_FAILURE; on without hands, rays and the vignette\n");
    // The panel is the first to get its images; what hangs beside it gets none. And of a program that crashes each line was written.
    const ViewRun crash = runFaulty("crash",
                                    "xrCreateSwapchain:-2:1:1,xrCreateHandTrackerEXT:missing,xrEnumerateDisplayRefreshRatesFB:missing,"
                                    "xrApplyHapticFeedback:crash");
    INFO(crash.outcome.output);
    CHECK(crash.outcome.exit_code != 0);
    checkOnce(crash, "xrCreateSwapchain failed: XR_ERROR_RUNTIME_FAILURE; on without rays, controllers and the vignette\n");
    checkOnce(crash, "xrCreateHandTrackerEXT failed: XR_ERROR_FUNCTION_UNSUPPORTED; on without hand tracking\n");
    checkOnce(crash, "xrEnumerateDisplayRefreshRatesFB failed: XR_ERROR_FUNCTION_UNSUPPORTED; on without a choice of refresh rates\n");
    checkOnce(crash, ": the room now begins where the wearer stands");
}

TEST_CASE("a lost runtime gives one line and exit code 3") {
    const Workplace work;
    for (const char* time : {"0", "0.02", "0.2"}) {
        const ViewRun run = runView(work, "gone", kSmall + fmt::format("at {} lose-instance\n", time), kOneEye + " --frames 200",
                                    "DISPLAY= BINOSPLAT_VALIDATION=1");
        INFO(run.outcome.errors);
        CHECK(run.outcome.exit_code == 3);
        CHECK(run.outcome.errors == "binosplat: the OpenXR runtime is going away\n");
    }
}

TEST_CASE("a runtime may add Vulkan features of its own to the device") {
    const Workplace work;
    runTrouble(work, "vulkan-additions on\nat 0.1 exit\n");
}

TEST_CASE("a runtime that ends whoever asks it for the mask is bearable without") {
    const Workplace work;
    std::ofstream(work.path / "no-mask.toml") << "[view]\nvisibility-mask = false\n";
    const std::string lines = "visibility-mask broken\nat 0.1 exit\n";
    runTrouble(work, lines, kOneEye + " --config no-mask.toml");
    checkClean(runView(work, "environment", kSmall + lines, kOneEye + " --frames 200", kValidated + " BINOSPLAT_VISIBILITY_MASK=0"));
    // Which is what it would be with it.
    CHECK(runView(work, "with", kSmall + lines, kOneEye + " --frames 200", "2>/dev/null").outcome.exit_code != 0);
}

TEST_CASE("a headset that is not there yet is waited for, with one line") {
    const Workplace work;
    const ViewRun run = runTrouble(work, "no-headset-for 3\nat 0.1 exit\n");
    const std::size_t first = run.outcome.output.find("has no headset yet: waiting for it");
    CHECK(first != std::string::npos);
    CHECK(run.outcome.output.find("has no headset yet", first + 1) == std::string::npos);
    // Ctrl-C ends the wait.
    std::ofstream(work.path / "never.script") << "no-headset-for 1000000\n";
    const Outcome outcome = work.run(
        "view builtin:slanted-wall --simulate never.script --frames 5 > said & child=$!; "
        "until grep -q 'no headset yet' said || ! kill -0 $child; do sleep 0.02; done; kill -INT $child; wait $child");
    CHECK(outcome.exit_code == 0);
}

TEST_CASE("a headset that is unplugged is waited for, and the scene goes on with it") {
    const Workplace work;
    const ViewRun run = runTrouble(work, "no-headset-for 2 after-loss\nat 0.1 lose-session\nat 0.4 exit\n");
    CHECK(run.outcome.output.find("the headset is gone: waiting for it") != std::string::npos);
    CHECK(run.outcome.output.find("the headset is there again") != std::string::npos);
    CHECK(run.layers(run.frames.size() - 4, "projection").size() == 1);
    // Ctrl-C ends this wait, too.
    std::ofstream(work.path / "gone.script") << kSmall << "no-headset-for 1000000 after-loss\nat 0.1 lose-session\n";
    const Outcome outcome = work.run(
        "view builtin:slanted-wall --simulate gone.script --frames 2000 --out gone > said & child=$!; "
        "until grep -q 'waiting for it' said || ! kill -0 $child; do sleep 0.02; done; kill -INT $child; wait $child; cat said");
    CHECK(outcome.exit_code == 0);
}

TEST_CASE("depth that the runtime offers and refuses is left out, once it is known") {
    const Workplace work;
    for (const char* what : {"images", "layers"}) {
        CAPTURE(what);
        const ViewRun run = runTrouble(work, fmt::format("refuse-depth {}\nat 0.1 exit\n", what));
        CHECK(countFramesWithLayers(run) > 5);
        for (std::size_t frame = 0; frame < run.frames.size(); ++frame) {
            for (const auto& layer : run.layers(frame, "projection")) { CHECK_FALSE(layer.at("views").at(0).contains("depth")); }
        }
        const bool said = run.outcome.output.find("on without depth") != std::string::npos;
        CHECK(said == (std::string(what) == "layers"));
    }
}

TEST_CASE("the headset is taken off and put on again") {
    const Workplace work;
    const ViewRun run = runTrouble(work, "at 0.1 worn off\nat 0.4 worn on\nat 0.6 exit\n");
    CHECK(run.frames.back().at("display_time_ns").get<double>() > 0.55e9);
    // Nothing was drawn meanwhile, and then again.
    CHECK(run.frames.size() < 50);
    CHECK(run.layers(run.frames.size() - 4, "projection").size() == 1);
    const ViewRun desk = runTrouble(work, "at -1 worn off\nat 0.3 worn on\nat 0.4 exit\n");
    CHECK(countFramesWithLayers(desk) > 3);
}

TEST_CASE("whoever leaves while the headset is off need not put it on") {
    const Workplace work;
    const ViewRun run = runTrouble(work, "at 0.1 worn off\nat 0.3 exit\n");
    CHECK(run.outcome.output.find("the runtime asked for the end") != std::string::npos);
    std::ofstream(work.path / "desk.script") << kSmall << "at -1 worn off\n";
    const Outcome outcome = work.run(
        "view builtin:slanted-wall --simulate desk.script --out seen & child=$!; "
        "until [ -e seen/frames.jsonl ] || ! kill -0 $child; do sleep 0.02; done; kill -INT $child; wait $child");
    CHECK(outcome.exit_code == 0);
}

TEST_CASE("a lost head shows nothing, a head of which only the turn is known stays where it was") {
    const Workplace work;
    const ViewRun run = runTrouble(work,
                                   "head 0 position 0.3 1.5 0.2\nhead 0.1 position 0.3 1.5 0.2\nhead 0.3 position 0.5 1.4 0 turn 20 10\n"
                                   "at 0.12 head off\nat 0.18 head on\nat 0.22 head turn-only\nat 0.32 head on\nat 0.4 exit\n",
                                   kBothEyes);
    const auto headOf = [&](std::size_t frame) {
        const auto views = run.layers(frame, "projection").at(0).at("views");
        const auto left = views.at(0).at("pose").at("position").get<std::array<double, 3>>();
        const auto right = views.at(1).at("pose").at("position").get<std::array<double, 3>>();
        return glm::dvec3(left[0] + right[0], left[1] + right[1], left[2] + right[2]) * 0.5;
    };
    for (std::size_t frame = 0; frame < run.frames.size(); ++frame) {
        const double time_s = run.frames[frame].at("display_time_ns").get<double>() * 1e-9 - 1.0;
        CAPTURE(time_s);
        if (time_s > 0.125 && time_s < 0.175) { CHECK(run.layers(frame, "projection").empty()); }
        if (time_s > 0.235 && time_s < 0.315) { CHECK(glm::length(headOf(frame) - headOf(frame - 1)) < 1e-5); }
        if (time_s > 0.225 && time_s < 0.235) { CHECK(glm::length(headOf(frame) - headOf(frame - 1)) < 2e-3); }
    }
}

TEST_CASE("an exit request before the first picture, and while the scene still loads, is obeyed") {
    const Workplace work;
    runTrouble(work, "at 0 exit\n");
    runTrouble(work, "at 0.05 exit\n", "builtin:atelier");
}

TEST_CASE("whoever leaves while a large scene loads does not wait for the rest of it") {
    const Workplace work;
    // Discs that are all alike, in a file of which no block is stored.
    constexpr std::uintmax_t kSplats = 4'000'000;
    std::string header = "ply\nformat binary_little_endian 1.0\n" + fmt::format("element vertex {}\n", kSplats);
    const char* const names[]{"x",       "y",       "z",     "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                              "scale_0", "scale_1", "rot_0", "rot_1",  "rot_2",  "rot_3"};
    for (const char* name : names) { header += fmt::format("property float {}\n", name); }
    std::ofstream(work.path / "large.ply") << header << "end_header\n";
    const std::uintmax_t bytes = kSplats * sizeof(float) * std::size(names);
    std::filesystem::resize_file(work.path / "large.ply", std::filesystem::file_size(work.path / "large.ply") + bytes);
    std::ofstream(work.path / "leave.script") << kSmall << "at 0 exit\n";
    const Outcome outcome = work.run("view large.ply --hide-panel --simulate leave.script",
                                     kValidated + " VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
                                                  "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT_READ=read");
    CHECK(outcome.exit_code == 0);
    std::uintmax_t read = 0;
    std::ifstream(work.path / "read") >> read;
    CHECK(read > 0);
    CHECK(read < bytes / 2);
}

TEST_CASE("a scene that loads does not keep frames waiting") {
    const Workplace work;
    const ViewRun run = runTrouble(work, "at 0.2 exit\n", "builtin:atelier");
    // The background and the panel's progress were there from the first visible frame on.
    CHECK(countFramesWithLayers(run) >= 15);
}

TEST_CASE("no picture is drawn when none is wanted") {
    const Workplace work;
    const ViewRun run = runTrouble(work, "at 0.1 should-render off\nat 0.2 should-render on\nat 0.3 exit\n");
    for (const auto& frame : run.frames) { CHECK((frame.at("should_render") == true || frame.at("layers").empty())); }
    CHECK(countFramesWithLayers(run) > 10);
    // The first visible frame may already be such a one.
    CHECK(countFramesWithLayers(runTrouble(work, "at -1 should-render off\nat 0.1 exit\n")) == 0);
}

TEST_CASE("slow images are waited for") {
    const Workplace work;
    const ViewRun run = runTrouble(work, "at 0.05 slow-images 7\nat 0.2 exit\n");
    CHECK(countFramesWithLayers(run) > 10);
}

TEST_CASE("frusta may change between frames") {
    const Workplace work;
    const ViewRun run =
        runTrouble(work, "at 0.1 eye left angles -60 20 30 -50\nat 0.15 eye right angles -20 60 50 -20\nat 0.25 exit\n", kBothEyes);
    const nlohmann::json views = run.layers(run.frames.size() - 3, "projection").at(0).at("views");
    CHECK(views.at(0).at("fov").at("left").get<double>() == doctest::Approx(-1.0471975512));
    CHECK(views.at(1).at("fov").at("up").get<double>() == doctest::Approx(0.8726646260));
}

TEST_CASE("it is hidden, loses the input, and comes back") {
    const Workplace work;
    const ViewRun run = runTrouble(work, "at 0.1 visible off\nat 0.15 visible on\nat 0.2 focused off\nat 0.25 focused on\nat 0.35 exit\n");
    CHECK(countFramesWithLayers(run) > 15);
    CHECK(run.frames.at(run.frames.size() - 3).at("session_state") == "FOCUSED");
}

TEST_CASE("what the lenses hide is not rendered, and nothing else changes") {
    const Workplace work;
    // 13 x 13 tiles of which the corners lie outside the lens; wider on one side from 0.12 s on, with another mask.
    const std::string script = "rate 90\nsize 200 200\nframes every 12\n", end = "at 0.12 eye left angles -45 60 45 -45\nat 0.18 exit\n";
    for (const std::string mode : {"shared", "predicted", "mono"}) {
        CAPTURE(mode);
        const std::string arguments = "builtin:slanted-wall --load-first --hide-panel --hide-hands --mode " + mode;
        const ViewRun without = runView(work, "without-" + mode, script + end, arguments);
        const ViewRun with = runView(work, "with-" + mode, script + "visibility-mask on\n" + end, arguments);
        checkClean(with);
        CHECK(without.outcome.output.find("the lenses hide") == std::string::npos);
        const std::string& output = with.outcome.output;
        const std::size_t first = output.find(": the lenses hide 21 and 21 of 169 tiles");
        // Seen with either eye, one picture has no tile that both lenses hide.
        CHECK((first == std::string::npos) == (mode == "mono"));
        CHECK((output.find(": the lenses hide ", first + 1) == std::string::npos) == (mode == "mono"));
        for (const int side : {kLeft, kRight}) {
            const Image a = without.eye(12, side), b = with.eye(12, side);
            std::size_t black = 0, other = 0;
            for (std::size_t i = 0; i < a.pixelCount(); ++i) {
                const float* before = &a.values[i * static_cast<std::size_t>(a.channels)];
                const float* after = &b.values[i * static_cast<std::size_t>(b.channels)];
                const bool is_black = after[0] == 0.0f && after[1] == 0.0f && after[2] == 0.0f;
                black += is_black ? 1 : 0;
                other += !is_black && !std::equal(before, before + 3, after) ? 1 : 0;
            }
            if (mode == "mono") {
                CHECK(a.values == b.values);
                continue;
            }
            CHECK(black > 20 * 120);
            // Made from the other eye, another choice of tiles is rendered again.
            if (mode != "predicted" || side == kLeft) { CHECK(other == 0); }
        }
    }
}

TEST_CASE("lost controllers, a visibility mask and missing extensions are no trouble") {
    const Workplace work;
    runTrouble(work,
               "visibility-mask on\nat 0.05 controller right off\nat 0.06 controller left off\nat 0.1 controller right on\nat 0.15 exit\n",
               kWithHands);
    runTrouble(work, "extension XR_KHR_visibility_mask off\nextension XR_KHR_composition_layer_depth off\nat 0.1 exit\n");
}

TEST_CASE("a runtime without the Vulkan extension is refused in one line") {
    const Workplace work;
    const ViewRun run = runView(work, "refused", kSmall + "extension XR_KHR_vulkan_enable2 off\n", "builtin:slanted-wall", "");
    CHECK(run.outcome.exit_code == 3);
    CHECK(run.outcome.errors.find("XR_KHR_vulkan_enable2") != std::string::npos);
    CHECK(std::count(run.outcome.errors.begin(), run.outcome.errors.end(), '\n') == 1);
}

TEST_CASE("a script that the simulated headset does not take is bad input, and named") {
    const Workplace work;
    std::ofstream(work.path / "broken.script") << "size 64 64\nwalk somewhere\n";
    const Outcome outcome = work.run("view builtin:slanted-wall --frames 3 --simulate broken.script");
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.errors.find("broken.script, see docs/simulated_script.md") != std::string::npos);
    CHECK(outcome.errors.find("start one (Monado") == std::string::npos);
}

TEST_CASE("a folder whose files would be replaced is bad input, and they stay") {
    const Workplace work;
    std::filesystem::create_directories(work.path / "mine");
    std::ofstream(work.path / "mine" / "frame_000000.png") << "holiday";
    const Outcome outcome = work.run("view builtin:slanted-wall --frames 3 --simulate --out mine");
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.errors.find("mine/frame_000000.png: not what an earlier run left here, must be moved elsewhere\n") != std::string::npos);
    CHECK(outcome.errors.find("--out: the simulated headset does not begin with mine") != std::string::npos);
    CHECK(std::filesystem::file_size(work.path / "mine" / "frame_000000.png") == 7);
    CHECK_FALSE(std::filesystem::exists(work.path / "mine" / "frames.jsonl"));
}

}  // namespace view_trouble_test
