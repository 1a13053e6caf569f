// Facts about a scene that moves in the headset: it plays, rests by the panel and by a button, steps, is scrubbed, and never holds a frame
// up.
#include "engine/picture/metrics.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/app/view/view_panel.h"
#include "tests/engine/stream/moving_frames.h"

#include <doctest/doctest.h>

TEST_SUITE_BEGIN("view_moving");

namespace view_moving_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr int kFrames = 12;
const std::string kStart = "rate 45\nsize 96 96\nframes every 1\ncontroller left 0 position -0.2 1.2 -0.35 turn 0 -80\n";
const std::string kArguments = "slide --load-first --mode shared --hide-hands --scene-rate 15 ";

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) { ++found; }
    return found;
}

bool isSame(const ViewRun& run, std::size_t a, std::size_t b) { return run.eye(a, 0).values == run.eye(b, 0).values; }

struct Sliding : Workplace {
    Sliding() { writeSliding((path / "slide").string(), kFrames, 2000); }
};

}  // namespace

TEST_CASE("a moving scene plays, rests while a button has it rest, and plays on") {
    const Sliding work;
    const ViewRun run = runView(work, "play", kStart + "press right a 1 1.2\npress left x 2 2.2\nat 3 exit\n", kArguments + "--hide-panel",
                                kValidated + " SIMULATED_OPENXR_CLOCK=real");
    checkClean(run);
    const std::string& output = run.outcome.output;
    INFO(output);
    CHECK(output.find("a moving scene of 12 frames, 15 a second") != std::string::npos);
    const std::size_t rests = output.find("rests at frame"), plays = output.find("plays from frame");
    CHECK(rests < plays);
    CHECK(plays != std::string::npos);
    // It moves, and while it rests nothing does.
    const double begin_ns = run.frames.front().at("display_time_ns");
    std::size_t others = 0, same_at_rest = 0, at_rest = 0;
    for (std::size_t frame = 8; frame + 3 < run.frames.size(); ++frame) {
        const double time_s = 1e-9 * (run.frames[frame].at("display_time_ns").get<double>() - begin_ns);
        const bool is_rest = time_s > 1.4 && time_s < 1.9;
        at_rest += is_rest ? 1 : 0;
        const bool same = isSame(run, frame, frame + 1);
        same_at_rest += is_rest && same ? 1 : 0;
        others += !is_rest && !same ? 1 : 0;
    }
    CHECK(others > 3);
    CHECK(at_rest > 3);
    CHECK(same_at_rest == at_rest);
}

TEST_CASE("the panel has it rest, steps, and goes to a frame") {
    const Sliding work;
    const ViewRun look = runView(work, "look", "rate 90\nsize 64 64\nframes none\nat 0.1 exit\n", kArguments);
    checkClean(look);
    const Panel panel = panelOf(look, 8);
    glm::dvec2 end = placeOfTime("frame", false);
    end.x = 0.96;
    const ViewRun run =
        runView(work, "panel",
                "rate 90\nsize 64 64\nframes none\n" +
                    clickOn(panel, {placeOfTime("Time", true, PanelPage::kView), placeOfTime("Pause", true), placeOfTime("Step on", false),
                                    placeOfTime("Step on", false), placeOfTime("Step back", false), end, placeOfTime("Step on", false),
                                    placeOfTime("Play", false)}),
                kArguments);
    checkClean(run);
    const std::string& output = run.outcome.output;
    INFO(output);
    CHECK(count(output, "rests at frame 12 of 12") >= 1);
    CHECK(count(output, "rests at frame 1 of 12") >= 1);  // the one after the last
    CHECK(count(output, "plays from frame 1 of 12") == 1);
    CHECK(count(output, "rests at frame ") >= 6);
    CHECK(count(output, "scene frames that came late: ") == 1);
    CHECK(count(output, "frames that waited for them: 0\n") == 1);
}

}  // namespace view_moving_test
