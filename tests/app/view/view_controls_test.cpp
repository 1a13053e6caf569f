// Facts about the viewer's controls: sticks and grips move the wearer, the scene and the panel, as a script's hands do it.
#include "engine/geometry.h"
#include "engine/picture/metrics.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/app/view/view_scripts.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

TEST_SUITE_BEGIN("view_controls");

namespace view_controls_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

glm::dvec3 savedPosition(const ViewRun& run) {
    const auto position = savedNumbers(run, "scene-position").get<std::array<double, 3>>();
    return {position[0], position[1], position[2]};
}

const std::string kPlaced = kScene + " --eye 0,0,0 --look 0,0,3 --up 0,-1,0";

}  // namespace

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

}  // namespace view_controls_test
