// Facts about controllers and hands: what buttons and sticks do, and what one sees of hands: rays, arcs, the
// vignette.
#include "app/view/room/arc_picture.h"
#include "tests/app/view/view_acts.h"

SUITE(view_hands) {

const std::string kSmall = "rate 100\nsize 128 128\nframes every 5\n";
// For tests that do not look at the headset's pictures.
const std::string kBlind = "rate 100\nsize 64 64\nframes none\n";
const std::string kScene = kWall + " --mode mono",
                  kWithHands = "builtin:slanted-wall --load-first --mode mono";
const glm::dvec2 kMiddle(0.5, 0.5);

glm::dvec3 stagePlace(const nlohmann::json& quad) { return stagePose(quad).position; }
glm::dvec3 alongOf(const nlohmann::json& quad) {
    return stagePose(quad).orientation * glm::dvec3(0.0, 1.0, 0.0);
}
double heightOf(const nlohmann::json& quad) { return quad.at("size").at(1).get<double>(); }

// Widths by which pictures are recognized: a hand, the parts of a controller, and the mark where a teleport
// ends.
constexpr double kHand = 0.3, kKnob = 0.055, kHandle = 0.035, kTarget = 0.5;
std::size_t countSeen(const ViewRun& run, double seconds, double width_m) {
    return run.quadsAsWide(run.frameAt(seconds), width_m).size();
}
std::size_t countPieces(const ViewRun& run, double seconds) {
    const auto isPiece = [](const nlohmann::json& quad) {
        const nlohmann::json& rect = quad.at("views").at(0).at("rect");
        return these(rect.at(2), rect.at(3)) == these(kArcPiecePx.x, kArcPiecePx.y);
    };
    return run.quadsWhere(run.frameAt(seconds), isPiece).size();
}
std::vector<nlohmann::json> vignettes(const ViewRun& run, std::size_t frame) {
    return run.quadsWhere(frame, [](const nlohmann::json& quad) { return quad.at("space") == "VIEW"; });
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
std::string highUp(const Panel& panel) {
    Panel lifted = panel;
    lifted.middle.y += 0.2;
    return pointingAt(lifted, kMiddle);
}
void checkLifted(const ViewRun& run, double seconds) {
    const glm::dvec3 way = panelOf(run, run.frameAt(seconds)).middle - panelBefore().middle;
    CHECK(these(way.y, way.x) ==
          these(doctest::Approx(0.2).epsilon(0.01), doctest::Approx(0.0).epsilon(0.01)));
}

// The frame in a line is the number of frames before it.
void checkSaidAt(const ViewRun& run, const std::string& line, double seconds) {
    CAPTURE(line);
    const double said_s = ViewRun::secondsOf(run.frames.at(std::stoul(line.substr(line.find(' ')))));
    CHECK(said_s == between(seconds - 0.03, seconds + 0.08));
}

TEST_CASE(
    "every controller and bare hands show the panel, click and are felt; what is not in the hand does "
    "nothing") {
    // Each for a fifth of a second: first those that use B, then those that use a menu button.
    const std::vector<std::string> controllers{
        "oculus/touch_controller",     "valve/index_controller",        "hp/mixed_reality_controller",
        "htc/vive_cosmos_controller",  "htc/vive_focus3_controller",    "bytedance/pico_neo3_controller",
        "bytedance/pico4_controller",  "facebook/touch_controller_pro", "meta/touch_controller_plus",
        "microsoft/motion_controller", "htc/vive_controller",           "samsung/odyssey_controller",
        "khr/simple_controller"};
    const Workplace work;
    Acts acts(kBlind);
    acts.point(kBeside).wait(0.4 - acts.now_s);
    std::vector<double> begins;
    for (const std::string& profile : controllers) {
        begins.push_back(acts.now_s);
        const std::string menu = begins.size() < 10 ? "right b" : "right menu";
        acts.at("profile " + profile)
            .wait(0.045)
            .hold(profile == controllers.back() ? "right select" : "right trigger", 0.03);
        acts.wait(0.05).hold(menu, 0.02).wait(0.05).hold(menu, 0.02).wait(0.055);
    }
    // A fist carries the panel up and back down. Buttons of other controllers are pressed before the right
    // one.
    std::vector<double> clicks, lifts;
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
        acts.point(kMiddle)
            .hold(fmt::format("right {}", fist), 0.35)
            .wait(0.05)
            .move("controller right", highUp(acts.panel), 0.1);
        lifts.push_back(acts.look(0.05));
        acts.point(kMiddle).wait(0.2);
    }
    const double bare_end = acts.now_s;
    take("oculus/touch_controller", "aim_activate_ext", "trigger", "right");
    const ViewRun run = runClean(work, "run", acts.script(), kScene + withConfig(work, kMethodPage));
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        CAPTURE(controllers[i]);
        const std::size_t first = run.frameAt(begins[i]);
        CHECK(pulses(run, first + 3, 6) == 1);
        CHECK(these(run.panels(first + 8).size(), run.panels(first + 13).empty(),
                    run.panels(first + 19).size()) == these(1, true, 1));
    }
    const std::size_t bare = run.frameAt(bare_begin) + 1;
    CHECK(pulses(run, bare, run.frameAt(bare_end) - bare) == 0);
    for (const double lifted_s : lifts) { checkLifted(run, lifted_s); }
    const std::vector<std::string> changes = run.lines("dominant = ");
    INFO(run.outcome.output);
    REQUIRE(changes.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(changes[i].ends_with(i == 1 ? "\"left\"" : "\"right\""));
        checkSaidAt(run, changes[i], clicks[i]);
    }
}

TEST_CASE(
    "a grip that shivers holds the panel, one that only touches does not; what was pressed elsewhere counts "
    "once it was let go") {
    const Workplace work;
    Acts acts(kBlind + "profile valve/index_controller\n");
    std::vector<double> looks, clicks;
    // The last one lets go halfway up.
    using Grip = std::vector<std::pair<double, double>>;
    for (const Grip& grip :
         {Grip{{0, 0}, {0.05, 0.45}}, Grip{{0, 0}, {0.05, 0.6}, {0.15, 0.35}, {0.4, 0.35}, {0.42, 0}},
          Grip{{0, 0}, {0.05, 1}, {0.19, 1}, {0.2, 0.2}}}) {
        acts.point(kMiddle).wait(0.05).pull("right squeeze", grip).wait(0.1);
        acts.move("controller right", highUp(acts.panel), 0.2).wait(0.15);
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
    const ViewRun run = runClean(work, "run", acts.script(), kScene);
    const auto lifted = [&](std::size_t i) {
        return panelOf(run, run.frameAt(looks[i])).middle.y - acts.panel.middle.y;
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

TEST_CASE(
    "rays end at the panel, else fade; hands are seen as their joints are; the panel comes before the eyes, "
    "and either hand clicks") {
    const Workplace work;
    const glm::dvec3 right_at(0.2, 1.2, -0.35), left_at(-0.2, 1.2, -0.35);
    Acts acts(kSmall);
    acts.move("controller right", lookingAt(right_at, acts.panel.middle))
        .move("controller left", lookingAt(left_at, {-0.2, 0.2, -1.0}));
    const double both = acts.wait(0.03).look();
    const double lost = acts.at("controller right off").look();
    acts.at("controller right on").wait(0.05).press("left y");
    // Without the panel, a ray shows while the trigger is pulled.
    const double hidden = acts.look(0.05);
    const double pulled = acts.hold("right trigger", 0.1).wait(0.03).look();
    const double let_go = acts.wait(0.03).look(0.05);
    acts.move("controller right", lookingAt({0.1, 1.5, -0.4}, {0.1, 1.5, -1.0})).wait(0.05);
    const double open = acts.look();
    const double fist = acts.hold("right squeeze", 0.2).wait(0.05).look();
    acts.wait(0.1).move("head", "position 1 1.6 0 turn 90 0").press("right b");
    const double moved = acts.look(0.05);
    const double gone = acts.press("left y").look(0.05);
    acts.move("head", "position 0 1.6 0 turn 0 0").press("left y");
    // Both hands point at the panel; the left one clicks on Quit, although the right one hovers elsewhere.
    acts.move("controller right", lookingAt(right_at, {-0.45, 1.7, -0.9}));
    acts.move("controller left", pointingAt(acts.panel, placeOf("Quit")))
        .wait(0.05)
        .press("left trigger")
        .wait(1.0);
    // The runtime offers no passthrough.
    const ViewRun run =
        runClean(work, "run", acts.script(),
                 kWithHands + " --background 1,0,0" + withConfig(work, "[view]\npassthrough = true\n"));
    CHECK(run.endSeconds() < acts.now_s - 0.5);
    CHECK(run.frames.at(run.pictureAt(hidden)).at("blend_mode") == "OPAQUE");
    const Colour corner = colourAt(run.eye(run.pictureAt(hidden), kLeft), {0, 0});
    CHECK(corner[0] > 0.98f);
    CHECK(corner[1] < 0.02f);
    const auto rays = run.rays(run.frameAt(both));
    REQUIRE(rays.size() == 2);
    CHECK(heightOf(rays[0]) < 0.5);
    CHECK(rays[0].at("views").at(0).at("rect") != rays[1].at("views").at(0).at("rect"));
    const glm::dvec3 half = 0.5 * heightOf(rays[1]) * alongOf(rays[1]);
    const glm::dvec3 ends[]{stagePlace(rays[1]) + half, stagePlace(rays[1]) - half};
    const auto nearest = [&](const glm::dvec3& place) {
        return std::min(glm::distance(ends[0], place), glm::distance(ends[1], place));
    };
    CHECK(nearest(right_at) < 1e-4);
    CHECK(nearest(acts.panel.middle) < 1e-3);
    CHECK(run.rays(run.frameAt(lost) + 1).size() == 1);
    CHECK(these(countSeen(run, both, kHand), countSeen(run, both, kKnob)) == these(2, 0));
    CHECK(run.quadsAsWide(run.frameAt(lost) + 1, kHand).size() == 1);
    for (const double seconds : {hidden, gone}) { CHECK(run.panels(run.frameAt(seconds)).empty()); }
    for (const double seconds : {hidden, let_go}) { CHECK(run.rays(run.frameAt(seconds)).empty()); }
    CHECK(run.rays(run.frameAt(pulled)).size() == 1);
    const auto seen = run.quadsAsWide(run.frameAt(open), kHand);
    CHECK(std::ranges::count_if(seen, [](const auto& hand) {
              return glm::distance(stagePlace(hand), {0.1, 1.5, -0.4}) < 0.1;
          }) == 1);
    // A fist looks different from an open hand. It holds the scene, which does not move with it.
    const double likeness = run.likeness(run.pictureAt(open), run.pictureAt(fist));
    CHECK(likeness == between(15.0, 45.0));
    // The head looks along -x, from (1, 1.6, 0).
    CHECK(glm::distance(panelOf(run, run.frameAt(moved)).middle, {0.1, 1.5, 0.45}) < 1e-4);
}

TEST_CASE(
    "a ring shows where a ray meets the scene; an arc that something stands in is red at its end, and leads "
    "nowhere") {
    const Workplace work;
    const std::string arguments =
        kWithHands + withConfig(work, "[view]\nlocomotion = \"teleport\"\npanel-page = \"scenes\"\n") +
        " --eye 0,0,0 --look 0,0,9 --up 0,-1,0";
    Acts acts(kSmall);
    const glm::dvec2 keep = placeOf("Keep this one", false, PanelPage::kScenes);
    acts.click(keep).move("controller right", lookingAt({0.05, 1.2, -0.4}, {0.05, 1.2, -1.0})).wait(0.05);
    const double points = acts.look();
    acts.move("controller right", lookingAt({0.05, 1.2, -0.4}, {0.05, 1.2, 1.0})).wait(0.05);
    const double away = acts.look();
    acts.move("controller right", lookingAt({0.05, 1.2, -0.4}, {0.05, 1.6, -1.0}));
    const double throws = acts.hold("right trigger", 0.3).wait(0.1).look();
    const ViewRun run = runClean(work, "run", acts.wait(0.2).click(keep).wait(0.1).script(), arguments);
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
    CHECK(ends[0].at("views").at(0).at("rect").at(2) == 96);  // the red target
    const auto kept = keptPlaces(work);
    REQUIRE(kept.size() == 2);
    CHECK(kept[0].eye == kept[1].eye);
}

TEST_CASE("two ends that a ray clicks on, and a number, give the scene its true size, which stays with it") {
    const Workplace work;
    TextEntry entry;
    entry.open(TextEntry::What::kMetres, "As shown, it is 0.8485 m long. How many metres is it in truth?",
               "");
    PanelSketch sketch;
    sketch.status.entry = &entry;
    const WidgetPlaces keys = sketch.draw().places;
    // With hands, a palm that faces the eyes would point at nothing.
    Acts acts(kSmall + "extension XR_EXT_hand_tracking off\n");
    acts.click(placeOf("True size"));
    for (const double x : {0.05, 0.65}) {
        acts.move("controller right", lookingAt({x, 1.2, -0.4}, {x, 1.2, -1.0}))
            .wait(0.1)
            .press("right trigger")
            .wait(0.05);
    }
    acts.click(shareOf(keys, "2")).click(shareOf(keys, "Done")).wait(1.0);
    const ViewRun run =
        runClean(work, "run", acts.script(), kWithHands + " --eye 0,0,0 --look 0,0,9 --up 0,-1,0");
    INFO(run.outcome.output);
    checkOrder(run, {"click on one end", "and now on its other end", "as shown, it is ", "saved as "});
    // The wall is 4 m ahead, and recedes by as much as one goes to the right.
    const std::string text = textIn(work.base / "config" / "binosplat" / "scenes" / "slanted-wall.view.toml"),
                      key = "metres-per-unit = ";
    REQUIRE(text.find(key) != std::string::npos);
    CHECK(std::stod(text.substr(text.find(key) + key.size())) ==
          doctest::Approx(2.0 / (0.6 * std::sqrt(2.0))).epsilon(0.04));
}

TEST_CASE(
    "controllers are drawn where grips are; the wearer teleports to where the arc ended, on the floor that "
    "the runtime says") {
    const Workplace work;
    const std::string config =
        withConfig(work, "[view]\nlocomotion = \"teleport\"\npanel-page = \"scenes\"\n") +
        " --eye 0,0,0 --look 0,0,9 --up 0,-1,0";
    const glm::dvec2 keep = placeOf("Keep this one", false, PanelPage::kScenes);
    const glm::dvec3 right_at(0.05, 1.2, -0.4);
    Acts acts(kSmall + "extension XR_EXT_hand_tracking off\n", {0.0, 1.3, 0.0});
    acts.move("controller right", lookingAt(right_at, {0.05, 1.2, -1.0}));
    const double both = acts.look();
    const double one = acts.at("controller left off").look();
    const double none = acts.at("controller right off").look();
    acts.at("controller left on").at("controller right on").wait(0.05);
    acts.move("controller left", lookingAt({-0.2, 0.9, -0.35}, {-0.2, 0.7, -1.0}));
    const double by_stick = acts.push("left thumbstick", {0.0, 1.0}, 0.15).wait(0.06).look();
    const double there = acts.wait(0.02).look(0.05);
    acts.move("controller left", kLeftDown).press("left y").click(keep);
    // Controllers without a stick use the trigger.
    acts.at("profile khr/simple_controller")
        .move("controller right", lookingAt({0.2, 0.9, -0.35}, {0.2, 0.3, -0.75}))
        .wait(0.05);
    const double by_trigger = acts.hold("right select", 0.2).wait(0.05).look();
    acts.wait(0.1).click(keep, "right select").wait(0.1);
    const ViewRun run = runClean(work, "run", acts.script(), kWithHands + " --hide-panel" + config);
    CHECK(these(countSeen(run, both, kKnob), countSeen(run, both, kHandle)) == these(2, 2));
    const std::size_t frame = run.frameAt(one) + 1;
    REQUIRE(run.quadsAsWide(frame, kKnob).size() == 1);
    REQUIRE(run.quadsAsWide(frame, kHandle).size() == 1);
    // The handle surrounds the grip, along its axis.
    CHECK(glm::distance(stagePlace(run.quadsAsWide(frame, kHandle)[0]), right_at) < 0.02);
    CHECK(std::abs(alongOf(run.quadsAsWide(frame, kHandle)[0]).z) > 0.999);
    CHECK(run.layers(run.frameAt(none) + 1, "quad").empty());
    CHECK(run.likeness(run.pictureAt(one + 0.01), run.pictureAt(none + 0.01)) < 45.0);
    // The target is shown beforehand.
    CHECK(countPieces(run, by_stick) == kArcPieces);
    CHECK(vignettes(run, run.frameAt(by_stick)).empty());
    CHECK(these(countPieces(run, there), countSeen(run, there, kTarget)) == these(0, 0));
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

TEST_CASE(
    "who follows the ground walks down a slope as it falls, by the depth of what was seen ahead; who does "
    "not stays as high") {
    // The wall as a slope that falls by 10 degrees in the direction of view: its own axes, turned by that.
    // The feet are on it.
    const double tilt = glm::radians(10.0), half = std::sqrt(0.5);
    const glm::dvec3 along(half, 0.0, half), out(half, 0.0, -half);
    const glm::dvec3 up = std::cos(tilt) * out - std::sin(tilt) * along,
                     ahead = std::cos(tilt) * along + std::sin(tilt) * out;
    const glm::dvec3 eye = glm::dvec3(0.0, 0.0, 4.0) - 1.2 * along + 1.6 * up, look = eye + ahead;
    const std::string place =
        fmt::format(" --eye {:.6f},{:.6f},{:.6f} --look {:.6f},{:.6f},{:.6f} --up {:.6f},{:.6f},{:.6f}",
                    eye.x, eye.y, eye.z, look.x, look.y, look.z, up.x, up.y, up.z);
    for (const bool follows : {true, false}) {
        CAPTURE(follows);
        const Workplace work;
        const glm::dvec2 keep = placeOf("Keep this one", false, PanelPage::kScenes);
        Acts acts(kBlind);
        acts.click(keep)
            .move("controller right", kRightDown)
            .push("left thumbstick", {0.0, 1.0}, 0.8)
            .wait(1.1)
            .click(keep)
            .wait(0.1);
        const std::string config =
            fmt::format("[view]\nfollow-ground = {}\npanel-page = \"scenes\"\n", follows);
        const ViewRun run = runClean(work, "run", acts.script(), kScene + place + withConfig(work, config));
        const auto kept = keptPlaces(work);
        REQUIRE(kept.size() == 2);
        const glm::dvec3 way = kept[1].eye - kept[0].eye;
        const double level_m = glm::dot(way, ahead), fall_m = -glm::dot(way, up);
        CHECK(level_m == doctest::Approx(1.2).epsilon(0.05));
        CHECK(fall_m == (follows ? between(0.8 * level_m * std::tan(tilt), 1.2 * level_m * std::tan(tilt))
                                 : between(-1e-4, 1e-4)));
    }
}

TEST_CASE(
    "the wearer is moved by sticks, pads, hands, viewpoints and buttons, as far as they say and by nothing "
    "else; places are kept") {
    const Workplace work;
    REQUIRE(work.run("scene one-splat --out a.ply").exit_code == 0);
    std::string cameras;
    for (const char* its : {R"("door", "position": [0,0,0])", R"("window", "position": [0.5,0,0])",
                            R"("stairs", "position": [0,0,0.5])"}) {
        cameras += R"(, {"width": 8, "height": 8, "rotation": [[1,0,0],[0,1,0],[0,0,1]], "fx": 8, "fy": 8,)"
                   R"( "img_name": )" +
                   std::string(its) + "}";
    }
    work.write("cameras.json", "[" + cameras.substr(1) + "]");
    const auto onScenes = [](const std::string& name) { return placeOf(name, false, PanelPage::kScenes); };
    Acts acts("rate 50\nsize 64 64\nframes none\n");
    const auto keep = [&] { acts.click(onScenes("Keep this one")).wait(0.05); };
    acts.click(onScenes("Next viewpoint")).hold("right thumbstick", 0.08).wait(0.12).press("left thumbstick");
    keep();  // 0: where the camera was
    // A hand holds the scene while the room is recentred elsewhere, and then back again.
    acts.move("head", "position 0.5 1.6 0.4 turn 40 0")
        .hold("left squeeze", 0.18)
        .wait(0.1)
        .at("recentre")
        .wait(0.15);
    acts.move("head", "position 0 1.6 0 turn 0 0").wait(0.05).at("recentre").wait(0.1);
    keep();  // 1
    // The stick of the hand that points at the panel does not move the wearer; the other stick does.
    acts.move("controller right", kRightDown).move("controller left", pointingAt(acts.panel, kMiddle));
    acts.push("left thumbstick", {0.0, 1.0}, 0.1).wait(0.15);
    keep();  // 2
    acts.move("controller right", kRightDown).push("right thumbstick", {0.0, 1.0}, 0.1).wait(0.15);
    keep();  // 3
    acts.move("controller left", kLeftDown).push("left thumbstick", {0.0, 1.0}, 0.1).wait(0.15);
    keep();  // 4
    // A push mostly to the side turns and does not lift.
    for (const glm::dvec2& aside : {glm::dvec2(0.9, 0.7), glm::dvec2(-1.0, 0.0)}) {
        acts.move("controller right", kRightDown).push("right thumbstick", aside, 0.1).wait(0.15);
        keep();  // 5 and 6
    }
    // A pad moves the wearer while it is pressed, not while a thumb rests on it.
    acts.at("profile htc/vive_controller").wait(0.1).push("left trackpad", {0.0, 1.0}, 1.0).wait(0.1);
    keep();  // 7
    acts.hold("left trackpad", 0.1).wait(0.2);
    keep();  // 8
    acts.at("profile oculus/touch_controller").wait(0.4);
    // A scene held by one hand moves as far as the hand does, and does not turn about it.
    acts.hold("left squeeze", 0.2)
        .wait(0.04)
        .move("controller left", "position -0.1 1.4 -0.65 turn 30 -60", 0.1)
        .wait(0.1);
    keep();  // 9
    // Both hands turn it about the vertical and enlarge it, and tilt it if that is allowed; then it is
    // levelled.
    const auto roll = [&](const std::string& left, const std::string& right) {
        acts.move("controller left", kLeftDown)
            .move("controller right", kRightDown)
            .hold("left squeeze", 0.34)
            .hold("right squeeze", 0.34);
        acts.wait(0.05).move("controller left", "position " + left + " turn 0 -80", 0.1);
        acts.move("controller right", "position " + right + " turn 0 -80", 0.1).wait(0.1);
        keep();  // 10 and 11
    };
    roll("-0.3 1.3 -0.3", "0.4 1.3 -0.5");
    acts.click(onScenes("View")).click(placeOf("Two-handed tilt")).click(placeOf("Scenes"));
    roll("-0.17 1.1 -0.35", "0.17 1.3 -0.35");
    acts.click(onScenes("View")).click(placeOf("Level")).click(placeOf("Scenes"));
    keep();  // 12
    acts.click(onScenes("View"))
        .move("head", "position 0.4 1.5 0.3 turn 50 0")
        .click(placeOf("Recentre"))
        .wait(0.1);
    const double recentred = acts.look();
    const ViewRun run = runClean(work, "run", acts.script(),
                                 "a.ply --load-first --mode mono --hide-hands --metres-per-unit 0.5 --eye "
                                 "0,0,1 --look 0,0,3 --up 0,-1,0" +
                                     withConfig(work, "[view]\npanel-page = \"scenes\"\n"));
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
    CHECK(isNear(kept[0].eye, {0.0, 0.0, 0.0}));
    for (const std::size_t i : {1, 2, 5, 6, 7, 12}) {
        CAPTURE(i);
        CHECK(isNear(step(i), {0.0, 0.0, 0.0}));
    }
    // A unit is half a metre, in our axes: x right, y down, z ahead.
    CHECK(step(3).y < -0.05);
    CHECK(isNear(step(4), {0.0, 0.0, step(4).z}));
    CHECK(step(4).z > 0.1);
    CHECK(isNear(ahead(5), {1.0, 0.0, std::sqrt(3.0)}, 1e-5));  // by 30 degrees
    CHECK(isNear(ahead(6), {0.0, 0.0, 2.0}, 1e-5));
    CHECK(step(8).z > 0.1);
    // The wearer's room moves through the scene by as much the other way.
    CHECK(isNear(step(9), {-0.2, 0.4, -0.6}, 1e-4));
    CHECK(isNear(ahead(9), {0.0, 0.0, 2.0}, 1e-4));
    CHECK(glm::length(ahead(10)) < 1.5);
    CHECK(std::abs(ahead(10).x) > 0.1);
    const glm::dvec3 up(0.0, -1.0, 0.0);
    for (const std::size_t i : {9, 10, 12}) { CHECK(isNear(kept[i].up, up, 2e-6)); }
    CHECK(glm::dot(kept[11].up, up) < 0.92);
    CHECK(isNear(run.viewPlace(run.frameAt(recentred), kLeft), {-0.0315, 0.0, 0.0}, 1e-5));
}

TEST_CASE(
    "the view's edge is dark while a stick moves the wearer, its middle is not; it, hands, the room and "
    "teleport are switched") {
    const Workplace work;
    Acts acts("rate 100\nsize 64 64\nframes every 5\nblend-modes opaque alpha-blend\n");
    const auto walk = [&] { return acts.push("left thumbstick", {0.0, 0.2}, 0.3).wait(0.2).look(); };
    const double before = acts.look();
    const double during = walk();
    const double after = acts.wait(0.4).look();
    acts.click(placeOf("Vignette", true));
    const double without = walk();
    acts.wait(0.05)
        .click(placeOf("Hands", true))
        .click(placeOf("Passthrough", true))
        .click(placeOf("Teleport", true));
    const double end = acts.look();
    // Nothing is visible in the direction of view.
    const ViewRun run = runClean(work, "run", acts.script(),
                                 kWithHands + " --background 1,1,1 --eye 0,0,0 --look 0,0,-9 --up 0,-1,0");
    checkOrder(run, {"vignette = false", "hands = false", "passthrough = true", "locomotion = \"teleport\""});
    for (const double seconds : {before, after, without}) {
        CHECK(vignettes(run, run.frameAt(seconds)).empty());
    }
    CHECK(vignettes(run, run.frameAt(during)).size() == 1);
    const auto at = [&](double seconds, glm::uvec2 place) {
        return colourAt(run.eye(run.pictureAt(seconds), kLeft), place)[0];
    };
    CHECK(at(during, {1, 1}) < 0.5f * at(before, {1, 1}));
    CHECK(at(during, {32, 1}) < 0.7f * at(before, {32, 1}));
    CHECK(at(during, {32, 32}) == at(before, {32, 32}));
    for (const double seconds : {after, without}) {
        for (const glm::uvec2 place : {glm::uvec2(1, 1), glm::uvec2(32, 1)}) {
            CHECK(at(seconds, place) == at(before, place));
        }
    }
    CHECK(these(countSeen(run, before, kHand), countSeen(run, end, kHand)) == these(2, 0));
    CHECK(run.frames.at(run.frameAt(before)).at("blend_mode") == "OPAQUE");
    CHECK(run.frames.at(run.frameAt(end)).at("blend_mode") == "ALPHA_BLEND");
}

}  // SUITE(view_hands)
