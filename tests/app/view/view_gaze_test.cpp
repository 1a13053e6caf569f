// The viewer where the headset sees where its wearer looks: what is rendered again follows, if the wearer lets it.
#include "engine/scene/procedural.h"
#include "tests/app/view/view_runs.h"

#include <algorithm>
#include <tuple>

TEST_SUITE_BEGIN("view_gaze");

namespace view_gaze_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// A right-hand picture that is tinted by what made it: tiles that were chosen for their error are magenta.
struct Chosen {
    std::size_t pixels = 0;
    double middle = 0.0;  // of them, from the left edge (0) to the right one (1)
};

Chosen findChosen(const ViewRun& run, std::size_t frame) {
    const Image picture = run.eye(frame, 1);
    Chosen chosen;
    for (std::size_t i = 0; i < picture.pixelCount(); ++i) {
        const float* c = &picture.values[i * static_cast<std::size_t>(picture.channels)];
        if (c[0] - c[1] < 0.12f || c[2] - c[1] < 0.12f) { continue; }
        ++chosen.pixels;
        chosen.middle += (static_cast<double>(i % picture.size_px.x) + 0.5) / picture.size_px.x;
    }
    chosen.middle /= static_cast<double>(std::max<std::size_t>(chosen.pixels, 1));
    return chosen;
}

// The wearer looks to the left, from 0.55 s on to the right, and from 0.8 s on nobody sees where. 20 frames a second.
const std::string kLooks =
    "rate 20\nsize 384 384\nframes from 6 to 36 every 5\n"
    "gaze 0.3 25 0\ngaze 0.35 25 0\ngaze 0.5 25 0\ngaze 0.55 -25 0\nat 0.8 gaze off\n";

// The same in fewer and smaller frames, without the loss.
const std::string kShort = "rate 20\nsize 256 256\nframes from 6 to 10 every 4\ngaze 0.35 25 0\ngaze 0.4 -25 0\n";

// The atelier of fewer splats, lit once for all runs.
std::string room() {
    static const Workplace made;
    const std::filesystem::path file = made.path / "room.ply";
    if (!std::filesystem::exists(file)) { REQUIRE(made.run("scene atelier --splats 40000 --out room.ply").exit_code == 0); }
    const View view = *builtinView("atelier");
    return fmt::format("{} --eye {},{},{} --look {},{},{}", file.string(), view.eye.x, view.eye.y, view.eye.z, view.look.x, view.look.y,
                       view.look.z);
}

ViewRun look(const Workplace& work, const std::string& name, const std::string& keys, const std::string& script, int frames) {
    std::ofstream(work.path / (name + ".toml")) << "[stereo]\nmode = \"predicted\"\nperiphery = \"full\"\nbudget = 0.04\nmove_cost = 0\n"
                                                << keys;
    return runView(work, name, script,
                   fmt::format("{} --config {}.toml --frames {} --load-first --hide-panel --hide-hands", room(), name, frames));
}

}  // namespace

TEST_CASE("what is rendered again follows the eyes, and goes back to the lens's middle when they are lost") {
    const Workplace work;
    const ViewRun run = look(work, "follow", "foveation = 8\n[view]\ntint = true\neye-tracking = true\n", kLooks, 37);
    checkClean(run);
    const Chosen left = findChosen(run, 6), right = findChosen(run, 16), lost = findChosen(run, 36);
    CHECK(left.pixels > 1000);
    CHECK(right.pixels > 1000);
    CHECK(left.middle < 0.35);   // measured: 0.21
    CHECK(right.middle > 0.75);  // measured: 0.80
    // While it is seen, and less than a blink's time after the loss, it is where it was; then on its way, and in the end as if nobody had
    // ever seen the eyes.
    CHECK(findChosen(run, 11).middle == right.middle);
    const double on_way = findChosen(run, 26).middle;
    CHECK(on_way < right.middle - 0.1);
    CHECK(on_way > lost.middle + 0.05);  // measured: 0.58 and 0.46
    CHECK(lost.middle > 0.4);
    CHECK(lost.middle < 0.6);
    CHECK(lost.middle == findChosen(run, 31).middle);
    // Nobody is told where the wearer looks.
    CHECK(run.outcome.output.find("gaze") == std::string::npos);
}

TEST_CASE("where the wearer does not let the viewer see them, or the headset cannot, the eyes are taken to look ahead") {
    const Workplace work;
    const std::string tint = "foveation = 8\n[view]\ntint = true\n", allowed = tint + "eye-tracking = true\n";
    for (const auto& [name, keys, script] :
         {std::tuple("not_asked", tint, kShort), std::tuple("refused", allowed, kShort + "eye-tracking refused\n"),
          std::tuple("no_extension", allowed, kShort + "extension XR_EXT_eye_gaze_interaction off\n")}) {
        CAPTURE(name);
        const ViewRun run = look(work, name, keys, script, 11);
        checkClean(run);
        const Chosen left = findChosen(run, 6), right = findChosen(run, 10);
        CHECK(left.pixels > 300);
        CHECK(left.middle == right.middle);
        // Of a few tiles: beside those of a wearer who looks to the left or to the right, see above.
        CHECK(left.middle > 0.35);
        CHECK(left.middle < 0.75);
    }
}

}  // namespace view_gaze_test
