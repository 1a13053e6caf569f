// Facts about `binosplat view` when the headset misbehaves: it carries on or ends cleanly, within the frames of the script.
#include "engine/geometry.h"
#include "tests/view_runs.h"

#include <doctest/doctest.h>

using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::string kSmall = "rate 90\nsize 128 128\nframes none\n";

ViewRun runTrouble(const Workplace& work, const std::string& lines, const std::string& arguments = "builtin:fence --load-first") {
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

TEST_CASE("a lost session or runtime is a clean end, whenever it comes") {
    const Workplace work;
    for (const char* time : {"0", "0.01", "0.02", "0.2"}) {
        CHECK(runTrouble(work, fmt::format("at {} lose-session\n", time)).outcome.output.find("lost") != std::string::npos);
        const std::string words = runTrouble(work, fmt::format("at {} lose-instance\n", time)).outcome.output;
        CHECK((words.find("going away") != std::string::npos || words.find("LOST") != std::string::npos));
    }
}

TEST_CASE("an exit request before the first picture, and while the scene still loads, is obeyed") {
    const Workplace work;
    runTrouble(work, "at 0 exit\n");
    runTrouble(work, "at 0.05 exit\n", "builtin:atelier");
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
    const ViewRun run = runTrouble(work, "at 0.1 eye left angles -60 20 30 -50\nat 0.15 eye right angles -20 60 50 -20\nat 0.25 exit\n");
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
    const std::string script = "rate 90\nsize 200 200\nframes every 4\n", end = "at 0.12 eye left angles -45 60 45 -45\nat 0.25 exit\n";
    for (const std::string mode : {"shared", "predicted", "mono"}) {
        CAPTURE(mode);
        const std::string arguments = "builtin:fence --load-first --hide-panel --mode " + mode;
        const ViewRun without = runView(work, "without-" + mode, script + end, arguments);
        const ViewRun with = runView(work, "with-" + mode, script + "visibility-mask on\n" + end, arguments);
        checkClean(with);
        CHECK(without.outcome.output.find("the lenses hide") == std::string::npos);
        const std::string& output = with.outcome.output;
        const std::size_t first = output.find(": the lenses hide 23 and 23 of 169 tiles");
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
               "visibility-mask on\nat 0.05 controller right off\nat 0.06 controller left off\nat 0.1 controller right on\nat 0.15 exit\n");
    runTrouble(work, "extension XR_KHR_visibility_mask off\nextension XR_KHR_composition_layer_depth off\nat 0.1 exit\n");
}

TEST_CASE("a runtime without the Vulkan extension is refused in one line") {
    const Workplace work;
    const ViewRun run = runView(work, "refused", kSmall + "extension XR_KHR_vulkan_enable2 off\n", "builtin:fence", "");
    CHECK(run.outcome.exit_code == 3);
    CHECK(run.outcome.errors.find("XR_KHR_vulkan_enable2") != std::string::npos);
    CHECK(std::count(run.outcome.errors.begin(), run.outcome.errors.end(), '\n') == 1);
}
