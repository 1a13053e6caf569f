// Facts about the window beside the headset: what mouse, keys and files do there, and what it shows.
#include "tests/app/view/view_window.h"
#include "engine/picture/metrics.h"
#include "tests/app/view/unchanged_shaders.h"
#include "tests/app/view/view_panel.h"

#include <imgui.h>

#include <cstdio>
#include <functional>
#include <set>

TEST_SUITE_BEGIN("view_window");

namespace view_window_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// Where the panel's line about the last button begins where all widgets are there, in shares of its width and height: there two panels
// differ that differ in it.
glm::dvec2 placeOfMessage() {
    PanelSketch sketch;
    sketch.status.can_reload_shaders = sketch.status.can_pass_through = true;
    sketch.status.refresh_rates = {72.0, 80.0, 90.0, 120.0};
    const auto draw = [&](const char* message) {
        sketch.status.message = message;
        sketch.draw();
        std::vector<ImVec2> places;
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int list = 0; list < data.CmdListsCount; ++list) {
            for (const ImDrawVert& vertex : data.CmdLists[list]->VtxBuffer) { places.push_back(vertex.pos); }
        }
        return places;
    };
    const std::vector<ImVec2> one = draw("MMMMMMMM"), other = draw("IIIIIIII");
    const auto differs = [](const ImVec2& a, const ImVec2& b) { return a.x != b.x || a.y != b.y; };
    const auto [first, its] = std::ranges::mismatch(one, other, std::not_fn(differs));
    REQUIRE(first != one.end());
    return glm::dvec2(first->x, first->y) / glm::dvec2(kPanelPx);
}

// The pixels of the window next to the middles of the eye's, which it shows magnified.
Image eyeInWindow(const Image& screen, glm::uvec2 eye_px) {
    Image eye{eye_px, 3, {}};
    const glm::dvec2 scale = glm::dvec2(kEyePx) / glm::dvec2(eye_px);
    for (std::uint32_t y = 0; y < eye_px.y; ++y) {
        for (std::uint32_t x = 0; x < eye_px.x; ++x) {
            const auto colour = colourAt(screen, glm::uvec2(scale * (glm::dvec2(x, y) + 0.5)));
            eye.values.insert(eye.values.end(), colour.begin(), colour.end());
        }
    }
    return eye;
}

// Of the last composed picture.
Image lastLeftEye(const std::filesystem::path& folder) {
    std::size_t last = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        unsigned long frame = 0;
        if (std::sscanf(file.path().filename().c_str(), "frame_%lu.png", &frame) == 1) { last = std::max<std::size_t>(last, frame); }
    }
    ViewRun run;
    run.out = folder;
    return run.eye(last, kLeft);
}

std::size_t coloursOfPanel(const Image& screen) {
    std::set<std::array<float, 3>> colours;
    for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(kPanelInWindowPx.y); y += 3) {
        for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(kPanelInWindowPx.x); x += 3) {
            colours.insert(colourAt(screen, {kEyePx + x, y}));
        }
    }
    return colours.size();
}

}  // namespace

TEST_CASE("mouse and keys do in the window what hands do in the headset") {
    if (!haveScreen()) { return; }
    const Workplace work;
    std::ofstream(work.path / "rest.script") << "rate 30\nsize 192 192\nframes all\n";
    writeCompilerOfChangedShaders(work.path / "tools");
    Viewer viewer(work, "--simulate rest.script --out seen --shaders '" BINOSPLAT_SOURCE_DIR "/shaders'");
    Program& program = viewer.program();

    // The panel by mouse: a click on a switch, and the same again.
    viewer.click(placeOf("Vignette", true));
    CHECK(program.waitFor("vignette = false") != "");
    viewer.click(placeOf("Vignette", true));
    CHECK(program.waitFor("vignette = true") != "");

    // A drag of 100 pixels to the left turns by 0.4 radians, however many frames it takes; the scene follows the mouse, to the left.
    const Pose start = viewer.placement(work);
    viewer.hands(Viewer::moveTo({400.0, 300.0}));
    viewer.tab();
    viewer.hands("mousedown 1");
    viewer.tab();
    viewer.hands(Viewer::moveTo({300.0, 300.0}));
    viewer.tab();
    viewer.hands("mouseup 1");
    const Pose turned = viewer.placement(work);
    const auto turnBetween = [](const Pose& a, const Pose& b) {
        const glm::dquat turn = glm::conjugate(a.orientation) * b.orientation;
        return 2.0 * std::atan2(turn.y, turn.w);
    };
    CHECK(turnBetween(start, turned) == doctest::Approx(0.4).epsilon(1e-6));

    // Keys: forward is where the wearer now looks, arrows turn.
    const auto hold = [&](const std::string& key) {
        viewer.hands(Viewer::moveTo({300.0, 300.0}) + "keydown " + key);
        viewer.tab();
        viewer.tab();
        viewer.hands("keyup " + key);
        return viewer.placement(work);
    };
    const auto stepBetween = [](const Pose& a, const Pose& b) { return glm::conjugate(a.orientation) * (b.position - a.position); };
    const Pose forward = hold("w"), sideways = hold("d"), sunk = hold("q");
    CHECK(stepBetween(turned, forward).z > 0.01);
    CHECK(std::abs(stepBetween(turned, forward).x) < 1e-6);
    CHECK(stepBetween(forward, sideways).x > 0.01);
    CHECK(std::abs(stepBetween(forward, sideways).z) < 1e-6);
    CHECK(stepBetween(sideways, sunk).y > 0.01);
    const Pose right = hold("Right");
    CHECK(turnBetween(sunk, right) > 0.01);
    const Pose back = hold("s"), left = hold("Left");
    CHECK(stepBetween(right, back).z < -0.01);
    CHECK(turnBetween(back, left) < -0.01);

    // The wheel makes the scene grow about the wearer, the right button tilts it about the line of sight.
    double before = 0.0, grown = 0.0;
    const Pose wheel_from = viewer.placement(work, &before);
    viewer.hands(Viewer::moveTo({300.0, 300.0}));
    viewer.tab();
    viewer.hands("click 4 click 4");
    viewer.tab();
    const Pose wheel_to = viewer.placement(work, &grown);
    CHECK(grown == doctest::Approx(before / (1.1 * 1.1)).epsilon(1e-4));
    CHECK(turnBetween(wheel_from, wheel_to) == doctest::Approx(0.0));
    viewer.hands(Viewer::moveTo({300.0, 300.0}));
    viewer.tab();
    viewer.hands("mousedown 3");
    viewer.tab();
    viewer.hands(Viewer::moveTo({400.0, 300.0}));
    viewer.tab();
    viewer.hands("mouseup 3");
    const Pose tilted = viewer.placement(work);
    CHECK(glm::angle(glm::conjugate(wheel_to.orientation) * tilted.orientation) == doctest::Approx(0.4).epsilon(1e-4));
    viewer.hands(Viewer::moveTo({400.0, 300.0}));
    viewer.tab();
    viewer.hands("mousedown 3");
    viewer.tab();
    viewer.hands(Viewer::moveTo({300.0, 300.0}));
    viewer.tab();
    viewer.hands("mouseup 3");

    // R: the room begins where the head is.
    viewer.hands("key r");
    CHECK(program.waitFor("the room now begins where the wearer stands") != "");

    // What stands in the window is what the dominant eye sees, also by new shaders. It is there some frames later.
    if (viewer.tab().find("panel = true") != std::string::npos) { viewer.tab(); }
    viewer.hands("key F5");
    CHECK(program.waitFor(" shaders reloaded in ") != "");
    for (int i = 0; i < 6; ++i) { viewer.tab(); }
    const Image screen = viewer.screen().picture();

    // Escape ends the session as the wearer would.
    viewer.hands("key Escape");
    CHECK(program.exitCode() == 0);
    INFO(program.said());
    CHECK(program.said().find("frames; ") != std::string::npos);
    CHECK(program.said().find("VUID") == std::string::npos);
    CHECK(program.said().find("no window") == std::string::npos);
    const Image seen = lastLeftEye(work.path / "seen");
    REQUIRE(seen.channels == 3);
    CHECK(compare(eyeInWindow(screen, seen.size_px), seen).psnrDb() > 35.0);
    // Beside it, the panel.
    CHECK(coloursOfPanel(screen) > 10);
}

TEST_CASE("a mouse that lies on the panel leaves it to the hands") {
    if (!haveScreen()) { return; }
    const Workplace work;
    const std::string small = "rate 90\nsize 96 96\nframes none\n", scene = "builtin:slanted-wall --load-first --mode mono";
    const Panel panel = panelOf(runView(work, "look", small + "at 0.1 exit\n", scene), 8);
    std::filesystem::create_directory(work.base / "screen");
    const Screen screen(work.base / "screen");
    const XConnection stays(screen);  // a server whom everybody left begins anew, with its mouse in the middle
    handsOn(screen, Viewer::moveTo({900.0, 650.0}));
    const ViewRun run = runView(work, "hand", small + clickOn(panel, {placeOf("Quit"), {0.9, 0.95}}), scene,
                                "XDG_CONFIG_HOME=\"$PWD/../config\" WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1 DISPLAY=" + screen.name);
    INFO(run.outcome.output);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.output.find("VUID") == std::string::npos);
    CHECK(run.outcome.output.find("no window") == std::string::npos);
    CHECK(run.frames.size() < 50);  // the script's end comes later
}

TEST_CASE("a session in place of a lost one is said on the panel") {
    if (!haveScreen()) { return; }
    const glm::uvec2 place(glm::dvec2(kEyePx, 0.0) + placeOfMessage() * kPanelInWindowPx);
    using Line = std::vector<std::array<float, 3>>;
    const auto lineIn = [&](const Image& screen) {
        Line line;
        for (unsigned y = 0; y < 14; ++y) {
            for (unsigned x = 0; x < 200; ++x) { line.push_back(colourAt(screen, place + glm::uvec2(x, y))); }
        }
        return line;
    };
    constexpr int kMostLooks = 20;
    // The letters there, once they are the same twice, the panel gone and back between: what was drawn while it came is seen by then.
    const auto read = [&](Viewer& viewer) {
        Line line, before;
        for (int i = 0; i < kMostLooks; ++i) {
            viewer.tab();
            viewer.tab();
            line = lineIn(viewer.screen().picture());
            if (line == before && std::set(line.begin(), line.end()).size() > 2) { break; }
            before = line;
        }
        return line;
    };
    std::array<Line, 2> lines;
    for (const bool is_lost : {false, true}) {
        const Workplace work;
        std::ofstream(work.path / "lost.script") << "rate 30\nsize 96 96\nframes none\n" << (is_lost ? "at 0.5 lose-session\n" : "");
        Viewer viewer(work, "--simulate lost.script --out seen --shaders '" BINOSPLAT_SOURCE_DIR "/shaders'");
        if (is_lost) { REQUIRE(viewer.program().waitFor("another one begins") != ""); }
        Line& line = lines[is_lost ? 1 : 0];
        line = read(viewer);
        CHECK(std::set(line.begin(), line.end()).size() > 2);
        for (int i = 0; is_lost && line == lines[0] && i < kMostLooks; ++i) { line = read(viewer); }
        viewer.hands("key Escape");
        CHECK(viewer.program().exitCode() == 0);
    }
    CHECK(lines[0] != lines[1]);
}

TEST_CASE("the window is as large as the desktop wants things to be, and may be made another size in its shape") {
    if (!haveScreen()) { return; }
    const Workplace work;
    std::ofstream(work.path / "rest.script") << "rate 30\nsize 96 96\nframes none\n";
    Viewer viewer(work, "--simulate rest.script --out seen", 48);
    const glm::dvec2 size(numberOfWindow(viewer.screen(), "^binosplat$", "WIDTH"),
                          numberOfWindow(viewer.screen(), "^binosplat$", "HEIGHT"));
    CHECK(size == 0.5 * glm::dvec2(kEyePx + kPanelInWindowPx.x, kEyePx));
    const auto [resizes, keeps_shape] = viewer.connection().resizesInShape(numberOfWindow(viewer.screen(), "^binosplat$", "WINDOW"));
    CHECK(resizes);
    CHECK(keeps_shape);
    // Its widgets are where they are shown.
    viewer.hands(Viewer::moveTo(0.5 * (glm::dvec2(kEyePx, 0.0) + placeOf("Vignette", true) * kPanelInWindowPx)));
    viewer.tab();
    viewer.hands("mousedown 1");
    viewer.tab();
    viewer.hands("mouseup 1");
    CHECK(viewer.program().waitFor("vignette = false") != "");
    viewer.hands("key Escape");
    CHECK(viewer.program().exitCode() == 0);
}

}  // namespace view_window_test
