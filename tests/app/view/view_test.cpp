// Facts about `binosplat view`, driven through the standard OpenXR loader by scripts of the simulated
// headset: what is seen, and where.
#include "engine/picture/turned.h"
#include "tests/app/view/view_acts.h"

SUITE(view) {

// An asymmetric, canted headset.
const char* const kHeadset =
    "name = \"Test\"\nsource = \"made up\"\nsize = \"192x176\"\ncanting_deg = 7.0\neye_distance_m = 0.066\n"
    "[left]\nleft = -48.0\nright = 36.0\nup = 40.0\ndown = -44.0\n"
    "[right]\nleft = -36.0\nright = 48.0\nup = 40.0\ndown = -44.0\n";

// builtin:step-edge: a grey wall of 0.75 at depth 2 ends at about x = 0, with a darker one behind it.
constexpr double kWallDepth = 2.0;
constexpr float kHalfway = 0.575f;

// Where the wall's edge crosses a row, in pixels; empty if it does not.
std::optional<double> findEdge(const Image& picture, std::uint32_t row) {
    const auto grey = [&](std::uint32_t x) { return colourAt(picture, {x, row})[0]; };
    for (std::uint32_t x = picture.size_px.x - 1; x > 0; --x) {
        if (grey(x - 1) < kHalfway || grey(x) >= kHalfway) { continue; }
        return x - 0.5 + static_cast<double>((grey(x - 1) - kHalfway) / (grey(x - 1) - grey(x)));
    }
    return std::nullopt;
}

// The edge in the scene, if the wall is where it should be: its mean x, and the largest deviation from that.
struct Edge {
    double x, unevenness;
};
Edge measureEdge(const LoggedEye& eye, const Image& picture) {
    std::vector<double> places;
    for (std::uint32_t row = picture.size_px.y / 3; row < picture.size_px.y * 2 / 3; ++row) {
        const std::optional<double> column = findEdge(picture, row);
        if (!column) { continue; }
        const double x = *column / picture.size_px.x, y = (row + 0.5) / picture.size_px.y;
        const glm::dvec3 ray = eye.orientation * glm::dvec3(eye.left + x * (eye.right - eye.left),
                                                            eye.up + y * (eye.down - eye.up), -1.0);
        // The scene's depth is -z of STAGE.
        places.push_back((eye.position + ray * ((-kWallDepth - eye.position.z) / ray.z)).x);
    }
    REQUIRE(places.size() > 40);
    const double mean =
        std::accumulate(places.begin(), places.end(), 0.0) / static_cast<double>(places.size());
    const auto [least, most] = std::ranges::minmax(places);
    return {mean, std::max(most - mean, mean - least)};
}

// `made`: the right eye was reprojected, so its silhouettes may be off by most of a pixel of 0.02.
void checkEdge(const ViewRun& run, std::size_t frame, bool made) {
    CAPTURE(frame);
    const Edge left = measureEdge(run.loggedEye(frame, 0), run.eye(frame, kLeft));
    const Edge right = measureEdge(run.loggedEye(frame, 1), run.eye(frame, kRight));
    CHECK(left.unevenness < 0.01);
    CHECK(right.unevenness < (made ? 0.02 : 0.01));
    CHECK(std::abs(left.x - right.x) < (made ? 0.02 : 0.004));
    CHECK(std::abs(left.x) < 0.06);
}

// For pictures from where the wearer begins. Two of the same view may differ a little, since the runtime
// turns them by the last digit of a float.
const std::string kBeginning = "rate 100\nsize 128 128\nframes every 5\n";
constexpr double kSamePictureDb = 28.0, kOtherPictureDb = 25.0;

void checkAtTheBeginning(const ViewRun& run, std::size_t frame) {
    CAPTURE(frame);
    CHECK(glm::distance(run.viewPlace(frame, kLeft), {-0.0315, 0.0, 0.0}) < 1e-5);
    CHECK(glm::distance(run.viewPlace(frame, kRight), {0.0315, 0.0, 0.0}) < 1e-5);
}

glm::dvec3 panelInRoom(const ViewRun& run, std::size_t frame) {
    return poseOf(run.panels(frame).at(0).at("pose")).position;
}

TEST_CASE_FIXTURE(AtWork, "in every mode a wall's edge stays straight and in its place, depth too") {
    // Asymmetric and canted; then another pose with a tilted head; then other angles.
    const std::string left = "eye left angles -48 36 40 -44", right = "eye right angles -36 48 40 -44";
    Acts acts("rate 50\nsize 208 192\nframes every 5\nipd 0.068\neye left cant 8\neye right cant 8\n" + left +
              "\n" + right + "\n");
    const std::vector<std::string> modes{"two-pass", "shared", "predicted"};
    std::vector<double> looks;
    for (const std::string& mode : modes) {
        if (mode != modes[0]) { acts.click(onMethod(mode)); }
        looks.push_back(acts.look());
        acts.head("position 0.2 1.7 -0.3 rotation 0.05 0.1 0.12 0.98");
        looks.push_back(acts.look());
        acts.at("eye left angles -40 50 30 -50").at("eye right angles -30 35 45 -35");
        looks.push_back(acts.look(0.12));
        acts.at(left).at(right).head("position 0 1.6 0 turn 0 0");
    }
    for (const char* mode : {"mono", "reproject"}) {
        acts.click(onMethod(mode));
        looks.push_back(acts.look());
    }
    const ViewRun run =
        runClean(work, acts,
                 "builtin:step-edge --load-first --hide-hands --eye 0,0,0 --look 0,0,4 --mode two-pass" +
                     withConfig(work, kMethodPage));
    CHECK(run.says("the runtime asked for the end"));
    for (std::size_t i = 0; i < looks.size(); ++i) {
        const std::size_t frame = run.pictureAt(looks[i]);
        CHECK(run.frames[frame].at("session_state") == "FOCUSED");
        for (const std::size_t side : {0, 1}) { CHECK_MESSAGE(run.view(frame, side).contains("depth"), i); }
        if (i < 3 * modes.size()) { checkEdge(run, frame, i >= 6); }
    }
    // Swapped eyes would be noticed.
    const std::size_t first = run.pictureAt(looks[0]);
    const Edge in_right = measureEdge(run.loggedEye(first, 1), run.eye(first, kLeft));
    const Edge in_left = measureEdge(run.loggedEye(first, 0), run.eye(first, kRight));
    CHECK(std::abs(in_right.x - in_left.x) > 0.05);
}

TEST_CASE_FIXTURE(AtWork, "the wearer sees what render makes of the same poses and angles") {
    work.write("headset.toml", kHeadset);
    // From (0.05, -0.1, 0.2) in the scene; later a step, a turn and a tilt of the head, and another mode.
    const std::string start = "--eye 0.05,-0.1,0.2 --look 0.05,-0.1,3 --up 0,-1,0",
                      dominant = " --dominant right --mode ";
    Acts acts("headset headset.toml\nframes from 30 to 90 every 60\n");
    acts.wait(0.2).press("right b").click(onMethod("predicted")).press("right b");
    acts.head("position 0.12 1.52 -0.25 rotation 0.08 -0.15 0.06 0.98").wait(1.1 - acts.now_s);
    const ViewRun run = runClean(work, acts,
                                 "builtin:fence --load-first --hide-panel --hide-hands --axes view " + start +
                                     dominant + "two-pass" + withConfig(work, kMethodPage));
    const glm::dvec3 eye(0.05, -0.1, 0.2);
    checkAgreesWithRender(work, run, 30, eye, "--headset headset.toml" + dominant + "two-pass");
    checkAgreesWithRender(work, run, 90, eye, "--headset headset.toml" + dominant + "predicted");
}

// What the eye saw, as an opaque picture for showTurned.
Image opaqueEye(const ViewRun& run, std::size_t frame, std::size_t side) {
    const Image seen = run.eye(frame, static_cast<int>(side));
    Image opaque{seen.size_px, 4, std::vector<float>(4 * seen.pixelCount(), 1.0f)};
    for (std::size_t i = 0; i < 3 * seen.pixelCount(); ++i) {
        opaque.values[i / 3 * 4 + i % 3] = seen.values[i];
    }
    return opaque;
}

TEST_CASE_FIXTURE(AtWork, "while the head turns, axes that stay show the view's but for one resampling") {
    work.write("headset.toml", kHeadset);
    // There and back by some ten degrees, half a degree per frame, with a step and a tilt.
    const std::string script =
        "rate 50\nheadset headset.toml\nframes every 5\nhead 0.4 position 0 1.6 0 turn 0 0\n"
        "head 0.8 position 0.05 1.6 0 rotation -0.02 -0.04 0.01 1\nhead 1.2 position 0.05 1.62 -0.05 "
        "rotation 0.02 0.05 0.03 1\nat 1.3 "
        "exit\n";
    const auto runWith = [&](const std::string& axes) {
        return runClean(work, script,
                        "builtin:fence --load-first --hide-panel --hide-hands --mode shared --axes " + axes);
    };
    const ViewRun view = runWith("view"), stay = runWith("stay");
    std::size_t moves = 0;
    for (std::size_t frame = 10; frame < 65; ++frame) {
        CAPTURE(frame);
        for (const std::size_t side : {0, 1}) {
            const nlohmann::json now = stay.view(frame, side), before = stay.view(frame - 1, side);
            CHECK(now.at("pose").at("position") == view.view(frame, side).at("pose").at("position"));
            CHECK(now.at("swapchain") == before.at("swapchain"));
            CHECK(now.at("rect").at(2) > 192);
            moves += now.at("pose").at("orientation") != before.at("pose").at("orientation") ? 1 : 0;
            if (!stay.frames[frame].contains("picture")) { continue; }
            const Image followed = opaqueEye(view, frame, side), stayed = opaqueEye(stay, frame, side);
            if (frame <= 20) {
                CHECK(stayed.values == followed.values);
                continue;
            }
            // Measured: between 36.8 and 41.2 dB. Resampling twice by half a pixel costs 32.7 to 33.6, and a
            // pose that is off by one pixel gives at most 26.6.
            const LoggedEye logged = stay.loggedEye(frame, side);
            const ViewAngles angles{std::atan(logged.left), std::atan(logged.right), std::atan(logged.up),
                                    std::atan(logged.down)};
            const Eye eye{{}, intrinsicsFromAngles(angles, followed.size_px), followed.size_px};
            const auto turned = [&](double px) {
                Eye other = eye;
                other.world_from_camera.orientation =
                    glm::angleAxis(px / eye.intrinsics.fx, glm::normalize(glm::dvec3(1.0, 1.0, 0.0)));
                return other;
            };
            const Image twice = showTurned(showTurned(followed, eye, turned(0.7)), turned(0.7), eye);
            const double bound_db = compare(twice, followed).psnrDb();
            CHECK(compare(stayed, followed).psnrDb() > bound_db);
            CHECK(compare(showTurned(stayed, eye, turned(1.0)), followed).psnrDb() < bound_db);
        }
    }
    CHECK(moves == 2 * 3);  // in the 40 frames in which the head turned
}

TEST_CASE_FIXTURE(AtWork, "two runs with the virtual clock write the same files") {
    const std::string script =
        "rate 90\nsize 96 96\nframes every 3\nhead 0 position 0 1.6 0\nhead 0.2 position 0.1 1.6 -0.1 turn "
        "10 5\n";
    for (const char* name : {"first", "second"}) {
        checkClean(runView(work, name, script, kWall + " --hide-panel --frames 22"));
    }
    CHECK(work.runCommand("diff -r first second").exit_code == 0);
}

TEST_CASE_FIXTURE(AtWork, "--frames counts those of the scene, not those before it is loaded") {
    const ViewRun run = runClean(work, "rate 90\nsize 96 96\nframes none\n",
                                 "builtin:fence --mode shared --hide-hands --hide-panel --frames 12");
    const std::vector<std::string> shows = run.lines("shows builtin:fence");
    REQUIRE(shows.size() == 1);
    const std::size_t before = frameOf(shows[0]);
    CHECK(before > 4);                                             // in lock-step they come at once
    CHECK(run.frames.size() == within(before + 12, before + 16));  // STOPPING takes a few frames
}

TEST_CASE_FIXTURE(AtWork, "the wearer begins at the scene's own view, also when the room recentres") {
    const std::string scene = "builtin:fence --load-first --hide-hands --mode shared";
    const ViewRun usual =
        runClean(work,
                 kBeginning +
                     "head 0 position 0 1.6 0\nhead 0.1 position 0 1.6 0\n"
                     "head 0.15 position 0.8 1.4 0.5 turn 70 0\nhead 0.6 position 0.8 1.4 0.5 turn 70 0\n"
                     "head 0.65 position 0.8 1.4 0.5 turn -130 25\n"
                     "at 0.22 recentre\nat 0.7 recentre\nat 1.2 exit\n",
                 scene);
    CHECK(usual.says("1.60 m above the floor"));
    CHECK(usual.says("frame 22: the room now begins where the wearer stands, 1.40 m above the floor"));
    for (const std::size_t frame : {5, 10, 22, 23, 25, 105}) { checkAtTheBeginning(usual, frame); }
    CHECK(usual.likeness(5, 20) < kOtherPictureDb);
    CHECK(usual.likeness(5, 55) > kSamePictureDb);  // out of the dark
    CHECK(glm::length(panelInRoom(usual, 5) - panelInRoom(usual, 25)) < 1e-5);
    // The scene is also upright: a tilted head sees it tilted.
    CHECK(usual.likeness(5, 105) < kOtherPictureDb);
    CHECK(std::abs(panelInRoom(usual, 5).y - panelInRoom(usual, 105).y) < 1e-5);
    // The head's first valid pose counts. Here it is lost at once, and then only its orientation is known.
    const ViewRun away =
        runClean(work,
                 kBeginning +
                     "local position 5 0.3 2 turn 40 0\nhead 0 position 0.4 1.25 -0.3 turn -130 0\n"
                     "at -1 head off\nat 0.05 head turn-only\nat 0.12 head on\nat 0.5 exit\n",
                 scene);
    CHECK(away.says("frame 12: the room now begins where the wearer stands, 1.25 m above the floor"));
    for (const std::size_t frame : {10, 15}) {
        checkAtTheBeginning(away, frame);
        CHECK(std::abs(poseOf(away.view(frame).at("pose")).orientation.w) > 1.0 - 1e-9);
    }
    CHECK(compare(usual.eye(5, kLeft), away.eye(45, kLeft)).psnrDb() > kSamePictureDb);
    CHECK(glm::length(panelInRoom(usual, 5) - panelInRoom(away, 15)) < 1e-5);
}

TEST_CASE_FIXTURE(AtWork, "the room begins anew where the headset is put on; jumps come out of the dark") {
    const ViewRun run =
        runClean(work,
                 "size 64 64\nframes every 1\nhead 0 position 0 0.8 0\nhead 0.3 position 0 0.8 0\n"
                 "head 0.4 position 1 1.6 0 turn 40 0\nat 0 present off\nat 0.5 present on\nat 1.2 exit\n",
                 kWall + " --hide-panel --mode mono");
    const std::vector<std::string> begins = run.lines("the room now begins where the wearer stands");
    REQUIRE(begins.size() == 2);
    // As it was on the desk, after a dark frame.
    CHECK(run.likeness(run.frameAt(1.0), run.frameAt(0.2)) > 40.0);
    const auto light = [&](std::size_t frame) {
        const Image seen = run.eye(frame, kLeft);
        return std::accumulate(seen.values.begin(), seen.values.end(), 0.0f);
    };
    const std::size_t dark = frameOf(begins[1]);
    CHECK(light(dark) < 0.01f * light(run.frameAt(1.0)));
    CHECK(light(dark + 10) < 0.9f * light(dark + 18));
    CHECK(run.quadsWhere(run.frameAt(1.0), [](const auto&) { return true; }).empty());
}

TEST_CASE_FIXTURE(AtWork, "with the panel hidden a message is a line before the eyes, for some seconds") {
    const ViewRun run = runClean(work, "size 64 64\nframes none\npress right thumbstick 0.5 0.6\nat 8 exit\n",
                                 kOneSplat + " --hide-panel --mode mono");
    CHECK(run.says("this scene has no viewpoints"));
    for (const auto& [seconds, count] : {std::pair(0.4, 0u), {1.0, 1u}, {5.0, 1u}, {7.5, 0u}}) {
        CHECK(run.beforeEyes(run.frameAt(seconds)).size() == count);
    }
}

TEST_CASE_FIXTURE(AtWork, "the near plane is in metres of the wearer, however large the scene is") {
    // A metre is four scene units, so the fence, one unit ahead, is nearer than 0.3 m.
    const std::string camera = "--eye 0,0,0 --look 0,0,3 --up 0,-1,0 --mode two-pass --metres-per-unit 0.25";
    const ViewRun run = runClean(work, kBeginning + "at 0.1 exit\n",
                                 "builtin:fence --load-first --hide-panel --hide-hands --near 0.3 " + camera);
    const auto rendered = [&](const std::string& near) {
        work.go("render builtin:fence --order distance --out expected --size 128x128 --fov-x 90 " + camera +
                " --near " + near);
        return readPicture(work.path / "expected" / "left.png");
    };
    CHECK(compare(run.eye(5, kLeft), rendered("1.2")).psnrDb() > 45.0);
    CHECK(compare(run.eye(5, kLeft), rendered("0.3")).psnrDb() < kOtherPictureDb);
    for (const std::size_t side : {0, 1}) {
        // Depth 0 is infinitely far away, so 1, OpenXR's far end, is the near plane.
        CHECK(run.view(5, side).at("depth").at("far").get<double>() == doctest::Approx(0.3));
    }
}

TEST_CASE_FIXTURE(AtWork, "what the runtime refuses it names, and the program where that is described") {
    fs::create_directories(work.path / "mine");
    work.write("mine/frame_000000.png", "holiday");
    work.write("broken.script", "size 64 64\nwalk somewhere\n");
    for (const auto& [options, error] :
         {std::pair(" --out mine", "mine/frame_000000.png: not what an earlier run left here, must be moved"),
          std::pair(" --out mine", "--out: the simulated headset does not start with mine"),
          std::pair(" broken.script", "broken.script, see docs/simulated_script.md")}) {
        const Outcome outcome =
            work.run("view builtin:fence --simulate" + std::string(options), "DISPLAY= WAYLAND_DISPLAY=");
        CHECK(outcome.exit_code == 1);
        CHECK_MESSAGE(contains(outcome.errors, error), outcome.errors);
        CHECK_FALSE(contains(outcome.errors, "start one (Monado"));
    }
    CHECK(these(work.bytesOf("mine/frame_000000.png"), work.holds("mine/frames.jsonl")) ==
          these("holiday", false));
}

}  // SUITE(view)
