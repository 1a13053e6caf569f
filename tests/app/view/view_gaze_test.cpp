// The viewer in a headset that tracks the wearer's gaze or takes foveated insets: the picture is sharp where
// the wearer looks, if the wearer allows it.
#include "engine/builtin/procedural.h"
#include "tests/app/view/view_acts.h"

SUITE(view_gaze) {

// Tiles of the right-hand picture that were chosen for their error: they are tinted magenta.
struct Chosen {
    std::size_t pixels = 0;
    double middle = 0.0;  // their mean position, from the left edge (0) to the right one (1)
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

// The atelier with fewer splats, lit once for all runs.
std::string room() {
    static const Workplace made;
    if (!made.holds("room.ply")) { made.go("scene atelier --splats 40000 --out room.ply"); }
    const View view = *builtinView("atelier");
    return (made.path / "room.ply").string() + viewedFrom(view.eye, view.look, view.up);
}

ViewRun look(const Workplace& work, const std::string& keys, const std::string& script, int frames) {
    const std::string config =
        "[stereo]\nmode = \"predicted\"\nperiphery = \"full\"\nbudget = 0.04\nmove_cost = 0\nfoveation = 8\n";
    return runClean(work, script,
                    fmt::format("{}{} --axes view --frames {} --load-first --hide-panel --hide-hands", room(),
                                withConfig(work, config + "[view]\ntint = true\n" + keys), frames));
}

std::size_t viewsOf(const ViewRun& run, std::size_t frame) {
    return run.layers(frame, "projection").at(0).at("views").size();
}

TEST_CASE_FIXTURE(AtWork, "what is rendered again follows the eyes, and goes back when they are lost") {
    // The wearer looks to the left, from 0.55 s on to the right, and from 0.8 s on the gaze is lost.
    const ViewRun run =
        look(work, "eye-tracking = true\n",
             "rate 20\nsize 384 384\nframes from 6 to 36 every 5\n"
             "gaze 0.3 25 0\ngaze 0.35 25 0\ngaze 0.5 25 0\ngaze 0.55 -25 0\nat 0.8 gaze off\n",
             37);
    const Chosen left = findChosen(run, 6), right = findChosen(run, 16), lost = findChosen(run, 36);
    CHECK(std::min(left.pixels, right.pixels) > 1000);
    CHECK(left.middle < 0.35);   // measured: 0.21
    CHECK(right.middle > 0.75);  // measured: 0.80
    // While the gaze is known, and for less than a blink's time after the loss, the choice follows it; then
    // it moves back, and in the end it is as if the eyes had never been tracked.
    CHECK(findChosen(run, 11).middle == right.middle);
    // Measured: 0.58 and 0.46.
    CHECK(findChosen(run, 26).middle == between(lost.middle + 0.05, right.middle - 0.1));
    CHECK(lost.middle == between(0.4, 0.6));
    CHECK(lost.middle == findChosen(run, 31).middle);
    // The program does not print where the wearer looks.
    CHECK_FALSE(run.says("gaze"));
}

TEST_CASE_FIXTURE(AtWork, "where the eyes may not or cannot be seen, they are taken to look ahead") {
    for (const auto& [keys, line] :
         {std::pair("", ""), std::pair("eye-tracking = true\n", "eye-tracking refused\n"),
          std::pair("eye-tracking = true\n", "extension XR_EXT_eye_gaze_interaction off\n")}) {
        CAPTURE(line);
        // Fewer and smaller frames.
        const ViewRun run =
            look(work, keys,
                 std::string(
                     "rate 20\nsize 256 256\nframes from 6 to 10 every 4\ngaze 0.35 25 0\ngaze 0.4 -25 0\n") +
                     line,
                 11);
        const Chosen left = findChosen(run, 6), right = findChosen(run, 10);
        CHECK(left.pixels > 300);
        CHECK(left.middle == right.middle);
        // Only a few tiles, so the bounds lie between those for gazes to the left and right above.
        CHECK(left.middle == between(0.35, 0.75));
    }
}

TEST_CASE_FIXTURE(AtWork, "with foveation each eye has an inset, as good as the full picture there") {
    // 45 degrees to each side in 256 pixels, half of both for the inset: its pixels lie as the full
    // picture's.
    constexpr std::uint32_t kSize = 256, kQuarter = kSize / 4;
    const std::string begin =
        "rate 50\nsize 256 256\ninset 26.565051177 size 128 128\nframes from 9 to 9 every 1\n";
    const auto runInset = [&](const std::string& script, double foveation, bool wanted) {
        const std::string keys =
            fmt::format("[stereo]\nfoveation = {}\n{}foveated-inset = {}\n", foveation, kMethodPage, wanted);
        return runClean(work, script,
                        "builtin:fence --mode two-pass --frames 200 --load-first --hide-panel --hide-hands" +
                            withConfig(work, keys));
    };
    Acts acts(begin);
    acts.press("right b");
    for (const char* mode : {"mono", "predicted", "temporal"}) { acts.click(onMethod(mode)); }
    // A session that follows a lost one has insets, too.
    acts.at("lose-session").wait(0.3);
    const std::string rest = begin + "at 0.2 exit\n";
    const ViewRun full = runInset(rest, 0.0, true), inset = runInset(acts, 20.0, true);
    CHECK(viewsOf(full, 9) == 2);
    std::size_t drawn = 0;
    for (std::size_t frame = 0; frame < inset.frames.size(); ++frame) {
        if (inset.layers(frame, "projection").empty()) { continue; }
        ++drawn;
        CHECK(viewsOf(inset, frame) == 4);
    }
    CHECK(drawn > 40);
    CHECK(inset.lines("axes follow the view: the headset takes insets").size() == 1);
    checkOrder(inset,
               {"mode = \"mono\"", "mode = \"predicted\"", "mode = \"temporal\"", "another one begins"});
    CHECK(inset.layers(inset.frameAt(acts.now_s - 0.1), "projection").size() == 1);
    for (const int side : {0, 1}) {
        const Image whole = full.eye(9, side), both = inset.eye(9, side);
        const auto psnrOf = [&](glm::uvec2 from, glm::uvec2 to) {
            return compare(partOf(whole, from, to), partOf(both, from, to)).psnrDb();
        };
        CHECK(psnrOf({kQuarter, kQuarter}, {3 * kQuarter, 3 * kQuarter}) >= 40.0);
        CHECK(psnrOf({0, 0}, {kSize, kQuarter}) < 36.0);  // at half the size
    }
    // The insets exist only if they were requested and if the runtime offers them.
    CHECK(viewsOf(runInset(rest, 20.0, false), 9) == 2);
    CHECK(viewsOf(runInset("extension XR_VARJO_quad_views off\n" + rest, 20.0, true), 9) == 2);
}

TEST_CASE_FIXTURE(AtWork, "an inset follows the gaze only where the wearer lets it and the headset can") {
    const std::string script =
        "rate 50\nsize 64 64\ninset 20 size 40 40 moving 24 20\nframes none\ngaze 0 15 0\nat 0.3 exit\n";
    for (const auto& [line, asked, follows] :
         {std::tuple("", false, false), std::tuple("", true, true),
          std::tuple("eye-tracking off\n", true, false),
          std::tuple("extension XR_VARJO_foveated_rendering off\n", true, false)}) {
        CAPTURE(line);
        const std::string keys = fmt::format("[stereo]\nfoveation = 20\n[view]\neye-tracking = {}\n", asked);
        const ViewRun run =
            runClean(work, line + script,
                     "builtin:one-splat --load-first --hide-panel --hide-hands" + withConfig(work, keys));
        const std::size_t frame = run.frames.size() - 4;
        REQUIRE(viewsOf(run, frame) == 4);
        const double left_rad = run.view(frame, 2).at("fov").at("left").get<double>();
        CHECK(left_rad == doctest::Approx(glm::radians(follows ? -35.0 : -20.0)).epsilon(1e-3));
        // In the size that the runtime wants for that.
        const auto rect = run.view(frame, 2).at("rect").get<std::array<int, 4>>();
        CHECK(these(rect[2], rect[3]) == (follows ? these(24, 20) : these(40, 40)));
    }
}

}  // SUITE(view_gaze)
