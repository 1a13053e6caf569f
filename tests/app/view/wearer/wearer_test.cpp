// Facts about the wearer without a headset: which hand points, where a throw lands, how sticks move and turn
// the wearer, where the eyes are assumed to look.
#include "app/view/wearer/teleport.h"
#include "app/view/wearer/wearer_controls.h"
#include "tests/suite.h"

SUITE(wearer) {

// A hand that points straight at a place on a panel, from half a metre in front of it.
xr::Hand pointingAt(const PanelInRoom& panel, const glm::dvec2& from_middle_m, bool clicks = false) {
    xr::Hand hand;
    hand.aim = compose(panel.roomFromPanel(), Pose{{1, 0, 0, 0}, {from_middle_m.x, from_middle_m.y, -0.5}});
    hand.clicks = clicks;
    return hand;
}

xr::Hand pointingAway() {
    xr::Hand hand;
    hand.aim = Pose{glm::angleAxis(3.0, glm::dvec3(0, 1, 0)), {0.3, 0.4, 0.3}};
    return hand;
}

// A panel, and two hands that point at it.
struct Pointing {
    PanelInRoom panel{{800, 400}, 0.8};
    std::array<xr::Hand, 2> hands;

    // The pointer's distance from the panel's left edge; -1 if there is none.
    double at() {
        panel.update(hands, true);
        return panel.pointer().place_px.value_or(glm::dvec2(-1.0)).x;
    }
};

// A wearer, updated every tenth of a second.
struct Wearer {
    PanelInRoom panel{{800, 400}, 0.8};
    WearerControls controls;
    ViewState state;
    WearerNow now;

    explicit Wearer(const ViewSettings& settings = {}) : state(settings) { now.step_seconds = 0.1; }

    void update() { controls.update(now, panel, state); }
    void push(int hand, const glm::dvec2& stick) {
        now.hands[static_cast<std::size_t>(hand)].stick = stick;
        update();
    }
    [[nodiscard]] glm::dvec3 place() const { return state.sceneFromRoom().position; }
    // About the vertical.
    [[nodiscard]] double turn_rad() const {
        const glm::dquat turned = state.sceneFromRoom().orientation;
        return 2.0 * std::atan2(turned.y, turned.w);
    }
};

TEST_CASE_FIXTURE(Wearer, "a pinch is the menu button with the palm towards the eyes, not with its back") {
    xr::Hand& hand = now.hands[kLeft];
    hand.joints.emplace();
    const auto place = [&](XrHandJointEXT joint, double x, double y) {
        (*hand.joints)[static_cast<std::size_t>(joint)].place = {x - 0.1, y + 0.2, 0.5};
    };
    place(XR_HAND_JOINT_PALM_EXT, 0.0, 0.0);
    place(XR_HAND_JOINT_WRIST_EXT, 0.0, 0.06);
    const auto pinch = [&](double index_x) {
        place(XR_HAND_JOINT_INDEX_PROXIMAL_EXT, index_x, -0.03);
        place(XR_HAND_JOINT_LITTLE_PROXIMAL_EXT, -index_x, -0.02);
        hand.clicks = true;
        update();
        hand.clicks = false;
        update();
        return state.settings().panel;
    };
    CHECK_FALSE(pinch(-0.03));  // on a left hand, the index finger would then be to the left
    CHECK_FALSE(pinch(0.03));
    CHECK(pinch(-0.03));
}

ViewSettings with(bool ViewSettings::*flag, bool value = true) {
    ViewSettings settings;
    settings.*flag = value;
    return settings;
}
ViewSettings teleporting(bool panel) {
    ViewSettings settings = with(&ViewSettings::teleport);
    settings.panel = panel;
    return settings;
}

TEST_CASE_FIXTURE(Pointing, "both hands point, and the one that clicked last is the pointer") {
    hands = {pointingAt(panel, {-0.2, 0.0}), pointingAt(panel, {0.2, 0.0})};
    CHECK(at() == doctest::Approx(600));
    CHECK(panel.rays(glm::dvec3(0.0), std::nullopt).size() == 2);
    CHECK(these(panel.pulses(kLeft), panel.pulses(kRight)) == these(true, true));
    hands[kLeft].clicks = true;
    CHECK(at() == doctest::Approx(200));
    CHECK(these(panel.pointer().pressed, panel.pulses(kLeft), panel.pulses(kRight)) ==
          these(true, true, false));
    hands[kLeft].clicks = false;
    CHECK(at() == doctest::Approx(200));
    const xr::Hand left = std::exchange(hands[kLeft], pointingAway());
    CHECK(at() == doctest::Approx(600));
    hands[kLeft] = left;
    CHECK(at() == doctest::Approx(200));
    hands[kRight].clicks = true;
    CHECK(at() == doctest::Approx(600));
}

TEST_CASE_FIXTURE(Pointing, "a trigger that was pulled beside the panel does not click over it") {
    hands[kRight] = pointingAway();
    hands[kRight].clicks = true;
    CHECK(at() < 0.0);
    CHECK(panel.clicksElsewhere(kRight));
    hands[kRight] = pointingAt(panel, {0.0, 0.0}, true);
    CHECK(at() == doctest::Approx(400));
    CHECK(these(panel.pointer().pressed, panel.clicksElsewhere(kRight)) == these(false, true));
    for (const bool clicks : {false, true}) {
        hands[kRight].clicks = clicks;
        at();
    }
    CHECK(these(panel.pointer().pressed, panel.clicksElsewhere(kRight)) == these(true, false));
}

TEST_CASE_FIXTURE(Pointing, "a ray meets the panel from the front alone; a strip faces the eye") {
    // Right of the panel's middle and below it, by a quarter.
    hands[kRight] = pointingAt(panel, {0.2, 0.1});
    CHECK(at() == doctest::Approx(600));
    CHECK(panel.pointer().place_px->y == doctest::Approx(300));
    CHECK_FALSE(panel.pointer().pressed);
    const auto seen = panel.rays(glm::dvec3(0.0), std::nullopt);
    REQUIRE(seen.size() == 1);
    CHECK(these(seen[0].sprite, seen[0].strip.size_m.y) == these(Sprite::kRay, doctest::Approx(0.5)));
    CHECK(glm::distance(seen[0].strip.room_from_strip.position,
                        transform(panel.roomFromPanel(), {0.2, 0.1, -0.25})) < 1e-9);
    // From behind the panel, towards it.
    hands[kRight].aim = compose(panel.roomFromPanel(), {glm::dquat(0, 0, 1, 0), {0.2, 0.1, 0.5}});
    CHECK(at() < 0.0);
    // The ray fades before it reaches the panel.
    const auto behind = panel.rays(glm::dvec3(0.0), std::nullopt);
    REQUIRE(behind.size() == 1);
    CHECK(behind[0].sprite == Sprite::kFadingRay);
    CHECK(behind[0].strip.size_m.y < 0.5);
    const glm::dvec3 from(0.2, 0.4, 0.3), to(-0.3, 0.1, 0.9), eye(0.1, -0.2, 0.0);
    const auto strip = stripBetween(from, to, 0.01, eye);
    REQUIRE(strip.has_value());
    for (const auto& [share, end] : {std::pair(-0.5, from), std::pair(0.5, to)}) {
        CHECK(glm::distance(transform(strip->room_from_strip, {0.0, share * strip->size_m.y, 0.0}), end) <
              1e-12);
    }
    const glm::dvec3 seen_from = transform(inverse(strip->room_from_strip), eye);
    CHECK(seen_from.z < 0.0);
    CHECK(std::abs(seen_from.x) < 1e-12);
    CHECK_FALSE(stripBetween(from, from, 0.01, eye).has_value());
    CHECK_FALSE(stripBetween(from, to, 0.01, from - 2.0 * (to - from)).has_value());
    // Also straight above and below the eye.
    for (const double y : {-1.0, 1.0}) {
        const Strip faced = facing(eye + glm::dvec3(0.0, y, 0.0), {0.1, 0.1}, eye);
        CHECK(glm::distance(transform(inverse(faced.room_from_strip), eye), {0.0, 0.0, -1.0}) < 1e-9);
    }
}

TEST_CASE("a path meets what it goes into, and passes behind what is far before it") {
    using Depths = std::array<std::optional<double>, kProbePoints>;
    Depths points, wall, post;
    for (std::size_t i = 0; i < kProbePoints; ++i) { points[i] = 0.5 * static_cast<double>(i); }
    wall.fill(3.1);
    post.fill(20.0);
    const PathSeen met = followPath(points, wall);
    REQUIRE(met.meets.has_value());
    CHECK(*met.meets == doctest::Approx(6.2));
    CHECK_FALSE(met.is_hidden);
    CHECK_FALSE(followPath(points, {}).meets.has_value());
    // A post hides a part of it; beyond the post there is a view of what is farther away.
    post[7].reset();
    post[8] = 1.0;
    const PathSeen behind = followPath(points, post);
    CHECK(behind.is_hidden);
    CHECK_FALSE(behind.meets.has_value());
    CHECK(probeMetres(0.0) == doctest::Approx(0.2));
    CHECK(glm::distance(probeRay({{1, 0, 0, 0}, {0.0, 1.0, 0.0}})[kProbePoints - 1],
                        glm::dvec3(0.0, 1.0, 30.0)) < 1e-9);
}

TEST_CASE_FIXTURE(Wearer, "one does not teleport to where the arc would lead through the scene") {
    for (const bool is_blocked : {true, false}) {
        CAPTURE(is_blocked);
        state = ViewState(teleporting(false));
        const glm::dvec3 before = place();
        now.hands[kRight].aim = Pose{{1, 0, 0, 0}, {0.0, 0.5, 0.0}};
        now.hands[kRight].clicks = true;
        now.paths[kRight] = {is_blocked ? std::optional(9.0) : std::optional(22.5), false};
        update();
        const std::vector<Thing> things = controls.things(glm::dvec3(0.0));
        REQUIRE(!things.empty());
        CHECK(things.back().sprite == (is_blocked ? Sprite::kBlocked : Sprite::kTarget));
        REQUIRE(controls.arc() != nullptr);
        CHECK(controls.arc()->is_blocked == is_blocked);
        now.hands[kRight].clicks = false;
        update();
        CHECK((place() == before) == is_blocked);
    }
}

TEST_CASE("a throw lands on the floor, where physics puts it") {
    // 7 m/s straight ahead from a height of 1.2 m: it falls for sqrt(2 h / g).
    const TeleportAim level = aimTeleport({{1, 0, 0, 0}, {0.2, 0.4, 0.3}}, 1.6);
    REQUIRE(level.target.has_value());
    CHECK(these(level.target->y, level.target->x, level.target->z, level.arc.points.size()) ==
          these(doctest::Approx(1.6), doctest::Approx(0.2),
                doctest::Approx(0.3 + 7.0 * std::sqrt(2.0 * 1.2 / 9.8)), kArcPieces * kPointsOfPiece + 1));
    CHECK(glm::distance(level.arc.points.front(), glm::dvec3(0.2, 0.4, 0.3)) < 1e-12);
    // Aimed upwards, it flies farther; aimed at the wearer's feet, it does not fly at all.
    const auto reach = [](double up_rad) {
        const TeleportAim aim = aimTeleport({glm::angleAxis(up_rad, glm::dvec3(1, 0, 0)), {0, 0.4, 0}}, 1.6);
        return glm::length(glm::dvec2(aim.target->x, aim.target->z));
    };
    CHECK(reach(0.6) == between(reach(0.0) + 1.0, 7.0));
    CHECK(reach(-1.5707) < 0.01);
    CHECK_FALSE(aimTeleport({{1, 0, 0, 0}, {0.0, 1.7, 0.0}}, 1.6).target.has_value());
}

TEST_CASE("a click that measures does not teleport, nor does a stick beside bare hands") {
    Teleport teleport;
    ViewState state;
    PanelInRoom panel({960, 768}, 1.0);
    WearerNow now;
    const auto aiming = [&] {
        panel.update(now.hands, false);
        teleport.update(now, panel, state);
        return teleport.aimingHand().value_or(-1);
    };
    xr::Hand& right = now.hands[kRight];
    right.aim = Pose{{1, 0, 0, 0}, {0.2, 0.4, 0.3}};
    right.clicks = right.is_bare = true;
    now.measures = true;
    CHECK(aiming() == -1);
    now.measures = false;  // that was the second place
    CHECK(aiming() == -1);
    right.clicks = false;
    CHECK(aiming() == -1);
    right.clicks = true;
    CHECK(aiming() == kRight);
    teleport.letGo();
    CHECK(teleport.arc() == nullptr);
    right.clicks = false;
    now.hands[kLeft] = right;
    now.hands[kLeft].stick.y = 1.0;  // a gamepad's
    CHECK(aiming() == -1);
    CHECK(state.sceneFromRoom() == Similarity());
}

// A stair goes up at z = 1, and from z = 2 on a table stands on it.
std::vector<glm::dvec3> stairAndTable() {
    std::vector<glm::dvec3> ground;
    for (int z = -5; z < 35; ++z) {
        for (int x = -5; x < 6; ++x) {
            ground.emplace_back(0.1 * x, z < 10 ? 1.6 : z < 20 ? 1.43 : 0.7, 0.1 * z);
        }
    }
    return ground;
}

TEST_CASE_FIXTURE(Wearer, "who follows the ground goes up and down a stair, smoothly, and onto no table") {
    for (const bool follows : {true, false}) {
        CAPTURE(follows);
        state = ViewState(with(&ViewSettings::follow_ground, follows));
        now.floor_m = 1.6;
        now.ground_scene = stairAndTable();
        now.step_seconds = 0.02;
        double fastest_m = 0.0;
        const auto walk = [&](double stick, int steps) {
            for (int i = 0; i < steps; ++i) {
                const double before_m = place().y;
                push(kLeft, {0.0, stick});
                fastest_m = std::max(fastest_m, std::abs(place().y - before_m));
            }
        };
        walk(1.0, 20);  // 0.6 m
        CHECK(std::abs(place().y) < 1e-9);
        walk(1.0, 30);
        walk(0.0, 50);
        CHECK(place().z == doctest::Approx(1.5));
        CHECK(place().y == doctest::Approx(follows ? -0.17 : 0.0).epsilon(0.01));
        walk(1.0, 30);
        CHECK(place().y == doctest::Approx(follows ? -0.17 : 0.0).epsilon(0.01));
        walk(-1.0, 60);
        walk(0.0, 50);
        CHECK(std::abs(place().y) < 0.01);
        CHECK((fastest_m > 0.0) == follows);
        CHECK(fastest_m <= 0.03);
    }
}

TEST_CASE_FIXTURE(Wearer, "nobody gets under the floor; what was seen of it goes with its scene") {
    state = ViewState(with(&ViewSettings::follow_ground));
    now.floor_m = 1.6;
    const auto floorAt = [&](double scene_y) { now.scene_floor = SceneFloor{{0.0, -1.0, 0.0}, -scene_y}; };
    floorAt(1.6);
    // Not for one frame, either, while the stick sinks them.
    for (const double sinks : {-1.0, 0.0}) {
        push(kRight, {0.0, sinks});
        CHECK(std::abs(place().y) < 1e-9);
    }
    floorAt(1.2);
    push(kRight, {0.0, 0.0});
    CHECK(place().y == doctest::Approx(-0.4));
    // A floor slightly below pulls the wearer down, one far below does not.
    for (const double floor_y : {1.5, 2.6}) {
        floorAt(floor_y);
        for (int i = 0; i < 30; ++i) { update(); }
        CHECK(place().y == doctest::Approx(-0.1).epsilon(0.01));
    }
    now.scene_floor.reset();
    now.ground_scene = {{0.0, 1.4, 0.0}};
    update();
    now.ground_scene.clear();
    controls.letGo();
    const double before_y = place().y;
    update();
    CHECK(place().y == before_y);
}

TEST_CASE_FIXTURE(Wearer, "a hand that is lost while it aims for a place moves nobody") {
    state = ViewState(teleporting(false));
    now.hands[kLeft].aim = Pose{{1, 0, 0, 0}, {-0.2, 0.4, 0.3}};
    push(kLeft, {0.0, 1.0});
    CHECK(controls.aimingHand() == kLeft);
    now.hands[kLeft] = {};
    update();
    CHECK(these(controls.aimingHand().has_value(), place()) == these(false, glm::dvec3(0.0)));
}

TEST_CASE("the stick of the hand that points at the panel scrolls, the other's moves the wearer") {
    for (const int pointing : {kLeft, kRight}) {
        for (const bool teleports : {false, true}) {
            INFO("pointing ", pointing, ", teleports ", teleports);
            Wearer wearer(teleports ? teleporting(true) : ViewSettings());
            auto& [panel, controls, state, now] = wearer;
            now.hands[static_cast<std::size_t>(pointing)] = pointingAt(panel, {0.1, 0.1});
            now.hands[static_cast<std::size_t>(1 - pointing)] = pointingAway();
            wearer.push(pointing, {0.0, 1.0});
            CHECK(these(panel.isPointedAtBy(pointing), panel.isPointedAtBy(1 - pointing), wearer.place(),
                        controls.aimingHand().has_value()) == these(true, false, glm::dvec3(0.0), false));
            CHECK(panel.pointer().wheel > 0.0);
            now.hands[static_cast<std::size_t>(pointing)].stick = {};
            wearer.push(1 - pointing, {0.0, 1.0});
            const bool aims = teleports && pointing == kRight;
            CHECK(these(controls.aimingHand().has_value(), wearer.place() == glm::dvec3(0.0)) ==
                  these(aims, aims));
        }
    }
    Wearer wearer(teleporting(true));
    auto& [panel, controls, state, now] = wearer;
    now.hands[kLeft].aim = Pose{{1, 0, 0, 0}, {1.5, 0.4, 0.3}};
    wearer.push(kLeft, {0.0, 1.0});
    CHECK(controls.aimingHand() == kLeft);
    now.hands[kLeft].aim = pointingAt(panel, {0.1, 0.1}).aim;
    wearer.update();
    CHECK(these(panel.isPointedAtBy(kLeft), controls.aimingHand(), wearer.place()) ==
          these(true, std::optional<int>(kLeft), glm::dvec3(0.0)));
}

TEST_CASE_FIXTURE(Wearer, "the stick turns smoothly, which counts as moving, or once until it comes back") {
    Wearer smooth(with(&ViewSettings::smooth_turn));
    for (int i = 0; i < 10; ++i) { smooth.push(kRight, {1.0, 0.0}); }
    CHECK(these(smooth.controls.isMoving(), smooth.turn_rad()) ==
          these(true, doctest::Approx(1.5707963).epsilon(1e-6)));
    smooth.push(kRight, {0.0, 0.0});
    CHECK_FALSE(smooth.controls.isMoving());
    // Turns by 30 degrees since the last call.
    const auto turns = [&](const glm::dvec2& stick) {
        const double before_rad = turn_rad();
        push(kRight, stick);
        return std::lround((turn_rad() - before_rad) / 0.5235987755982988);
    };
    // With 0.7 it lifts and lowers.
    for (const auto& [x, y, times] : {std::tuple(0.9, 0.0, 1),
                                      {0.6, 0.7, 0},
                                      {0.9, 0.0, 0},
                                      {0.3, 0.7, 0},
                                      {0.9, 0.0, 1},
                                      {0.0, 0.0, 0},
                                      {-0.9, 0.0, -1}}) {
        CHECK(turns({x, y}) == times);
    }
}

}  // SUITE(wearer)
