// Facts about `binosplat view`, driven through the standard OpenXR loader by scripts of the simulated headset.
#include "engine/geometry.h"
#include "engine/picture/metrics.h"
#include "tests/app/view/light_fence.h"
#include "tests/app/view/view_runs.h"

#include <doctest/doctest.h>

#include <regex>

TEST_SUITE_BEGIN("view");

namespace view_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// 90 frames a second; the session shows its first frame a hundredth of a second after its clock began.
const std::string kSmall = "rate 90\nsize 192 192\n";
const std::string kScene = "fence.ply --load-first";
// Where nobody looks at the picture.
const std::string kBlind = "rate 90\nsize 64 64\nframes none\n", kWall = "builtin:slanted-wall --load-first --hide-hands --mode ";

// An asymmetric, canted headset.
const char* const kHeadset =
    "name = \"Test\"\nsource = \"made up\"\nsize = \"192x176\"\ncanting_deg = 7.0\neye_distance_m = 0.066\n"
    "[left]\nleft = -48.0\nright = 36.0\nup = 40.0\ndown = -44.0\n"
    "[right]\nleft = -36.0\nright = 48.0\nup = 40.0\ndown = -44.0\n";

std::string numbers(const glm::dvec3& v) { return fmt::format("{:.9f},{:.9f},{:.9f}", v.x, v.y, v.z); }

// Both eyes of a frame against what `binosplat render` makes of the same poses and angles.
void checkAgrees(const Workplace& work, const ViewRun& run, std::size_t frame, const std::string& render_arguments) {
    const Outcome rendered = work.run("render fence.ply --out expected --headset headset.toml " + render_arguments);
    INFO(rendered.errors);
    REQUIRE(rendered.exit_code == 0);
    for (const int side : {kLeft, kRight}) {
        const Image expected = readPicture(work.path / "expected" / (side == kLeft ? "left.png" : "right.png"));
        const double psnr_db = compare(run.eye(frame, side), expected).psnrDb();
        CAPTURE(side);
        CHECK(psnr_db > 50.0);
        // Which it would not for the other eye.
        CHECK(compare(run.eye(frame, 1 - side), expected).psnrDb() < 30.0);
    }
}

}  // namespace

TEST_CASE("the viewer runs until the runtime asks for the end") {
    const Workplace work;
    const ViewRun run = runView(work, "run", kBlind + "at 0.3 exit\n", kWall + "mono");
    checkClean(run);
    CHECK(run.outcome.output.find("the runtime asked for the end") != std::string::npos);
    REQUIRE(run.frames.size() >= 25);
    bool focused = false;
    for (const auto& frame : run.frames) { focused = focused || frame.at("session_state") == "FOCUSED"; }
    CHECK(focused);
    CHECK(run.layers(20, "projection").size() == 1);
    CHECK(run.layers(20, "quad").size() >= 1);
}

TEST_CASE("it stops after --frames") {
    const Workplace work;
    const ViewRun run = runView(work, "run", kBlind, kWall + "mono --frames 12");
    checkClean(run);
    CHECK(run.frames.size() >= 12);
    CHECK(run.frames.size() <= 16);  // STOPPING takes a few
}

TEST_CASE("without a runtime it exits with three and one line that says what was looked for and what to try") {
    const Workplace work;
    const Outcome outcome = work.run("view builtin:fence", "XR_RUNTIME_JSON=/nonexistent/runtime.json");
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 3);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK(outcome.errors.find("/nonexistent/runtime.json") != std::string::npos);
    CHECK(outcome.errors.find("--simulate") != std::string::npos);
    CHECK(work.isEmpty());
}

TEST_CASE("bad input is known by its exit code") {
    const Workplace work;
    CHECK(work.run("view builtin:fence --simulate missing.script").exit_code == 1);
    CHECK(work.run("view builtin:fence --out x").exit_code == 2);
    std::ofstream(work.path / "bad.toml") << "[view]\nresolution-scale = 9\n";
    CHECK(work.run("view builtin:fence --simulate --frames 3 --config bad.toml").errors.find("bad.toml:2") != std::string::npos);
    const ViewRun missing = runView(work, "missing", kSmall + "at 1 exit\n", "nowhere.ply");
    CHECK(missing.outcome.exit_code == 1);
    CHECK(missing.outcome.errors.find("nowhere.ply") != std::string::npos);
}

TEST_CASE("the wearer sees what render makes of the same poses and angles") {
    const Workplace work;
    std::ofstream(work.path / "headset.toml") << kHeadset;
    writeLightFence(work.path / "fence.ply");
    // From (0.05, -0.1, 0.2) of the scene; later a step, a turn of the head and a tilt, in OpenXR's axes.
    const std::string start = "--eye 0.05,-0.1,0.2 --look 0.05,-0.1,3 --up 0,-1,0";
    const std::string script =
        "headset headset.toml\nframes every 10\nhead 0 position 0 1.6 0\nhead 0.2 position 0 1.6 0\n"
        "head 0.3 position 0.12 1.52 -0.25 rotation 0.08 -0.15 0.06 0.98\nat 0.36 exit\n";
    for (const std::string mode : {"two-pass", "predicted"}) {
        CAPTURE(mode);
        const std::string stereo = fmt::format(" --mode {} --dominant right", mode);
        const ViewRun run = runView(work, mode, script, kScene + " --hide-panel --hide-hands " + start + stereo);
        checkClean(run);
        checkAgrees(work, run, 10, start + stereo);
        const glm::dquat head = glm::normalize(glm::dquat(0.98, 0.08, -0.15, 0.06));
        const auto fromXr = [](const glm::dvec3& v) { return glm::dvec3(v.x, -v.y, -v.z); };
        const glm::dvec3 eye = glm::dvec3(0.05, -0.1, 0.2) + fromXr({0.12, -0.08, -0.25});
        const glm::dvec3 forward = fromXr(head * glm::dvec3(0, 0, -1)), up = fromXr(head * glm::dvec3(0, 1, 0));
        checkAgrees(work, run, 30, fmt::format("--eye {} --look {} --up {}", numbers(eye), numbers(eye + forward), numbers(up)) + stereo);
    }
}

TEST_CASE("two runs with the virtual clock write the same files") {
    const Workplace work;
    writeLightFence(work.path / "fence.ply");
    const std::string script = kSmall + "head 0 position 0 1.6 0\nhead 0.2 position 0.1 1.6 -0.1 turn 10 5\nframes every 3\nat 0.25 exit\n";
    const ViewRun first = runView(work, "first", script, kScene + " --hide-panel --hide-hands");
    const ViewRun second = runView(work, "second", script, kScene + " --hide-panel --hide-hands");
    checkClean(first);
    CHECK(first.frames.size() > 15);
    CHECK(std::system(("diff -r '" + first.out.string() + "' '" + second.out.string() + "' >/dev/null").c_str()) == 0);
}

TEST_CASE("depth goes along in every mode, if the runtime takes it") {
    const Workplace work;
    const auto depths = [&](const std::string& name, const std::string& script, const std::string& mode) {
        const ViewRun run = runView(work, name, kBlind + script + "at 0.1 exit\n", kWall + mode);
        checkClean(run);
        int found = 0;
        const nlohmann::json scene = run.layers(run.frames.size() - 3, "projection").at(0);
        for (const auto& view : scene.at("views")) { found += view.contains("depth") ? 1 : 0; }
        return found;
    };
    CHECK(depths("both", "", "shared") == 2);
    CHECK(depths("mono", "", "mono") == 2);
    CHECK(depths("made", "", "predicted") == 2);
    CHECK(depths("moved", "", "reproject") == 2);
    CHECK(depths("refused", "extension XR_KHR_composition_layer_depth off\n", "shared") == 0);
}

TEST_CASE("Ctrl-C ends it as the wearer would") {
    const Workplace work;
    std::ofstream(work.path / "rest.script") << kSmall;
    // An endless script; the signal comes as soon as frames are written.
    const Outcome outcome = work.run(
        "view builtin:slanted-wall --load-first --mode mono --simulate rest.script --out seen & child=$!; "
        "until [ -e seen/frame_000005.png ] || ! kill -0 $child; do :; done; kill -INT $child; wait $child");
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.output.find("the runtime asked for the end") != std::string::npos);
}

}  // namespace view_test
