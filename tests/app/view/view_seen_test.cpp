// Facts about what the eyes see while somebody walks and clicks: what `render` makes of the same poses, and the panel's choices.
#include "engine/geometry.h"
#include "engine/picture/metrics.h"
#include "tests/app/view/light_fence.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/app/view/view_scripts.h"
#include "xr/simulated/extensions.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

TEST_SUITE_BEGIN("view_seen");

namespace view_seen_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

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

}  // namespace view_seen_test
