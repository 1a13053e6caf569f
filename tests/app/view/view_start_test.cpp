// Facts about where the wearer stands: wherever a runtime's spaces begin, whenever it recentres them, and however large the scene is.
#include "engine/geometry.h"
#include "engine/picture/metrics.h"
#include "tests/app/view/view_runs.h"

#include <doctest/doctest.h>

TEST_SUITE_BEGIN("view_start");

namespace view_start_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::string kSmall = "rate 100\nsize 128 128\nframes every 5\n";
const std::string kScene = "builtin:fence --load-first --hide-hands --mode shared";
// What a picture loses where the runtime turns it by the last digit of a float.
constexpr double kSamePictureDb = 28.0, kOtherPictureDb = 25.0;

// Where the panel hangs, in the room.
glm::dvec3 panelPlace(const ViewRun& run, std::size_t frame) {
    const auto p = run.layers(frame, "quad").at(0).at("pose").at("position").get<std::array<double, 3>>();
    return {p[0], p[1], p[2]};
}

// The eyes, in the room.
glm::dvec3 eyePlace(const ViewRun& run, std::size_t frame, std::size_t side) {
    const auto p = run.layers(frame, "projection").at(0).at("views").at(side).at("pose").at("position").get<std::array<double, 3>>();
    return {p[0], p[1], p[2]};
}
void checkAtTheBeginning(const ViewRun& run, std::size_t frame) {
    CAPTURE(frame);
    CHECK(glm::length(eyePlace(run, frame, kLeft) - glm::dvec3(-0.0315, 0.0, 0.0)) < 1e-5);
    CHECK(glm::length(eyePlace(run, frame, kRight) - glm::dvec3(0.0315, 0.0, 0.0)) < 1e-5);
}

// What a wearer sees whose runtime does nothing special, once for all cases.
const ViewRun& usualRun() {
    static const Workplace work;
    static const ViewRun run = runView(work, "usual", kSmall + "at 0.15 exit\n", kScene);
    return run;
}

double likeness(const ViewRun& a, std::size_t frame_a, const ViewRun& b, std::size_t frame_b) {
    return compare(a.eye(frame_a, kLeft), b.eye(frame_b, kLeft)).psnrDb();
}

bool says(const ViewRun& run, const std::string& words) { return run.outcome.output.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("the wearer begins at the scene's own view, wherever the runtime's spaces begin and the head is") {
    const Workplace work;
    const ViewRun& usual = usualRun();
    checkClean(usual);
    CHECK(says(usual, "1.60 m above the floor"));
    // The first true pose of the head counts: it looks aside and up, and before it was lost.
    const ViewRun away = runView(work, "away",
                                 kSmall +
                                     "local position 5 0.3 2 turn 40 0\nhead 0 position 0.4 1.25 -0.3 turn -130 0\n"
                                     "at -1 head off\nat 0.05 head on\nat 0.15 exit\n",
                                 kScene);
    checkClean(away);
    CHECK(says(away, "1.25 m above the floor"));
    checkAtTheBeginning(usual, 10);
    checkAtTheBeginning(away, 10);
    CHECK(likeness(usual, 10, away, 10) > kSamePictureDb);
    CHECK(glm::length(panelPlace(usual, 10) - panelPlace(away, 10)) < 1e-5);
    // Upright, too: a tilted head sees a tilted scene.
    const ViewRun tilted = runView(work, "tilted", kSmall + "head 0 turn -130 25\nat 0.15 exit\n", kScene);
    CHECK(likeness(usual, 10, tilted, 10) < kOtherPictureDb);
    CHECK(std::abs(panelPlace(usual, 10).y - panelPlace(tilted, 10).y) < 1e-5);
}

TEST_CASE("of a runtime without a stage no floor is known") {
    const Workplace work;
    const ViewRun run = runView(work, "floorless", kSmall + "stage off\nextension XR_EXT_local_floor off\nat 0.1 exit\n", kScene);
    checkClean(run);
    CHECK(says(run, "the room now begins where the wearer stands\n"));
}

TEST_CASE("without a stage the floor is that of LOCAL_FLOOR") {
    const Workplace work;
    const std::string script = kSmall + "stage off\nhead 0 position 0.2 1.45 0.1\nat 0.1 exit\n";
    // Elder validation layers do not know that space.
    const ViewRun run = runView(work, "local-floor", script, kScene, "DISPLAY= WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1");
    INFO(run.outcome.errors);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.errors.empty());
    CHECK(says(run, "the room now begins where the wearer stands, 1.45 m above the floor"));
    // Who does not make it, though it is offered, keeps nobody out.
    const ViewRun refused = runView(work, "refused", script, kScene);
    CHECK(refused.outcome.exit_code == 0);
    CHECK((says(refused, "the room now begins where the wearer stands\n") || says(refused, "1.45 m above the floor")));
}

TEST_CASE("a head of which only the turn is known is placed by its turn, and again once its place is known") {
    const Workplace work;
    const ViewRun run = runView(
        work, "turning", kSmall + "head 0 position 0.5 1.5 0 turn 90 0\nat -1 head turn-only\nat 0.08 head on\nat 0.15 exit\n", kScene);
    checkClean(run);
    const ViewRun& usual = usualRun();
    for (const std::size_t frame : {5, 10}) {
        checkAtTheBeginning(run, frame);
        CHECK(likeness(usual, 10, run, frame) > kSamePictureDb);
    }
    CHECK(says(run, "frame 8: the room now begins where the wearer stands, 1.50 m above the floor"));
}

TEST_CASE("when the runtime recentres, the wearer is back at the beginning and the panel before the eyes") {
    const Workplace work;
    const ViewRun run = runView(work, "recentre",
                                kSmall +
                                    "head 0 position 0 1.6 0\nhead 0.1 position 0 1.6 0\nhead 0.15 position 0.8 1.4 0.5 turn 70 0\n"
                                    "at 0.22 recentre\nat 0.3 exit\n",
                                kScene);
    checkClean(run);
    CHECK(likeness(run, 5, run, 20) < kOtherPictureDb);
    for (const std::size_t frame : {5, 22, 23, 25}) { checkAtTheBeginning(run, frame); }
    CHECK(likeness(run, 5, run, 25) > kSamePictureDb);
    CHECK(says(run, "frame 22: the room now begins where the wearer stands, 1.40 m above the floor"));
    CHECK(glm::length(panelPlace(run, 5) - panelPlace(run, 25)) < 1e-5);
}

TEST_CASE("the near plane is in metres of the wearer, however large the scene is") {
    const Workplace work;
    // A metre is four scene units: the fence, a unit ahead, is nearer than 0.3 m.
    const std::string camera = "--eye 0,0,0 --look 0,0,3 --up 0,-1,0 --mode two-pass --metres-per-unit 0.25";
    const ViewRun run =
        runView(work, "near", kSmall + "at 0.1 exit\n", "builtin:fence --load-first --hide-panel --hide-hands --near 0.3 " + camera);
    checkClean(run);
    const auto rendered = [&](const std::string& near) {
        REQUIRE(work.run("render builtin:fence --out expected --size 128x128 --fov-x 90 " + camera + " --near " + near).exit_code == 0);
        return readPicture(work.path / "expected" / "left.png");
    };
    CHECK(compare(run.eye(5, kLeft), rendered("1.2")).psnrDb() > 45.0);
    CHECK(compare(run.eye(5, kLeft), rendered("0.3")).psnrDb() < kOtherPictureDb);
    const auto layers = run.layers(5, "projection");
    for (const auto& view : layers.at(0).at("views")) {
        // Depth 0 is infinitely far, so that 1, the far end to OpenXR, is the near plane.
        CHECK(view.at("depth").at("far").get<double>() == doctest::Approx(0.3));
    }
}

}  // namespace view_start_test
