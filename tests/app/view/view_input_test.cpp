// Facts about controllers of several makers: what their buttons do, and what hands feel.
#include "engine/geometry.h"
#include "engine/picture/metrics.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/app/view/view_panel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

TEST_SUITE_BEGIN("view_input");

namespace view_input_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::string kScene = "builtin:slanted-wall --load-first --mode mono --hide-hands";

std::string withProfile(const std::string& profile) { return kValidated + " SIMULATED_OPENXR_PROFILE=" + profile; }

ViewRun runWith(const Workplace& work, const std::string& profile, const std::string& lines, const std::string& options = "",
                const std::string& frames = "every 5") {
    std::string name = profile.substr(profile.find('/') + 1);
    static int count = 0;
    const ViewRun run =
        runView(work, name + std::to_string(count++), fmt::format("rate 100\nsize 96 96\nframes {}\n{}at 0.6 exit\n", frames, lines),
                kScene + options, withProfile(profile));
    CAPTURE(profile);
    checkClean(run);
    return run;
}

// Where the panel's middle is, in STAGE.
glm::dvec3 panelPlace(const ViewRun& run, std::size_t frame) {
    const auto p = run.layers(frame, "quad").at(0).at("pose").at("position").get<std::array<double, 3>>();
    return {p[0], p[1] + 1.6, p[2]};
}

// Lines that put the right hand 0.3 m before the panel's middle, moved by `aside`, pointing at it.
std::string pointAtPanel(const ViewRun& seen, double time_s, const glm::dvec3& aside = glm::dvec3(0.0)) {
    const auto q = seen.layers(10, "quad").at(0).at("pose").at("orientation").get<std::array<double, 4>>();
    const glm::dquat turn(q[3], q[0], q[1], q[2]);
    const glm::dvec3 at = panelPlace(seen, 10) + turn * glm::dvec3(0.0, 0.0, 0.3) + aside;
    return fmt::format("controller right {:.6f} position {:.6f} {:.6f} {:.6f} rotation {:.6f} {:.6f} {:.6f} {:.6f}\n", time_s, at.x, at.y,
                       at.z, q[0], q[1], q[2], q[3]);
}

// What the wearer sees at rest, once for all cases.
const ViewRun& rest() {
    static const Workplace work;
    static const ViewRun run = runWith(work, "oculus/touch_controller", "", "", "none");
    return run;
}

// From a frame on until before another one.
std::size_t pulses(const ViewRun& run, std::size_t first = 0, std::size_t last = std::numeric_limits<std::size_t>::max()) {
    std::size_t count = 0;
    for (std::size_t i = first; i < std::min(last, run.frames.size()); ++i) {
        for (const auto& event : run.frames[i].at("events")) { count += event.get<std::string>().starts_with("haptic right") ? 1 : 0; }
    }
    return count;
}

}  // namespace

TEST_CASE("every controller brings the panel and sends it away, clicks on it, and is felt once for each") {
    const Workplace work;
    const ViewRun& look = rest();
    const glm::dvec3 below(0.0, -0.1, 0.0);  // a ray that ends between the eyes is a point
    // One after the other, a fifth of a second each.
    const std::vector<std::tuple<std::string, std::string, std::string>> controllers{
        {"oculus/touch_controller", "trigger", "b"},        {"valve/index_controller", "trigger", "b"},
        {"microsoft/motion_controller", "trigger", "menu"}, {"htc/vive_controller", "trigger", "menu"},
        {"khr/simple_controller", "select", "menu"},        {"hp/mixed_reality_controller", "trigger", "b"},
        {"samsung/odyssey_controller", "trigger", "menu"},  {"htc/vive_cosmos_controller", "trigger", "b"},
        {"htc/vive_focus3_controller", "trigger", "b"},     {"bytedance/pico_neo3_controller", "trigger", "b"},
        {"bytedance/pico4_controller", "trigger", "b"},     {"facebook/touch_controller_pro", "trigger", "b"},
        {"meta/touch_controller_plus", "trigger", "b"}};
    std::string lines = pointAtPanel(look, 0.0, below);
    double time_s = 0.2;
    for (const auto& [profile, trigger, menu] : controllers) {
        lines += fmt::format("at {:.2f} profile {}\n", time_s, profile);
        lines += fmt::format("press right {} {:.3f} {:.3f}\n", trigger, time_s + 0.045, time_s + 0.075);
        for (const double press_s : {time_s + 0.095, time_s + 0.145}) {
            lines += fmt::format("press right {} {:.3f} {:.3f}\n", menu, press_s, press_s + 0.02);
        }
        time_s += 0.2;
    }
    const ViewRun run =
        runView(work, "all", fmt::format("rate 100\nsize 96 96\nframes none\n{}at {} exit\n", lines, time_s + 0.05), kScene);
    checkClean(run);
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        CAPTURE(std::get<0>(controllers[i]));
        const std::size_t first = 20 * (i + 1);
        CHECK(pulses(run, first + 3, first + 9) == 1);
        CHECK(run.panels(first + 8).size() == 1);
        CHECK(run.panels(first + 13).empty());
        CHECK(run.panels(first + 19).size() == 1);
    }
}

TEST_CASE("bare hands click on the panel and carry it, by either way to tell the program") {
    const Workplace work;
    const ViewRun& look = rest();
    const glm::dvec3 up(0.0, 0.2, 0.0);
    for (const auto& [profile, click, grab] : {std::tuple("ext/hand_interaction_ext", "aim_activate_ext", "grasp_ext"),
                                               std::tuple("microsoft/hand_interaction", "select", "squeeze")}) {
        CAPTURE(profile);
        // Up and down again with the panel, then to *Quit*.
        const std::string lines = pointAtPanel(look, 0.05) + pointAtPanel(look, 0.1) + pointAtPanel(look, 0.18, up) +
                                  pointAtPanel(look, 0.25) + pointAtPanel(look, 0.3) +
                                  "controller right 0.35 position 0.2 1.2 -0.35 look -0.289 1.765 -1.010\n" +
                                  fmt::format("press right {} 0.06 0.28\npress right {} 0.38 0.42\n", grab, click);
        const ViewRun run = runWith(work, profile, lines, "", "none");
        CHECK(panelPlace(run, 18).y - panelPlace(look, 18).y == doctest::Approx(0.2).epsilon(0.1));
        CHECK(pulses(run) == 0);
        CHECK(run.frames.size() < 55);
    }
}

TEST_CASE("what was pressed while the input went elsewhere counts once it was let go") {
    const Workplace work;
    const ViewRun& look = rest();
    const Panel panel = panelOf(look, 10);
    const std::string at_quit = pointAt(panel, placeOf("Quit"), 0.0), again = "press right trigger 0.4 0.45\n";
    const auto run = [&](const std::string& lines) { return runWith(work, "oculus/touch_controller", at_quit + lines, "", "none"); };
    // Another program had the input, or another session of this one.
    for (const std::string elsewhere : {"at 0.1 focused off\nat 0.2 focused on\n", "at 0.1 lose-session\n"}) {
        CAPTURE(elsewhere);
        const ViewRun quits = run(elsewhere + "press right trigger 0.11 0.35\n" + again);
        const double end_s = quits.frames.back().at("display_time_ns").get<double>() * 1e-9 - 1.0;
        CHECK(end_s > 0.4);
        CHECK(end_s < 0.55);
        const ViewRun hides = run(elsewhere + "press right b 0.11 0.35\npress right b 0.4 0.45\n");
        CHECK(hides.panels(33).size() == 1);
        CHECK(hides.panels(48).empty());
    }
}

TEST_CASE("a grip that shivers holds on, and one that is only touched does not grab") {
    const Workplace work;
    const ViewRun& look = rest();
    const glm::dvec3 up(0.0, 0.2, 0.0);
    const auto lifted = [&](const std::string& squeeze) {
        const std::string lines =
            pointAtPanel(look, 0.1) + pointAtPanel(look, 0.2) + pointAtPanel(look, 0.4, up) + pointAtPanel(look, 0.5, up) + squeeze;
        const ViewRun run = runWith(work, "valve/index_controller", lines, "", "none");
        return panelPlace(run, 55).y - panelPlace(look, 55).y;
    };
    CHECK(lifted("axis right squeeze 0.1 0\naxis right squeeze 0.15 0.45\n") == doctest::Approx(0.0));
    CHECK(lifted("axis right squeeze 0.1 0\naxis right squeeze 0.15 0.6\naxis right squeeze 0.25 0.35\naxis right squeeze 0.5 0.35\n"
                 "axis right squeeze 0.52 0\n") == doctest::Approx(0.2).epsilon(0.02));
    // Let go half the way up.
    const double half =
        lifted("axis right squeeze 0.1 0\naxis right squeeze 0.15 1\naxis right squeeze 0.29 1\naxis right squeeze 0.3 0.2\n");
    CHECK(half > 0.05);
    CHECK(half < 0.15);
}

TEST_CASE("a pad moves the wearer while it is pressed, not while a thumb rests on it") {
    const Workplace work;
    const ViewRun run = runWith(work, "htc/vive_controller",
                                "axis left trackpad 0.1 0 0\naxis left trackpad 0.12 0 1\npress left trackpad 0.3 0.5\n", " --hide-panel");
    const Image still = run.eye(5, kLeft);
    CHECK(compare(run.eye(25, kLeft), still).psnrDb() > 60.0);
    CHECK(compare(run.eye(55, kLeft), still).psnrDb() < 30.0);
}

TEST_CASE("a stick pushed mostly aside turns and does not lift") {
    const Workplace work;
    const auto pushed = [&](double y) {
        return runWith(work, "oculus/touch_controller",
                       fmt::format("axis right thumbstick 0.1 0 0\naxis right thumbstick 0.12 0.9 {0}\naxis right thumbstick 0.3 0.9 {0}\n"
                                   "axis right thumbstick 0.32 0 0\n",
                                   y),
                       " --hide-panel")
            .eye(55, kLeft);
    };
    CHECK(compare(pushed(0.7), pushed(0.0)).psnrDb() > 60.0);
}

}  // namespace view_input_test
