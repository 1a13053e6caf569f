// Facts about how the wearer moves: by sticks, pads, hands and viewpoints, and along the ground.
#include "tests/app/camera_file.h"
#include "tests/app/view/view_acts.h"

SUITE(view_walk) {

const std::string kBlind = "rate 100\nsize 64 64\nframes none\n", kScene = kWall + " --mode mono";
const glm::dvec2 kMiddle(0.5, 0.5);

TEST_CASE_FIXTURE(AtWork, "who follows the ground walks down a slope, by the depth of what was seen") {
    // The wall as a slope that falls by 10 degrees in the direction of view, with the feet on it.
    const double tilt = glm::radians(10.0), half = std::sqrt(0.5);
    const glm::dvec3 along(half, 0.0, half), out(half, 0.0, -half);
    const glm::dvec3 up = std::cos(tilt) * out - std::sin(tilt) * along,
                     ahead = std::cos(tilt) * along + std::sin(tilt) * out;
    const glm::dvec3 eye = glm::dvec3(0.0, 0.0, 4.0) - 1.2 * along + 1.6 * up;
    const glm::dvec2 keep = onScenes("Keep this one");
    Acts acts(kBlind);
    acts.click(keep).right(kRightDown).push("left thumbstick", {0.0, 1.0}, 0.8).wait(1.1).click(keep);
    static_cast<void>(runClean(work, acts.wait(0.1).script(),
                               kScene + viewedFrom(eye, eye + ahead, up) +
                                   withConfig(work, kScenesPage + "follow-ground = true\n")));
    const auto kept = keptPlaces(work);
    REQUIRE(kept.size() == 2);
    const glm::dvec3 way = kept[1].eye - kept[0].eye;
    CHECK(glm::dot(way, ahead) == doctest::Approx(1.2).epsilon(0.05));
    CHECK(-glm::dot(way, up) / glm::dot(way, ahead) == between(0.8 * std::tan(tilt), 1.2 * std::tan(tilt)));
}

TEST_CASE_FIXTURE(AtWork, "sticks, pads, hands, viewpoints and buttons move the wearer, nothing else") {
    work.go("scene one-splat --out a.ply");
    work.write("cameras.json", "[" + cameraJson("door", {0, 0, 0}) + "," + cameraJson("window", {0.5, 0, 0}) +
                                   "," + cameraJson("stairs", {0, 0, 0.5}) + "]");
    Acts acts("rate 50\nsize 64 64\nframes none\n");
    const auto keep = [&] { acts.click(onScenes("Keep this one")).wait(0.05); };
    const auto push = [&](const std::string& stick, const glm::dvec2& to) {
        acts.push(stick, to, 0.1).wait(0.15);
        keep();
    };
    acts.click(onScenes("Next viewpoint")).hold("right thumbstick", 0.08).wait(0.12).press("left thumbstick");
    keep();  // 0: where the camera was
    // A hand holds the scene while the room is recentred elsewhere, and then back again.
    acts.head("position 0.5 1.6 0.4 turn 40 0").hold("left squeeze", 0.18).wait(0.1);
    acts.at("recentre").wait(0.15);
    acts.head("position 0 1.6 0 turn 0 0").wait(0.05).at("recentre").wait(0.1);
    keep();  // 1
    // The stick of the hand that points at the panel does not move the wearer; the other stick does.
    acts.right(kRightDown).left(pointingAt(acts.panel, kMiddle));
    push("left thumbstick", {0.0, 1.0});  // 2
    acts.right(kRightDown);
    push("right thumbstick", {0.0, 1.0});  // 3
    acts.left(kLeftDown);
    push("left thumbstick", {0.0, 1.0});  // 4
    // A push mostly to the side turns and does not lift.
    for (const glm::dvec2& aside : {glm::dvec2(0.9, 0.7), glm::dvec2(-1.0, 0.0)}) {
        acts.right(kRightDown);
        push("right thumbstick", aside);  // 5 and 6
    }
    // A pad moves the wearer while it is pressed, not while a thumb rests on it.
    acts.at("profile htc/vive_controller").wait(0.1).push("left trackpad", {0.0, 1.0}, 1.0).wait(0.1);
    keep();  // 7
    acts.hold("left trackpad", 0.1).wait(0.2);
    keep();  // 8
    acts.at("profile oculus/touch_controller").wait(0.4);
    // A scene held by one hand moves as far as the hand does, and does not turn about it.
    acts.hold("left squeeze", 0.2).wait(0.04).left("position -0.1 1.4 -0.65 turn 30 -60", 0.1).wait(0.1);
    keep();  // 9
    // Both hands turn and enlarge it, and tilt it if that is allowed; then it is levelled.
    const auto roll = [&](const std::string& left, const std::string& right) {
        acts.left(kLeftDown).right(kRightDown).hold("left squeeze", 0.34).hold("right squeeze", 0.34);
        acts.wait(0.05).left("position " + left + " turn 0 -80", 0.1);
        acts.right("position " + right + " turn 0 -80", 0.1).wait(0.1);
        keep();  // 10 and 11
    };
    const auto click = [&](const char* widget) {
        acts.click(onScenes("View")).click(placeOf(widget)).click(placeOf("Scenes"));
    };
    roll("-0.3 1.3 -0.3", "0.4 1.3 -0.5");
    click("Two-handed tilt");
    roll("-0.17 1.1 -0.35", "0.17 1.3 -0.35");
    click("Level");
    keep();  // 12
    acts.click(onScenes("View")).head("position 0.4 1.5 0.3 turn 50 0").click(placeOf("Recentre")).wait(0.1);
    const double recentred = acts.look();
    const ViewRun run = runClean(work, acts,
                                 "a.ply --load-first --mode mono --hide-hands --metres-per-unit 0.5 --eye "
                                 "0,0,1 --look 0,0,3 --up 0,-1,0" +
                                     withConfig(work, kScenesPage));
    checkOrder(run, {"viewpoint 1 of 3: door", "viewpoint 2 of 3: window", "viewpoint 1 of 3: door",
                     "this viewpoint is kept",
                     "the room now begins where the wearer stands, 1.50 m above the floor"});
    const auto kept = keptPlaces(work);
    REQUIRE(kept.size() == 13);
    const auto isNear = [](const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-6) {
        return glm::distance(a, b) < tolerance;
    };
    const auto ahead = [&](std::size_t i) { return kept[i].look - kept[i].eye; };
    const auto step = [&](std::size_t i) { return kept[i].eye - kept[i - 1].eye; };
    const glm::dvec3 nowhere(0.0), up(0.0, -1.0, 0.0);
    CHECK(isNear(kept[0].eye, nowhere));
    for (const std::size_t i : {1, 2, 5, 6, 7, 12}) { CHECK_MESSAGE(isNear(step(i), nowhere), i); }
    // A unit is half a metre, in our axes: x right, y down, z ahead.
    CHECK(step(3).y < -0.05);
    CHECK(isNear(step(4), {0.0, 0.0, step(4).z}));
    for (const std::size_t i : {4, 8}) { CHECK_MESSAGE(step(i).z > 0.1, i); }
    CHECK(isNear(ahead(5), {1.0, 0.0, std::sqrt(3.0)}, 1e-5));  // by 30 degrees
    CHECK(isNear(ahead(6), {0.0, 0.0, 2.0}, 1e-5));
    // The wearer's room moves through the scene by as much the other way.
    CHECK(isNear(step(9), {-0.2, 0.4, -0.6}, 1e-4));
    CHECK(isNear(ahead(9), {0.0, 0.0, 2.0}, 1e-4));
    CHECK(glm::length(ahead(10)) < 1.5);
    CHECK(std::abs(ahead(10).x) > 0.1);
    for (const std::size_t i : {9, 10, 12}) { CHECK(isNear(kept[i].up, up, 2e-6)); }
    CHECK(glm::dot(kept[11].up, up) < 0.92);
    CHECK(isNear(run.viewPlace(run.frameAt(recentred), kLeft), {-0.0315, 0.0, 0.0}, 1e-5));
}

TEST_CASE_FIXTURE(AtWork, "a gamepad walks and turns, goes to viewpoints, and hides the panel") {
    work.go("scene one-splat --out a.ply");
    work.write("a.viewpoints.json", R"({"viewpoints": [
        {"name": "door", "eye": [0.5, 0, 0], "look": [0.5, 0, 3], "up": [0, -1, 0]},
        {"name": "window", "eye": [0, 0, 0.5], "look": [0, 0, 3], "up": [0, -1, 0]}]})");
    const glm::dvec2 keep = onScenes("Keep this one");
    Acts acts(kBlind);
    acts.click(keep).right(kRightDown).push("gamepad thumbstick_left", {0.0, 1.0}, 0.2).wait(0.25);
    acts.click(keep).right(kRightDown).push("gamepad thumbstick_right", {1.0, 0.0}, 0.1).wait(0.15);
    acts.click(keep);
    acts.press("gamepad shoulder_right").press("gamepad shoulder_right").press("gamepad shoulder_left");
    const double shown = acts.look();
    const double hidden = acts.press("gamepad b").look();
    const double again = acts.press("gamepad menu").look();
    const ViewRun run = runClean(work, acts,
                                 "a.ply --load-first --mode mono --hide-hands --eye 0,0,0 --look 0,0,3 --up "
                                 "0,-1,0" +
                                     withConfig(work, kScenesPage));
    for (const double seconds : {shown, hidden, again}) {
        CHECK(run.panels(run.frameAt(seconds)).empty() == (seconds == hidden));
    }
    const std::vector<std::string> went = run.lines(": viewpoint ");
    INFO(run.outcome.output);
    REQUIRE(went.size() == 3);
    const auto kept = keptPlaces(work);
    REQUIRE(kept.size() == 5);
    CHECK(kept[3].eye.z - kept[2].eye.z == between(0.2, 0.4));
    const glm::dvec3 ahead = glm::normalize(kept[4].look - kept[4].eye);
    CHECK(ahead.x == doctest::Approx(0.5));
    CHECK(went[2] != went[1]);
}

TEST_CASE_FIXTURE(AtWork, "the view's edge is dark while a stick moves the wearer, its middle is not") {
    Acts acts("rate 100\nsize 64 64\nframes every 5\nblend-modes opaque alpha-blend\n");
    const auto walk = [&] { return acts.push("left thumbstick", {0.0, 0.2}, 0.3).wait(0.2).look(); };
    const double before = acts.look();
    const double during = walk();
    const double after = acts.wait(0.4).look();
    acts.click(placeOf("Vignette", true));
    const double without = walk();
    acts.wait(0.05);
    for (const char* widget : {"Hands", "Passthrough", "Teleport"}) { acts.click(placeOf(widget, true)); }
    const double end = acts.look();
    // Nothing is visible in the direction of view.
    const ViewRun run = runClean(work, acts,
                                 "builtin:slanted-wall --load-first --mode mono --background 1,1,1 --eye "
                                 "0,0,0 --look 0,0,-9 --up 0,-1,0");
    checkOrder(run, {"vignette = false", "hands = false", "passthrough = true", "locomotion = \"teleport\""});
    for (const double seconds : {before, after, without, during}) {
        CHECK(run.beforeEyes(run.frameAt(seconds)).size() == (seconds == during ? 1 : 0));
    }
    // In the corner, above the middle, and in it.
    const auto seenAt = [&](double seconds) {
        const Image eye = run.eye(run.pictureAt(seconds), kLeft);
        return std::array{colourOf(eye, 1, 1).r, colourOf(eye, 32, 1).r, colourOf(eye, 32, 32).r};
    };
    const auto light = seenAt(before), dark = seenAt(during);
    CHECK(dark[0] < 0.5f * light[0]);
    CHECK(dark[1] < 0.7f * light[1]);
    CHECK(dark[2] == light[2]);
    for (const double seconds : {after, without}) { CHECK(seenAt(seconds) == light); }
    const auto hands = [&](double seconds) { return run.quadsAsWide(run.frameAt(seconds), 0.3).size(); };
    CHECK(these(hands(before), hands(end)) == these(2, 0));
    CHECK(run.at(before).at("blend_mode") == "OPAQUE");
    CHECK(run.at(end).at("blend_mode") == "ALPHA_BLEND");
}

}  // SUITE(view_walk)
