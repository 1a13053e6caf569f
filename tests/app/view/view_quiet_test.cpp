// Facts about work in frames that could wait, counted by two layers (tests/faults/waits.h): the frames of a
// running viewer do none.
#include "tests/app/view/view_runs.h"

SUITE(view_quiet) {

// A snap turn, a step, the panel away and back again, a hand that points at it; then the session is lost.
const std::string kStay =
    "rate 45\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\nhead 4 position 0.2 1.6 -0.1 turn 15 0\n"
    "axis right thumbstick 1.2 0 0\naxis right thumbstick 1.21 1 0\naxis right thumbstick 1.3 1 0\naxis right thumbstick 1.31 0 0\n"
    "axis left thumbstick 1.6 0 0\naxis left thumbstick 1.61 0 1\naxis left thumbstick 1.9 0 1\naxis left thumbstick 1.91 0 0\n"
    "press left y 2.2 2.25\npress left y 2.5 2.55\ncontroller right 2.7 position 0.2 1.2 -0.35\n"
    "controller right 2.8 position 0.2 1.2 -0.35 look -0.45 1.5 -0.9\nat 3.2 lose-session\nat 3.6 exit\n";
const std::string kWatched =
    "XDG_CONFIG_HOME=\"$PWD/../config\" DISPLAY= WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1 VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
    "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults XR_API_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
    "/openxr' XR_ENABLE_API_LAYERS=XR_APILAYER_BINOSPLAT_faults BINOSPLAT_FAULT_WAITS=waits.txt "
    "BINOSPLAT_FAULT_TICKS=1";  // frames take no time, so none is drawn smaller to save time

// What frames create or wait for between two times, until that is fixed.
struct Known {
    double begin_s, end_s;
    const char* kinds;
};
constexpr Known kKnown[]{
    // Images are created once the eyes' angles are known.
    {0.0, 1.0, "buffer fence-of-this-frame memory swapchain"},
    // Nothing is known about what a snap turn brings into view: what is visible is counted first, while the
    // device idles.
    {1.2, 1.3, "fence-of-last-frame fence-of-this-frame"},
    {3.2, 9.0, "buffer fence-of-this-frame memory queue swapchain"},
};

TEST_CASE("no frame of a running viewer waits or makes anything after the first second, until its session is lost") {
    for (const std::string mode : {"temporal", "predicted"}) {
        CAPTURE(mode);
        const Workplace work;
        const ViewRun run = runView(work, "stay", kStay, "builtin:slanted-wall --load-first --mode " + mode, kWatched);
        INFO(run.outcome.output << run.outcome.errors);
        CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
        std::map<const Known*, std::set<std::string>> found;
        std::ifstream file(work.path / "waits.txt");
        std::size_t frames = 0;
        for (std::string line; std::getline(file, line); ++frames) {
            const double time_s = static_cast<double>(frames) / 45.0;
            const Known* const known =
                std::ranges::find_if(kKnown, [&](const Known& one) { return time_s >= one.begin_s && time_s < one.end_s; });
            std::istringstream words(line.substr(line.find(' ') + 1));
            CHECK_MESSAGE((known != std::end(kKnown) || line == std::to_string(frames)), line);
            for (std::string kind, count; words >> kind >> count;) { found[known].insert(kind); }
        }
        CHECK(frames == run.frames.size());
        CHECK(run.panels(frames * 2 / 3).empty());
        // All of it must occur, or the entry is out of date.
        for (const Known& known : kKnown) { CHECK(fmt::format("{}", fmt::join(found[&known], " ")) == known.kinds); }
    }
}

TEST_CASE("new letters come without a wait") {
    const Workplace work;
    REQUIRE(work.run("scene one-splat --out '\u05d7\u05d3\u05e8.ply'").exit_code == 0);
    const std::string script = "rate 45\nsize 64 64\nframes none\nat 4 exit\n";
    const ViewRun run =
        runView(work, "letters", script, "'\u05d7\u05d3\u05e8.ply' --load-first", kWatched + " SIMULATED_OPENXR_CLOCK=real");
    INFO(run.outcome.output << run.outcome.errors);
    CHECK(these(run.outcome.exit_code, run.outcome.errors.empty()) == these(0, true));
    std::ifstream file(work.path / "waits.txt");
    const std::string waits((std::istreambuf_iterator<char>(file)), {});
    CHECK(waits.find("image") != std::string::npos);  // the letters' image: nothing else needs one
    CHECK_MESSAGE(waits.find("queue") == std::string::npos, waits);
}

TEST_CASE("what is drawn is where the eyes are by the last that the runtime said") {
    const Workplace work;
    const std::string script = "rate 45\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\nat 1 exit\n";
    const ViewRun run =
        runView(work, "late", script, "builtin:one-splat --load-first --mode predicted --axes view", kWatched + " BINOSPLAT_XR_EARLY=0.01");
    INFO(run.outcome.output << run.outcome.errors);
    REQUIRE(run.frames.size() > 10);
    const std::size_t frame = run.frames.size() / 2;
    const nlohmann::json layer = run.layers(frame, "projection").at(0);
    const LoggedPose room = poseOf(layer.at("stage_from_space"));
    const glm::dvec3 drawn = room.position + room.orientation * run.viewPlace(frame, kLeft);
    CHECK(drawn.y == doctest::Approx(run.loggedEye(frame, kLeft).position.y).epsilon(1e-5));
}

}  // SUITE(view_quiet)
