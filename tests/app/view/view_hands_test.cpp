// Facts about controllers and hands: what buttons and sticks do, and what one sees of hands.
#include "app/view/room/arc_picture.h"
#include "tests/app/view/view_acts.h"

SUITE(view_hands) {

const std::string kSmall = "rate 100\nsize 128 128\nframes every 5\n";
// For tests that do not look at the headset's pictures.
const std::string kBlind = "rate 100\nsize 64 64\nframes none\n";
const std::string kScene = kWall + " --mode mono",
                  kWithHands = "builtin:slanted-wall --load-first --mode mono";
const std::string kTeleports = kScenesPage + "locomotion = \"teleport\"\n";
const glm::dvec2 kMiddle(0.5, 0.5);

// The slanted wall, seen straight on.
const std::string kAtWall = " --eye 0,0,0 --look 0,0,9 --up 0,-1,0";

glm::dvec3 stagePlace(const nlohmann::json& quad) { return stagePose(quad).position; }
glm::dvec3 alongOf(const nlohmann::json& quad) { return stagePose(quad).orientation * glm::dvec3(0, 1, 0); }
double heightOf(const nlohmann::json& quad) { return quad.at("size").at(1).get<double>(); }
nlohmann::json rectOf(const nlohmann::json& quad) { return quad.at("views").at(0).at("rect"); }

// Widths of pictures: a hand, the parts of a controller, and the mark where a teleport ends.
constexpr double kHand = 0.3, kKnob = 0.055, kHandle = 0.035, kTarget = 0.5;
std::size_t countSeen(const ViewRun& run, double seconds, double width_m) {
    return run.quadsAsWide(run.frameAt(seconds), width_m).size();
}

// Pulses that the right hand feels during these frames.
std::size_t pulses(const ViewRun& run, std::size_t first, std::size_t count) {
    std::size_t found = 0;
    for (std::size_t i = first; i < first + count; ++i) {
        for (const auto& event : run.frames.at(i).at("events")) {
            found += event.get<std::string>().starts_with("haptic right") ? 1 : 0;
        }
    }
    return found;
}

// The pose of a hand that squeezes and carries the panel 0.2 m up.
std::string highUp(Pose panel, const glm::dvec2& share = kMiddle) {
    panel.position.y += 0.2;
    return pointingAt(panel, share);
}
void checkLifted(const ViewRun& run, double seconds) {
    const glm::dvec3 way = panelOf(run, run.frameAt(seconds)).position - panelBefore().position;
    CHECK(glm::distance(glm::dvec2(way), glm::dvec2(0.0, 0.2)) < 0.002);
}

void checkSaidAt(const ViewRun& run, const std::string& line, double seconds) {
    const double said_s = ViewRun::secondsOf(run.frames.at(frameOf(line)));
    CHECK_MESSAGE(said_s == between(seconds - 0.03, seconds + 0.08), line);
}

// What shows the panel, clicks, carries and walks; empty if there is nothing that does.
struct Controller {
    std::string profile, menu = "b", trigger = "trigger", fist = "squeeze", stick = "thumbstick";
    double begin_s = 0.0, carried_s = 0.0, walked_s = 0.0;
};

TEST_CASE_FIXTURE(AtWork, "every controller and bare hands show the panel, click and are felt") {
    std::vector<Controller> controllers;
    for (const std::string& usual :
         wordsIn("oculus/touch_controller valve/index_controller hp/mixed_reality_controller "
                 "htc/vive_cosmos_controller htc/vive_focus3_controller bytedance/pico_neo3_controller "
                 "bytedance/pico4_controller facebook/touch_controller_pro meta/touch_controller_plus "
                 "bytedance/pico_ultra_controller_bd varjo/xr-4_controller yvr/touch_controller_yvr "
                 "oppo/mr_controller_oppo")) {
        controllers.push_back({usual});
    }
    for (const Controller& other : {Controller{"microsoft/motion_controller", "menu"},
                                    {"htc/vive_controller", "menu", "trigger", "squeeze", "trackpad"},
                                    {"samsung/odyssey_controller", "menu"},
                                    {"bytedance/pico_g3_controller", "menu", "trigger", ""},
                                    {"ml/ml2_controller", "menu", "trigger", "shoulder", "trackpad"},
                                    {"valve/frame_controller_valve", "menu"},
                                    {"khr/simple_controller", "menu", "select", "", ""},
                                    {"huawei/controller", "back", "trigger", "", "trackpad"},
                                    {"khr/generic_controller", "secondary"},
                                    {"logitech/mx_ink_stylus_logitech", "cluster_front_logitech",
                                     "cluster_middle_logitech", "cluster_back_logitech", ""}}) {
        controllers.push_back(other);
    }
    Acts acts(kBlind);
    acts.point(kBeside).wait(0.4 - acts.now_s);
    // Each for a fifth of a second.
    for (auto& [profile, menu, trigger, fist, stick, begin_s, carried_s, walked_s] : controllers) {
        begin_s = acts.now_s;
        acts.at("profile " + profile).wait(0.045).hold("right " + trigger, 0.03);
        acts.wait(0.05).hold("right " + menu, 0.02).wait(0.05).hold("right " + menu, 0.02).wait(0.055);
        // A fist carries the panel up and back down, and the left stick, or a pad that is pressed, walks.
        if (!fist.empty()) { acts.hold("right " + fist, 0.09); }
        carried_s = acts.wait(0.019).right(highUp(acts.panel, kBeside), 0.02).look(0.02);
        acts.right(pointingAt(acts.panel, kBeside), 0.02).wait(0.019);
        if (stick == "trackpad") { acts.hold("left trackpad", 0.05); }
        if (!stick.empty()) { acts.push("left " + stick, {0.0, 1.0}, 0.05); }
        walked_s = acts.wait(0.04).look(0.06);
    }
    // Buttons of other controllers are pressed before the right one.
    std::vector<double> clicks, lifts, palms;
    const auto take = [&](const std::string& profile, const std::string& other, const std::string& click,
                          const std::string& widget) {
        acts.at("profile " + profile).wait(0.05).point(onMethod(widget)).press("right " + other);
        clicks.push_back(acts.now_s);
        acts.press("right " + click);
    };
    const double bare_begin = acts.now_s;
    for (const auto& [profile, other, click, fist, widget] :
         {std::tuple("ext/hand_interaction_ext", "trigger", "aim_activate_ext", "grasp_ext", "right"),
          std::tuple("microsoft/hand_interaction", "aim_activate_ext", "select", "squeeze", "left")}) {
        take(profile, other, click, widget);
        // A fist carries the panel up and back down.
        acts.point(kMiddle).hold("right " + std::string(fist), 0.35).wait(0.05);
        lifts.push_back(acts.right(highUp(acts.panel), 0.1).look(0.05));
        acts.point(kMiddle).wait(0.2);
        // With the palm turned to the eyes, a pinch hides the panel, and shows it.
        acts.left("position -0.2 1.4 -0.4 look 0.694 1.4 -0.847").wait(0.03);
        for (int i = 0; i < 2; ++i) { palms.push_back(acts.press("left " + std::string(click)).look(0.02)); }
        acts.left(kLeftDown);
    }
    const double bare_end = acts.now_s;
    take("oculus/touch_controller", "aim_activate_ext", "trigger", "right");
    const ViewRun run = runClean(work, acts, kScene + withConfig(work, kMethodPage));
    for (const Controller& one : controllers) {
        CAPTURE(one.profile);
        const std::size_t first = run.frameAt(one.begin_s);
        CHECK(pulses(run, first + 3, 6) == (one.profile == "bytedance/pico_g3_controller" ? 0 : 1));
        CHECK(these(run.panels(first + 8).size(), run.panels(first + 13).empty(),
                    run.panels(first + 19).size()) == these(1, true, 1));
        const double risen_m = panelOf(run, run.frameAt(one.carried_s)).position.y - acts.panel.position.y;
        CHECK(std::abs(risen_m - (one.fist.empty() ? 0.0 : 0.2)) < 0.002);
        CHECK(run.beforeEyes(run.frameAt(one.walked_s)).empty() == one.stick.empty());
    }
    const std::size_t bare = run.frameAt(bare_begin) + 1;
    CHECK(pulses(run, bare, run.frameAt(bare_end) - bare) == 0);
    for (const double lifted_s : lifts) { checkLifted(run, lifted_s); }
    REQUIRE(palms.size() == 4);
    for (std::size_t i = 0; i < palms.size(); ++i) {
        CAPTURE(i);
        CHECK(run.panels(run.frameAt(palms[i])).size() == i % 2);
    }
    const std::vector<std::string> changes = run.lines("dominant = ");
    INFO(run.outcome.output);
    REQUIRE(changes.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(changes[i].ends_with(i == 1 ? "\"left\"" : "\"right\""));
        checkSaidAt(run, changes[i], clicks[i]);
    }
}

TEST_CASE_FIXTURE(AtWork, "a grip that shivers holds; what was pressed elsewhere counts once let go") {
    Acts acts(kBlind + "profile valve/index_controller\n");
    std::vector<double> looks, clicks;
    // The last one lets go halfway up.
    using Grip = std::vector<std::pair<double, double>>;
    for (const Grip& grip :
         {Grip{{0, 0}, {0.05, 0.45}}, Grip{{0, 0}, {0.05, 0.6}, {0.15, 0.35}, {0.4, 0.35}, {0.42, 0}},
          Grip{{0, 0}, {0.05, 1}, {0.19, 1}, {0.2, 0.2}}}) {
        acts.point(kMiddle).wait(0.05).pull("right squeeze", grip).wait(0.1);
        acts.right(highUp(acts.panel), 0.2).wait(0.15);
        looks.push_back(acts.look(0.05));
        acts.press("right b").press("right b");
    }
    // Another program had the input, or another session of this one.
    acts.point(placeOf("Vignette", true));
    for (const std::string elsewhere : {"focused off", "lose-session"}) {
        for (const std::string button : {"right trigger", "right b"}) {
            acts.at(elsewhere).wait(0.01).hold(button, 0.24).wait(0.09);
            if (elsewhere == "focused off") { acts.at("focused on"); }
            acts.wait(0.17);
            looks.push_back(acts.look(0.03));
            clicks.push_back(acts.now_s);
            acts.press(button);
            looks.push_back(acts.look(0.02));
            acts.wait(0.05);
        }
        acts.press("right b");
    }
    const ViewRun run = runClean(work, acts, kScene);
    const auto lifted = [&](std::size_t i) {
        return panelOf(run, run.frameAt(looks[i])).position.y - acts.panel.position.y;
    };
    CHECK(lifted(0) == doctest::Approx(0.0));
    checkLifted(run, looks[1]);
    CHECK(lifted(2) == between(0.05, 0.15));
    const std::vector<std::string> changes = run.lines("vignette = ");
    INFO(run.outcome.output);
    REQUIRE(changes.size() == 2);
    for (const std::size_t i : {0, 1}) {
        CAPTURE(i);
        checkSaidAt(run, changes[i], clicks[2 * i]);
        // A button that is held hides nothing; when pressed again, it does.
        CHECK(run.panels(run.frameAt(looks[3 + 4 * i + 2])).size() == 1);
        CHECK(run.panels(run.frameAt(looks[3 + 4 * i + 3])).empty());
    }
}

TEST_CASE_FIXTURE(AtWork, "rays, hands and the panel are where they should be, and either hand clicks") {
    const glm::dvec3 right_at(0.2, 1.2, -0.35), left_at(-0.2, 1.2, -0.35);
    Acts acts(kSmall);
    acts.right(lookingAt(right_at, acts.panel.position)).left(lookingAt(left_at, {-0.2, 0.2, -1.0}));
    const double both = acts.wait(0.03).look();
    const double lost = acts.at("controller right off").look();
    acts.at("controller right on").wait(0.05).press("left y");
    // Without the panel, a ray shows while the trigger is pulled.
    const double hidden = acts.look(0.05);
    const double pulled = acts.hold("right trigger", 0.1).wait(0.03).look();
    const double let_go = acts.wait(0.03).look(0.05);
    acts.right(lookingAt({0.1, 1.5, -0.4}, {0.1, 1.5, -1.0})).wait(0.05);
    const double open = acts.look();
    const double fist = acts.hold("right squeeze", 0.2).wait(0.05).look();
    acts.wait(0.1).head("position 1 1.6 0 turn 90 0").press("right b");
    const double moved = acts.look(0.05);
    const double gone = acts.press("left y").look(0.05);
    acts.head("position 0 1.6 0 turn 0 0").press("left y");
    // Both hands point at the panel; the left one clicks on Quit, although the right one hovers elsewhere.
    acts.right(lookingAt(right_at, {-0.45, 1.7, -0.9}));
    acts.left(pointingAt(acts.panel, placeOf("Quit"))).wait(0.05).press("left trigger").wait(1.0);
    // The runtime offers no passthrough.
    const ViewRun run = runClean(
        work, acts, kWithHands + " --background 1,0,0" + withConfig(work, "[view]\npassthrough = true\n"));
    CHECK(run.endSeconds() < acts.now_s - 0.5);
    CHECK(run.at(hidden).at("blend_mode") == "OPAQUE");
    const glm::vec3 corner = colourOf(run.eye(run.pictureAt(hidden), kLeft), 0, 0);
    CHECK(corner.r - corner.g > 0.97f);
    const auto rays = run.rays(run.frameAt(both));
    REQUIRE(rays.size() == 2);
    CHECK(heightOf(rays[0]) < 0.5);
    CHECK(rectOf(rays[0]) != rectOf(rays[1]));
    const glm::dvec3 half = 0.5 * heightOf(rays[1]) * alongOf(rays[1]), middle = stagePlace(rays[1]);
    const auto fromEnd = [&](const glm::dvec3& place) {
        return std::min(glm::distance(middle + half, place), glm::distance(middle - half, place));
    };
    CHECK(fromEnd(right_at) < 1e-4);
    CHECK(fromEnd(acts.panel.position) < 1e-3);
    CHECK(these(countSeen(run, both, kHand), countSeen(run, both, kKnob)) == these(2, 0));
    const std::size_t one = run.frameAt(lost) + 1;
    CHECK(these(run.rays(one).size(), run.quadsAsWide(one, kHand).size()) == these(1, 1));
    for (const double seconds : {hidden, gone}) { CHECK(run.panels(run.frameAt(seconds)).empty()); }
    for (const double seconds : {hidden, let_go}) { CHECK(run.rays(run.frameAt(seconds)).empty()); }
    CHECK(run.rays(run.frameAt(pulled)).size() == 1);
    CHECK(std::ranges::count_if(run.quadsAsWide(run.frameAt(open), kHand), [](const auto& hand) {
              return glm::distance(stagePlace(hand), {0.1, 1.5, -0.4}) < 0.1;
          }) == 1);
    // A fist looks different from an open hand. It holds the scene, which does not move with it.
    CHECK(run.likeness(run.pictureAt(open), run.pictureAt(fist)) == between(15.0, 45.0));
    // The head looks along -x, from (1, 1.6, 0).
    CHECK(glm::distance(panelOf(run, run.frameAt(moved)).position, {0.1, 1.5, 0.45}) < 1e-4);
}

TEST_CASE_FIXTURE(AtWork, "a ring shows where a ray meets the scene; a blocked arc leads nowhere") {
    Acts acts(kSmall);
    const glm::dvec2 keep = onScenes("Keep this one");
    acts.click(keep).right(lookingAt({0.05, 1.2, -0.4}, {0.05, 1.2, -1.0})).wait(0.05);
    const double points = acts.look();
    acts.right(lookingAt({0.05, 1.2, -0.4}, {0.05, 1.2, 1.0})).wait(0.05);
    const double away = acts.look();
    acts.right(lookingAt({0.05, 1.2, -0.4}, {0.05, 1.6, -1.0}));
    const double throws = acts.hold("right trigger", 0.3).wait(0.1).look();
    const ViewRun run = runClean(work, acts.wait(0.2).click(keep).wait(0.1).script(),
                                 kWithHands + kAtWall + withConfig(work, kTeleports));
    // 0.4 m below the eyes and 0.05 m to the right of them the wall is 4.05 m away.
    const auto rings = [&](double seconds) {
        return run.quadsWhere(run.frameAt(seconds), [](const nlohmann::json& quad) {
            const double distance_m = glm::distance(stagePlace(quad), glm::dvec3(0.0, 1.6, 0.0));
            return quad.at("space") != "VIEW" && std::abs(heightOf(quad) - 0.025 * distance_m) < 1e-4;
        });
    };
    REQUIRE(rings(points).size() == 1);
    CHECK(glm::distance(stagePlace(rings(points)[0]), glm::dvec3(0.05, 1.2, -4.05)) < 0.1);
    CHECK(rings(away).empty());
    CHECK(rings(throws).empty());
    const auto ends = run.quadsAsWide(run.frameAt(throws), kTarget);
    REQUIRE(ends.size() == 1);
    CHECK(rectOf(ends[0]).at(2) == 96);  // the red target
    const auto kept = keptPlaces(work);
    REQUIRE(kept.size() == 2);
    CHECK(kept[0].eye == kept[1].eye);
}

TEST_CASE_FIXTURE(AtWork, "two ends that a ray clicks on, and a number, give the scene its true size") {
    TextEntry entry;
    entry.open(TextEntry::What::kMetres, "How many metres is it in truth?", "");
    PanelSketch sketch;
    sketch.status.entry = &entry;
    const WidgetPlaces keys = sketch.draw().places;
    // With hands, a palm that faces the eyes would point at nothing.
    Acts acts(kSmall + "extension XR_EXT_hand_tracking off\n");
    acts.click(placeOf("True size"));
    for (const double x : {0.05, 0.65}) {
        acts.right(lookingAt({x, 1.2, -0.4}, {x, 1.2, -1.0})).wait(0.1).press("right trigger").wait(0.05);
    }
    acts.click(shareOf(keys, "2")).click(shareOf(keys, "Done")).wait(1.0);
    const ViewRun run = runClean(work, acts, kWithHands + kAtWall);
    checkOrder(run, {"click on one end", "and now on its other end", "as shown, it is ", "saved as "});
    // The wall is 4 m ahead, and recedes by as much as one goes to the right.
    CHECK(savedOfWall(work, "metres-per-unit") ==
          doctest::Approx(2.0 / (0.6 * std::sqrt(2.0))).epsilon(0.04));
}

TEST_CASE_FIXTURE(AtWork, "controllers are drawn where grips are; one teleports to where the arc ended") {
    const glm::dvec2 keep = onScenes("Keep this one");
    const glm::dvec3 right_at(0.05, 1.2, -0.4);
    Acts acts(kSmall + "extension XR_EXT_hand_tracking off\n", {0.0, 1.3, 0.0});
    acts.right(lookingAt(right_at, {0.05, 1.2, -1.0}));
    const double both = acts.look();
    const double one = acts.at("controller left off").look();
    const double none = acts.at("controller right off").look();
    acts.at("controller left on").at("controller right on").wait(0.05);
    acts.left(lookingAt({-0.2, 0.9, -0.35}, {-0.2, 0.7, -1.0}));
    const double by_stick = acts.push("left thumbstick", {0.0, 1.0}, 0.15).wait(0.06).look();
    const double there = acts.wait(0.02).look(0.05);
    acts.left(kLeftDown).press("left y").click(keep);
    // Controllers without a stick use the trigger.
    acts.at("profile khr/simple_controller");
    acts.right(lookingAt({0.2, 0.9, -0.35}, {0.2, 0.3, -0.75})).wait(0.05);
    const double by_trigger = acts.hold("right select", 0.2).wait(0.05).look();
    acts.wait(0.1).click(keep, "right select").wait(0.1);
    const ViewRun run =
        runClean(work, acts, kWithHands + " --hide-panel" + kAtWall + withConfig(work, kTeleports));
    CHECK(these(countSeen(run, both, kKnob), countSeen(run, both, kHandle)) == these(2, 2));
    const std::size_t frame = run.frameAt(one) + 1;
    CHECK(run.quadsAsWide(frame, kKnob).size() == 1);
    // The handle surrounds the grip, along its axis.
    const auto handles = run.quadsAsWide(frame, kHandle);
    REQUIRE(handles.size() == 1);
    CHECK(glm::distance(stagePlace(handles[0]), right_at) < 0.02);
    CHECK(std::abs(alongOf(handles[0]).z) > 0.999);
    CHECK(run.layers(run.frameAt(none) + 1, "quad").empty());
    CHECK(run.likeness(run.pictureAt(one + 0.01), run.pictureAt(none + 0.01)) < 45.0);
    // The target is shown beforehand.
    const auto pieces = [&](double seconds) {
        return run.quadsWhere(run.frameAt(seconds), [](const nlohmann::json& quad) {
            return these(rectOf(quad).at(2), rectOf(quad).at(3)) == these(kArcPiecePx.x, kArcPiecePx.y);
        });
    };
    CHECK(pieces(by_stick).size() == kArcPieces);
    CHECK(run.beforeEyes(run.frameAt(by_stick)).empty());
    CHECK(these(pieces(there).size(), countSeen(run, there, kTarget)) == these(0, 0));
    CHECK(run.beforeEyes(run.frameAt(there)).size() == 1);  // the dark after a jump
    const auto targetAt = [&](double seconds) {
        const auto found = run.quadsAsWide(run.frameAt(seconds), kTarget);
        REQUIRE(found.size() == 1);
        return poseOf(found[0].at("pose")).position;
    };
    const glm::dvec3 first = targetAt(by_stick), second = targetAt(by_trigger);
    CHECK(first.x == doctest::Approx(-0.2));
    CHECK(first.z < -1.5);
    // 1.3 m below the head, and a little above that.
    for (const glm::dvec3& target : {first, second}) { CHECK(target.y == doctest::Approx(-1.29)); }
    const auto kept = keptPlaces(work);
    REQUIRE(kept.size() == 2);
    CHECK(glm::distance(kept[0].eye, {first.x, 0.0, -first.z}) < 1e-4);
    CHECK(glm::distance(kept[1].eye - kept[0].eye, {second.x, 0.0, -second.z}) < 1e-4);
}

TEST_CASE_FIXTURE(AtWork, "a pinch of bare hands teleports or, pulled aside, turns, without a page") {
    const glm::dvec2 keep = onScenes("Keep this one");
    const std::string pinch = "right aim_activate_ext";
    Acts acts(kBlind + "extension XR_EXT_hand_tracking off\nprofile ext/hand_interaction_ext\n");
    acts.click(keep, pinch).right(lookingAt({0.2, 0.9, -0.35}, {0.2, 0.3, -0.75})).wait(0.05);
    const double throws = acts.hold(pinch, 0.2).wait(0.1).look();
    acts.wait(0.1).click(keep, pinch);
    acts.right(lookingAt({0.2, 0.9, -0.35}, {0.2, 0.3, -0.75})).wait(0.05).hold(pinch, 0.4).wait(0.1);
    acts.right(lookingAt({0.5, 0.9, -0.35}, {0.5, 0.3, -0.75}), 0.1).wait(0.05);
    const double pulled = acts.look();
    acts.wait(0.2).click(keep, pinch).wait(0.1);
    const ViewRun run = runClean(work, acts, kScene + kAtWall + withConfig(work, kScenesPage));
    CHECK(these(countSeen(run, throws, kTarget), countSeen(run, pulled, kTarget)) == these(1, 0));
    CHECK(run.beforeEyes(run.frameAt(pulled)).empty());  // no dark after a turn
    const auto kept = keptPlaces(work);
    REQUIRE(kept.size() == 3);
    // To where the arc met the floor, ahead; then by 30 degrees to the left, on the spot.
    CHECK(kept[1].eye.x - kept[0].eye.x == doctest::Approx(0.2));
    CHECK(kept[1].eye.z - kept[0].eye.z > 0.4);
    CHECK(glm::distance(kept[2].eye, kept[1].eye) < 1e-6);
    CHECK(glm::normalize(kept[2].look - kept[2].eye).x == doctest::Approx(-0.5));
}

}  // SUITE(view_hands)
