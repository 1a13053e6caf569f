// Facts about the viewer's panel and controls: a ray points, the trigger clicks, sticks and grips move, as a script's hands do it.
#include "engine/geometry.h"
#include "engine/picture/metrics.h"
#include "tests/light_fence.h"
#include "tests/panel_sketch.h"
#include "tests/unchanged_shaders.h"
#include "tests/view_panel.h"
#include "xr/simulated/extensions.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

TEST_SUITE_BEGIN("view_overlay");

using namespace binosplat;
using namespace binosplat::test;

namespace {

// The left hand points at the floor.
const std::string kLeftHand = "controller left 0 position -0.2 1.2 -0.35 turn 0 -80\n";
const std::string kSmall = "rate 45\nsize 160 160\nframes every 2\n" + kLeftHand,
                  kStill = "rate 90\nsize 160 160\nframes every 8\n" + kLeftHand;
// Where nobody looks at what the headset shows; dense where it counts within which frame something happens.
const std::string kBlind = "rate 45\nsize 64 64\nframes none\n" + kLeftHand, kDense = "rate 90\nsize 64 64\nframes none\n" + kLeftHand;
// Few splats where any picture will do; bars with holes between them where it is looked at.
const std::string kWall = "builtin:slanted-wall --load-first --hide-hands", kScene = kWall + " --mode mono",
                  kFence = "fence.ply --load-first --hide-hands";

// Where the panel hangs at the start.
const Panel& startPanel(const Workplace& work) {
    static const Panel panel = panelOf(runView(work, "look", kDense + "at 0.1 exit\n", kScene), 8);
    return panel;
}

// Pose and tangents of an eye in the log, in STAGE and OpenXR's axes.
struct LoggedEye {
    glm::dvec3 position;
    glm::dquat orientation;
    double left, right, up, down;
};
LoggedEye loggedEye(const nlohmann::json& frame, std::size_t side) {
    const nlohmann::json& eye = frame.at("eyes").at(side);
    const auto p = eye.at("pose").at("position").get<std::array<double, 3>>();
    const auto q = eye.at("pose").at("orientation").get<std::array<double, 4>>();
    const auto tangent = [&](const char* name) { return std::tan(eye.at("fov").at(name).get<double>()); };
    return {{p[0], p[1], p[2]}, {q[3], q[0], q[1], q[2]}, tangent("left"), tangent("right"), tangent("up"), tangent("down")};
}

// Makes what lies under the frame's panels black: all pixels of the box about the corners of each, and two more.
void maskPanels(Image& picture, const ViewRun& run, std::size_t frame, std::size_t side) {
    const LoggedEye eye = loggedEye(run.frames.at(frame), side);
    const glm::dvec2 size(picture.size_px);
    for (const nlohmann::json& quad : run.layers(frame, "quad")) {
        const auto p = quad.at("pose").at("position").get<std::array<double, 3>>();
        const auto q = quad.at("pose").at("orientation").get<std::array<double, 4>>();
        const auto extent = quad.at("size").get<std::array<double, 2>>();
        glm::dvec2 low = size, high(0.0);
        for (const glm::dvec2& corner : {glm::dvec2(-0.5, -0.5), glm::dvec2(0.5, -0.5), glm::dvec2(-0.5, 0.5), glm::dvec2(0.5, 0.5)}) {
            const glm::dvec3 on_quad(corner.x * extent[0], corner.y * extent[1], 0.0);
            const glm::dvec3 in_stage = glm::dvec3(p[0], p[1] + 1.6, p[2]) + glm::dquat(q[3], q[0], q[1], q[2]) * on_quad;
            const glm::dvec3 seen = glm::conjugate(eye.orientation) * (in_stage - eye.position);
            // A ray begins in a hand that may be beside the eye: from there on to the border.
            const double depth = std::max(-seen.z, 0.05);
            const glm::dvec2 at((seen.x / depth - eye.left) / (eye.right - eye.left), (seen.y / depth - eye.up) / (eye.down - eye.up));
            low = glm::min(low, at * size);
            high = glm::max(high, at * size);
        }
        for (std::uint32_t y = 0; y < picture.size_px.y; ++y) {
            for (std::uint32_t x = 0; x < picture.size_px.x; ++x) {
                if (x + 2.5 < low.x || y + 2.5 < low.y || x - 1.5 > high.x || y - 1.5 > high.y) { continue; }
                const std::size_t at = (std::size_t{y} * picture.size_px.x + x) * static_cast<std::size_t>(picture.channels);
                std::fill_n(picture.values.begin() + static_cast<std::ptrdiff_t>(at), picture.channels, 0.0f);
            }
        }
    }
}

// Both eyes of a frame, but for the panel and the ray, against what `binosplat render` makes of the logged poses. The wearer stood at the
// scene's origin, looking along its z, when the head was at (0, 1.6, 0).
void checkAgreesWithRender(const Workplace& work, const ViewRun& run, std::size_t frame, const std::string& stereo) {
    CAPTURE(frame);
    const LoggedEye left = loggedEye(run.frames.at(frame), 0), right = loggedEye(run.frames.at(frame), 1);
    const auto inScene = [](const glm::dvec3& v) { return glm::dvec3(v.x, -v.y, -v.z); };
    const glm::dvec3 eye = inScene(0.5 * (left.position + right.position) - glm::dvec3(0.0, 1.6, 0.0));
    const glm::dvec3 look = eye + inScene(left.orientation * glm::dvec3(0, 0, -1)), up = inScene(left.orientation * glm::dvec3(0, 1, 0));
    const auto numbers = [](const glm::dvec3& v) { return fmt::format("{:.9f},{:.9f},{:.9f}", v.x, v.y, v.z); };
    const Outcome rendered =
        work.run(fmt::format("render fence.ply --out expected --size 160x160 --fov-x 90 --ipd 0.063 --eye {} --look {} --up {} {}",
                             numbers(eye), numbers(look), numbers(up), stereo));
    INFO(rendered.errors);
    REQUIRE(rendered.exit_code == 0);
    for (const int side : {kLeft, kRight}) {
        CAPTURE(side);
        Image seen = run.eye(frame, side), expected = readPicture(work.path / "expected" / (side == kLeft ? "left.png" : "right.png"));
        maskPanels(seen, run, frame, static_cast<std::size_t>(side));
        maskPanels(expected, run, frame, static_cast<std::size_t>(side));
        const std::size_t black = static_cast<std::size_t>(std::count(expected.values.begin(), expected.values.end(), 0.0f));
        CHECK(black < expected.values.size() / 2);
        CHECK(compare(seen, expected).psnrDb() > 50.0);
    }
}

bool says(const ViewRun& run, const std::string& words) { return run.outcome.output.find(words) != std::string::npos; }

// The share of the picture that is greener than the picture beside it: what the centre ROI's tint does.
double shareTinted(const Image& before, const Image& after) {
    std::size_t tinted = 0;
    for (std::size_t i = 0; i < before.pixelCount(); ++i) {
        const float* a = before.values.data() + i * static_cast<std::size_t>(before.channels);
        const float* b = after.values.data() + i * static_cast<std::size_t>(after.channels);
        tinted += b[1] - a[1] > 0.06f && a[0] - b[0] > 0.03f ? 1 : 0;
    }
    return static_cast<double>(tinted) / static_cast<double>(before.pixelCount());
}

}  // namespace

TEST_CASE("the trigger on the centre-ROI switch turns it on, and the picture shows it") {
    const Workplace work;
    const Panel panel = startPanel(work);
    writeLightFence(work.path / "fence.ply");
    // Near enough to the bars that holes open inside the picture.
    const std::string arguments = kFence + " --mode paper --margin 0 --eye 0,0,0.5 --look 0,0,3 --up 0,-1,0";
    const ViewRun run =
        runView(work, "click", kSmall + clickOn(panel, {onMethod("Show how tiles were made"), onMethod("Centre ROI (paper)"), {0.9, 0.95}}),
                arguments + withMethodPage(work));
    checkClean(run);
    CHECK(says(run, "tint = true"));
    CHECK(says(run, "center-roi = true"));
    // The panel fell out of the left eye's tint: only the affiliated, right eye is tinted. At 0.4 s with, at 0.58 s also with centre ROIs.
    const Image without = run.eye(18, kRight), with = run.eye(26, kRight);
    CHECK(shareTinted(without, with) > 0.02);
    CHECK(shareTinted(run.eye(18, kLeft), run.eye(26, kLeft)) < 0.005);
}

TEST_CASE("method and dominant eye are switched, and the wearer may quit from the panel") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const std::string script = kBlind + clickOn(panel, {onMethod("reproject"), onMethod("right"), onMethod("Quit"), {0.9, 0.95}});
    const ViewRun run = runView(work, "click", script, kScene + withMethodPage(work));
    checkClean(run);
    CHECK(says(run, "mode = \"reproject\""));
    CHECK(says(run, "dominant = \"right\""));
    // It quit before the script's end at 1 s.
    CHECK(run.frames.size() < 40);
}

TEST_CASE("a rate chosen on the panel is the headset's from then on") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const ViewRun run = runView(work, "rate", kDense + clickOn(panel, {placeOf("120 Hz", true), {0.9, 0.95}}), kScene);
    checkClean(run);
    CHECK(says(run, "refresh-rate = 120"));
    CHECK(run.frames.front().at("period_ns").get<std::int64_t>() > 9'000'000);
    CHECK(run.frames.back().at("period_ns").get<std::int64_t>() == 8'333'333);
}

TEST_CASE("a rate that the headset refuses is said, and is no end") {
    const Workplace work;
    const ViewRun run =
        runView(work, "fixed",
                // The wearer's own changes, long after the end, are on the list as well.
                "rate 90 fixed\n" + kDense.substr(kDense.find('\n') + 1) +
                    clickOn(startPanel(work), {placeOf("120 Hz", true), {0.9, 0.95}}) + "at 20 rate 72\nat 21 rate 80\nat 22 rate 120\n",
                kScene);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.output.find("VUID") == std::string::npos);
    CHECK(says(run, "refresh-rate is 120, this headset refuses it (XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB)"));
    CHECK(run.frames.back().at("period_ns").get<std::int64_t>() > 9'000'000);
}

TEST_CASE("sliders take a click, and the resolution changes once the trigger is let go") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const ViewRun run = runView(
        work, "slide", kSmall + clickOn(panel, {onMethod("margin (paper)"), onMethod("budget"), onMethod("resolution"), {0.9, 0.95}}),
        kScene + withMethodPage(work));
    checkClean(run);
    const auto valueOf = [&](const std::string& key) {
        const std::size_t at = run.outcome.output.find(key + " = ");
        INFO(key << " in " << run.outcome.output);
        REQUIRE(at != std::string::npos);
        return std::stod(run.outcome.output.substr(at + key.size() + 3));
    };
    // 0 to 128 pixels, 0 to 100 %, 0.1 to 2, all clicked at the same share of their length.
    const double share = valueOf("budget");
    CHECK(share > 0.4);
    CHECK(share < 0.6);
    CHECK(valueOf("margin") == doctest::Approx(128.0 * share).epsilon(0.02));
    const double scale = valueOf("resolution-scale");
    CHECK(scale == doctest::Approx(0.1 + 1.9 * share).epsilon(0.02));
    const auto sizeIn = [&](std::size_t frame) {
        const auto rect = run.layers(frame, "projection").at(0).at("views").at(0).at("rect").get<std::array<int, 4>>();
        return rect[2];
    };
    CHECK(sizeIn(20) == 160);
    CHECK(sizeIn(35) == static_cast<int>(std::round(160.0 * scale)));
}

TEST_CASE("a resolution that the device has no memory for is refused on the panel, and what was shown before stays") {
    const Workplace work;
    std::ofstream(work.path / "small.toml") << "[view]\nresolution-scale = 0.25\npanel-page = \"method\"\n";
    const std::string large = "rate 45\nsize 1024 1024\nframes every 12\n" + kLeftHand;
    const ViewRun run = runView(work, "full", large + clickOn(startPanel(work), {onMethod("resolution"), {0.9, 0.95}}),
                                kWall + " --config small.toml --memory-limit 16");
    checkClean(run);
    CHECK(says(run, "does not fit: "));
    CHECK(says(run, "the limit is 16.0 MiB (memory-limit)"));
    const std::size_t late = (run.frames.size() - 1) / 12 * 12;
    const auto rect = run.layers(late, "projection").at(0).at("views").at(0).at("rect").get<std::array<int, 4>>();
    CHECK(rect[2] == 256);
    Image before = run.eye(late / 2, kLeft), after = run.eye(late, kLeft);
    maskPanels(before, run, late, kLeft);
    maskPanels(after, run, late, kLeft);
    CHECK(compare(after, before, 3).psnrDb() > 60.0);
    // At the slider's middle (some 896 pixels) the eyes' pictures fit, and what is to bring them to the headset does not.
    const ViewRun brought =
        runView(work, "brought",
                "rate 45\nsize 853 853\nframes none\n" + kLeftHand + clickOn(startPanel(work), {onMethod("resolution"), {0.9, 0.95}}),
                "builtin:one-splat --load-first --mode shared --config small.toml --memory-limit 24");
    checkClean(brought);
    CHECK(says(brought, "presented pixels needs "));
}

TEST_CASE("a recorded walk of 100 frames, with clicks on the way, ends when the wearer leaves") {
    const Workplace work;
    const Panel panel = startPanel(work);
    writeLightFence(work.path / "fence.ply");
    std::ofstream motion(work.path / "walk.csv");
    motion << "time_s,x,y,z,qx,qy,qz,qw\n";
    for (int i = 0; i <= 230; ++i) {
        // It rests until the wearer has been placed.
        const double time_s = i / 90.0, t = std::max(0.0, time_s - 0.1), turn = 0.2 * std::sin(2.0 * t), nod = 0.1 * std::sin(3.0 * t);
        motion << fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},0,{:.6f}\n", time_s, 0.15 * std::sin(t),
                              1.6 + 0.02 * std::sin(9.0 * t), -0.1 * t, nod, turn, std::sqrt(1.0 - nod * nod - turn * turn));
    }
    motion.close();
    std::string script = kSmall + "head-motion walk.csv\n";
    double time_s = 0.5;
    for (const glm::dvec2& place :
         {onMethod("paper"), onMethod("Centre ROI (paper)"), onMethod("predicted"), onMethod("right"), glm::dvec2(0.9, 0.95)}) {
        script += pointAt(panel, place, time_s) + pointAt(panel, place, time_s + 0.2);
        script += fmt::format("press right trigger {} {}\n", time_s + 0.1, time_s + 0.15);
        time_s += 0.3;
    }
    const std::string start = " --eye 0,0,0 --look 0,0,3 --up 0,-1,0";
    const ViewRun run = runView(work, "walk", script + "at 2.3 exit\n", kFence + start + " --mode predicted" + withMethodPage(work));
    checkClean(run);
    CHECK(run.outcome.output.find("the runtime asked for the end") != std::string::npos);
    CHECK(run.frames.size() >= 100);
    const std::string& output = run.outcome.output;
    std::size_t from = 0;
    for (const char* change : {"mode = \"paper\"", "center-roi = true", "mode = \"predicted\"", "dominant = \"right\""}) {
        const std::size_t found = output.find(change, from);
        INFO(change << " in " << output);
        REQUIRE(found != std::string::npos);
        from = found;
    }
    // Before the first click, and after the last one.
    checkAgreesWithRender(work, run, 20, "");
    checkAgreesWithRender(work, run, 98, "--dominant right --center-roi");
    // The head walked, and every frame was shown as the eyes were.
    for (const std::size_t frame : {30, 60, 90}) {
        const nlohmann::json scene = run.layers(frame, "projection").at(0);
        for (const std::size_t e : {0, 1}) {
            const auto shown = scene.at("views").at(e).at("pose").at("position").get<std::array<double, 3>>();
            const auto was = run.frames.at(frame).at("eyes").at(e).at("pose").at("position").get<std::array<double, 3>>();
            for (const std::size_t axis : {0, 2}) { CHECK(shown[axis] == doctest::Approx(was[axis]).epsilon(1e-4)); }
        }
    }
}

TEST_CASE("pointing beside the panel clicks nothing") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const ViewRun run = runView(work, "beside", kBlind + clickOn(panel, {{1.2, 0.3}, {-0.2, 0.3}}), kScene);
    checkClean(run);
    CHECK_FALSE(says(run, " = "));
}

TEST_CASE("settings and placement are saved as a config of the scene, and come back") {
    const Workplace work;
    const Panel panel = startPanel(work);
    // A step ahead and a method, before they are saved.
    const std::string walk =
        "axis left thumbstick 0.05 0 0\naxis left thumbstick 0.06 0 1\naxis left thumbstick 0.14 0 1\naxis left thumbstick 0.15 0 0\n";
    const ViewRun saved = runView(
        work, "save",
        kBlind + walk + clickOn(panel, {onMethod("reproject"), onMethod("Save"), onMethod("predicted"), onMethod("Load"), {0.9, 0.95}}),
        kScene + withMethodPage(work));
    checkClean(saved);
    const std::string& output = saved.outcome.output;
    const std::size_t at = output.find("saved as ");
    REQUIRE(at != std::string::npos);
    const std::filesystem::path file = output.substr(at + 9, output.find('\n', at) - at - 9);
    CHECK(std::filesystem::weakly_canonical(file) == work.base / "config" / "binosplat" / "scenes" / "slanted-wall.view.toml");
    CHECK(says(saved, "loaded " + file.string()));
    CHECK(output.find("mode = \"predicted\"") < output.rfind("mode = \"reproject\""));
    // The viewer and `render` take the file.
    const ViewRun again = runView(work, "again", kBlind + "at 0.1 exit\n", kWall + " --config '" + file.string() + "'");
    checkClean(again);
    CHECK(work.run("render builtin:slanted-wall --out rendered --size 32x32 --config '" + file.string() + "'").exit_code == 0);
    std::ifstream report(work.path / "rendered" / "report.json");
    CHECK(nlohmann::json::parse(report).at("options").at("mode") == "reproject");
    // The wearer stands there again, unless told where to.
    const ViewRun there = runView(work, "there", kStill + "at 0.1 exit\n", kWall + " --mode reproject --hide-panel");
    checkClean(there);
    CHECK(says(there, "the wearer stands where this scene was saved"));
    const ViewRun before =
        runView(work, "before", kStill + "at 0.1 exit\n", kWall + " --mode reproject --hide-panel --eye 0,0,0 --look 0,0,3 --up 0,-1,0");
    CHECK_FALSE(says(before, "where this scene was saved"));
    const ViewRun named = runView(work, "named", kStill + "at 0.1 exit\n", kWall + " --hide-panel --config '" + file.string() + "'");
    CHECK(compare(there.eye(8, kLeft), named.eye(8, kLeft)).psnrDb() > 60.0);
    CHECK(compare(there.eye(8, kLeft), before.eye(8, kLeft)).psnrDb() < 40.0);
    // Another scene has another place, and one that cannot be read is said and does not keep anybody out.
    CHECK_FALSE(
        says(runView(work, "other", kBlind + "at 0.1 exit\n", "builtin:one-splat --load-first --mode mono"), "where this scene was saved"));
    std::ofstream(file) << "[view]\nnonsense = 1\n";
    const ViewRun broken = runView(work, "broken", kBlind + "at 0.1 exit\n", kScene);
    checkClean(broken);
    CHECK(says(broken, "slanted-wall.view.toml:2"));
}

TEST_CASE("shaders are reloaded by a button, all or none, with a verdict") {
    const Workplace work;
    const Panel panel = startPanel(work);
    // The sources as they are; then a copy in which one line is broken, another that draws nothing, and a folder that is not there.
    const std::filesystem::path sources = std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "shaders";
    const auto copyOf = [&](const std::string& name, const std::string& line, const std::string& replacement) {
        std::filesystem::copy(sources, work.path / name, std::filesystem::copy_options::recursive);
        const std::filesystem::path file = work.path / name / "present/present.comp";
        std::ifstream in(file);
        const std::string text(std::istreambuf_iterator<char>(in), {});
        const std::size_t at = text.find(line);
        REQUIRE(at != std::string::npos);
        std::ofstream(file) << text.substr(0, at) + replacement + text.substr(at + line.size());
    };
    const std::string line = "    const uvec3 bytes = uvec3(colour * 255 + 0.5);";
    copyOf("broken", line, "    const uvec3 bytes = nonsense;");
    copyOf("black", line, "    const uvec3 bytes = uvec3(0);");
    const std::string script = kSmall + clickOn(panel, {onMethod("Shaders", true), {0.9, 0.95}});
    writeCompilerOfChangedShaders(work.path / "tools");  // the first run has no such help
    const auto click = [&](const std::string& name, const std::string& folder, const std::string& more = " PATH=\"$PWD/tools:$PATH\"") {
        const ViewRun run = runView(work, name, script, kScene + withMethodPage(work) + " --shaders '" + folder + "'", kValidated + more);
        checkClean(run);
        return run;
    };
    // Away from the panel and the ray: the upper third of the right half.
    const auto sameAfterwards = [&](const ViewRun& run) {
        const Image before = run.eye(8, kRight), after = run.eye(18, kRight);
        std::size_t other = 0;
        for (std::size_t i = 0; i < before.pixelCount() / 3; ++i) {
            const std::size_t at = i * static_cast<std::size_t>(before.channels);
            other +=
                i % before.size_px.x > before.size_px.x / 2 && !std::equal(&before.values[at], &before.values[at] + 3, &after.values[at])
                    ? 1
                    : 0;
        }
        return other == 0;
    };
    const ViewRun good = click("good", sources.string(), "");
    std::size_t count = 0;
    for (const auto& file : std::filesystem::recursive_directory_iterator(sources)) { count += file.path().extension() == ".comp" ? 1 : 0; }
    CHECK(says(good, fmt::format("{} shaders reloaded in ", count)));
    CHECK(sameAfterwards(good));
    const ViewRun bad = click("bad", "broken");
    CHECK(says(bad, "shaders stay as they were: broken/present/present.comp:"));
    CHECK(says(bad, "nonsense"));
    CHECK(sameAfterwards(bad));
    const ViewRun black = click("black-run", "black");
    CHECK(says(black, " shaders reloaded in "));
    CHECK_FALSE(sameAfterwards(black));
    CHECK(says(click("missing", "nowhere"), "shaders stay as they were: nowhere/sort/cull.comp is not there"));
    // A pipe would keep the compiler, and the wearer, waiting.
    REQUIRE(work.runCommand("mkdir -p pipe/sort && mkfifo pipe/sort/cull.comp").exit_code == 0);
    CHECK(says(click("pipe-run", "pipe"), "shaders stay as they were: pipe/sort/cull.comp is not a file"));
}

TEST_CASE("nobody reloads shaders who was not told where they are") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const std::string script = kBlind + clickOn(panel, {onMethod("Shaders", true), {0.9, 0.95}});
    const ViewRun run = runView(work, "none", script, kScene + withMethodPage(work), kValidated + " BINOSPLAT_SHADERS=");
    checkClean(run);
    CHECK_FALSE(says(run, "shaders"));
    const ViewRun told = runView(work, "told", script, kScene + withMethodPage(work), kValidated + " BINOSPLAT_SHADERS=nowhere");
    CHECK(says(told, "shaders stay as they were: nowhere/sort/cull.comp is not there"));
}

TEST_CASE("the menu button hides the panel and brings it before the eyes") {
    const Workplace work;
    const std::string script =
        kDense +
        "head 0 position 0 1.6 0\nhead 0.15 position 0 1.6 0\nhead 0.2 position 1 1.6 0 turn 90 0\npress left y 0.1 0.12\n"
        "press right b 0.3 0.32\npress left menu 0.1 0.12\nat 0.4 exit\n";
    const ViewRun run = runView(work, "menu", script, kScene);
    checkClean(run);
    CHECK(run.panels(8).size() == 1);
    CHECK(run.panels(20).empty());
    CHECK(run.panels(32).size() == 1);
    // The head looks along -x, from (1, 1.6, 0).
    const Panel moved = panelOf(run, 33);
    CHECK(moved.middle.x < 0.5);
    CHECK(moved.middle.x > -0.5);
    CHECK(std::abs(moved.middle.z) > 0.2);
}

TEST_CASE("a squeezed hand that points carries the panel") {
    const Workplace work;
    const Panel panel = startPanel(work);
    Panel lifted = panel;
    lifted.middle.y += 0.2;
    const std::string script = kBlind + pointAt(panel, {0.5, 0.5}, 0.1) + pointAt(panel, {0.5, 0.5}, 0.2) +
                               pointAt(lifted, {0.5, 0.5}, 0.3) + "press right squeeze 0.15 0.35\nat 0.4 exit\n";
    const ViewRun run = runView(work, "carry", script, kScene);
    checkClean(run);
    const Panel after = panelOf(run, run.frames.size() - 3);
    CHECK(after.middle.y - panel.middle.y == doctest::Approx(0.2).epsilon(0.01));
    CHECK(after.middle.x == doctest::Approx(panel.middle.x).epsilon(0.01));
}

TEST_CASE("sticks move and turn the wearer, both grips move the scene") {
    const Workplace work;
    std::ofstream(work.path / "clear.toml") << "[view]\nvignette = false\n";
    const ViewRun run = runView(
        work, "moves",
        kSmall +
            // Ahead, up, a turn to the right and one back to the left, then both hands drag.
            "axis left thumbstick 0.1 0 0\naxis left thumbstick 0.11 0 1\naxis left thumbstick 0.29 0 1\naxis left thumbstick 0.3 0 0\n"
            "axis right thumbstick 0.33 0 0\naxis right thumbstick 0.34 0 1\naxis right thumbstick 0.52 0 1\n"
            "axis right thumbstick 0.53 0 0\naxis right thumbstick 0.59 0 0\naxis right thumbstick 0.6 1 0\n"
            "axis right thumbstick 0.69 1 0\naxis right thumbstick 0.71 0 0\naxis right thumbstick 0.73 -1 0\n"
            "axis right thumbstick 0.82 -1 0\naxis right thumbstick 0.84 0 0\n"
            "press left squeeze 0.88 1.2\npress right squeeze 0.88 1.2\n"
            "controller left 0.92 position -0.2 1.2 -0.35\ncontroller left 1.1 position -0.3 1.3 -0.3\n"
            "controller right 0.92 position 0.2 1.2 -0.35\ncontroller right 1.1 position 0.4 1.3 -0.5\nat 1.25 exit\n",
        kScene + " --hide-panel --config clear.toml");
    checkClean(run);
    const auto likeness = [&](std::size_t a, std::size_t b) { return compare(run.eye(a, kLeft), run.eye(b, kLeft)).psnrDb(); };
    const std::size_t start = 4, ahead = 14, up = 26, right = 30, back = 36, held = 52;
    CHECK(likeness(2, start) > 60.0);
    CHECK(likeness(start, ahead) < 35.0);
    CHECK(likeness(ahead, up) < 35.0);
    CHECK(likeness(up, right) < 35.0);
    CHECK(likeness(up, back) > 40.0);
    CHECK(likeness(back, held) < 35.0);
}

namespace {

glm::dvec3 savedPosition(const ViewRun& run) {
    const auto position = savedNumbers(run, "scene-position").get<std::array<double, 3>>();
    return {position[0], position[1], position[2]};
}

const std::string kPlaced = kScene + " --eye 0,0,0 --look 0,0,3 --up 0,-1,0";

}  // namespace

TEST_CASE("a hand that holds the scene while the room begins elsewhere has not moved it") {
    const Workplace work;
    const std::string walk =
        "head 0 position 0 1.6 0\nhead 0.1 position 0 1.6 0\nhead 0.15 position 0.5 1.6 0.4 turn 40 0\n"
        "head 0.4 position 0.5 1.6 0.4 turn 40 0\nhead 0.45 position 0 1.6 0 turn 0 0\n";
    const ViewRun run = runView(work, "elsewhere",
                                kBlind + walk + "press left squeeze 0.2 0.38\nat 0.3 recentre\nat 0.5 recentre\n" +
                                    clickAt(startPanel(work), placeOf("Save"), 0.6) + "at 0.8 exit\n",
                                kPlaced);
    checkClean(run);
    CHECK(glm::length(savedPosition(run)) < 1e-6);
}

TEST_CASE("the stick of the hand that points at the panel moves nobody, the other one does") {
    const Workplace work;
    for (const char* hand : {"left", "right"}) {
        CAPTURE(hand);
        const bool is_left = std::string(hand) == "left";
        // A tenth of a second ahead with the left stick, or up with the right one.
        const std::string push = fmt::format(
            "axis {0} thumbstick 0.2 0 0\naxis {0} thumbstick 0.21 0 1\naxis {0} thumbstick 0.31 0 1\naxis {0} thumbstick 0.32 0 0\n",
            hand);
        const Panel panel = startPanel(work);
        const std::string away = "controller left 0.4 position -0.2 1.2 -0.35 turn 0 -80\n";
        const std::string points = pointAt(panel, {0.5, 0.5}, 0.0, "left") + pointAt(panel, {0.5, 0.5}, 0.39, "left");
        const std::string rests =
            "controller right 0 position 0.2 1.2 -0.35 turn 0 -80\ncontroller right 0.4 position 0.2 1.2 -0.35 turn 0 -80\n";
        const ViewRun run = runView(
            work, hand,
            "rate 45\nsize 64 64\nframes none\n" + points + away + rests + push + clickAt(panel, placeOf("Save"), 0.5) + "at 0.7 exit\n",
            kPlaced);
        checkClean(run);
        const glm::dvec3 position = savedPosition(run);
        CAPTURE(position.y);
        CHECK((is_left ? glm::length(position) < 1e-6 : position.y < -0.05));
    }
}

TEST_CASE("the scene that one hand holds moves with it, as far as it does and not about it") {
    const Workplace work;
    // Half a metre is a unit. The hand is turned as well; the other one saves what came of it.
    const std::string hold =
        "press left squeeze 0.05 0.16\ncontroller left 0.06 position -0.2 1.2 -0.35 turn 0 -80\n"
        "controller left 0.15 position -0.1 1.4 -0.65 turn 30 -60\n";
    const ViewRun run = runView(work, "hold", kDense + hold + clickOn(startPanel(work), {placeOf("Save"), {0.9, 0.95}}),
                                kPlaced + " --metres-per-unit 0.5");
    checkClean(run);
    // The wearer's room lies in the scene as far the other way, in our axes: x right, y down, z ahead.
    const glm::dvec3 position = savedPosition(run);
    CHECK(position.x == doctest::Approx(-0.2).epsilon(1e-4));
    CHECK(position.y == doctest::Approx(0.4).epsilon(1e-4));
    CHECK(position.z == doctest::Approx(-0.6).epsilon(1e-4));
    CHECK(std::abs(savedNumbers(run, "scene-orientation").get<std::array<double, 4>>()[0]) == doctest::Approx(1.0));
    CHECK(savedNumbers(run, "units-per-metre").get<double>() == doctest::Approx(2.0));
}

TEST_CASE("a runtime with no more than OpenXR 1.0 and Vulkan shows every method, takes clicks and knows no floor") {
    const Workplace work;
    writeLightFence(work.path / "fence.ply");
    std::string script = "rate 45\nsize 160 160\nframes every 4\nstage off\nprofile khr/simple_controller\n";
    for (const simulated::Extension& extension : simulated::kExtensions) {
        const std::string name = extension.name;
        if (name != "XR_KHR_vulkan_enable2") { script += fmt::format("extension {} off\n", name); }
    }
    std::vector<glm::dvec2> places;
    for (const char* mode : {"reproject", "paper", "mono", "two-pass", "shared"}) { places.push_back(onMethod(mode)); }
    places.emplace_back(0.9, 0.95);
    const ViewRun run = runView(work, "core", script + clickOn(startPanel(work), places, "select"),
                                "fence.ply --load-first --eye 0,0,0 --look 0,0,3 --up 0,-1,0" + withMethodPage(work));
    checkClean(run);
    CHECK(says(run, "the room now begins where the wearer stands\n"));
    std::size_t from = 0;
    for (const char* mode : {"reproject", "paper", "mono", "two-pass", "shared"}) {
        from = run.outcome.output.find(fmt::format("mode = \"{}\"", mode), from);
        INFO(mode << " in " << run.outcome.output);
        REQUIRE(from != std::string::npos);
    }
    const std::size_t last = (run.frames.size() - 4) / 4 * 4;
    CHECK(run.layers(last, "projection").at(0).at("views").at(0).contains("depth") == false);
    CHECK(run.layers(last, "quad").size() > 3);  // rays and controllers beside the panel
    checkAgreesWithRender(work, run, last, "--mode shared");
}

TEST_CASE("controllers are put down, hands click, and controllers are taken up again") {
    const Workplace work;
    const Panel panel = startPanel(work);
    // Whatever is not in the hand does nothing.
    const std::string script = kDense + pointAt(panel, onMethod("shared"), 0.1) + pointAt(panel, onMethod("shared"), 0.2) +
                               pointAt(panel, onMethod("two-pass"), 0.25) + pointAt(panel, onMethod("two-pass"), 0.4) +
                               pointAt(panel, onMethod("mono"), 0.45) + pointAt(panel, onMethod("mono"), 0.6) +
                               "press right aim_activate_ext 0.11 0.13\npress right trigger 0.15 0.18\n"
                               "press right trigger 0.28 0.31\npress right aim_activate_ext 0.34 0.37\n"
                               "press right aim_activate_ext 0.48 0.51\npress right trigger 0.54 0.57\n"
                               "at 0.22 profile ext/hand_interaction_ext\nat 0.42 profile oculus/touch_controller\nat 0.65 exit\n";
    const ViewRun run = runView(work, "change", script, kScene + withMethodPage(work));
    checkClean(run);
    std::vector<std::string> changes;
    for (std::size_t at = run.outcome.output.find("frame "); at != std::string::npos; at = run.outcome.output.find("frame ", at + 1)) {
        const std::string line = run.outcome.output.substr(at, run.outcome.output.find('\n', at) - at);
        if (line.find("mode = ") != std::string::npos) { changes.push_back(line); }
    }
    INFO(run.outcome.output);
    REQUIRE(changes.size() == 3);
    const std::pair<const char*, std::pair<int, int>> expected[]{{"shared", {13, 20}}, {"two-pass", {30, 36}}, {"mono", {48, 55}}};
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(changes[i].find(expected[i].first) != std::string::npos);
        const int frame = std::stoi(changes[i].substr(6));
        CHECK(frame >= expected[i].second.first);
        CHECK(frame <= expected[i].second.second);
    }
}
