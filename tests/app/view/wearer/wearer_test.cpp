// Facts about the wearer without a headset: who points, where a throw lands, what the vignette covers, how hands are drawn, where the
// eyes are taken to look.
#include "app/view/room/hand_picture.h"
#include "app/view/room/vignette.h"
#include "app/view/wearer/gaze_follower.h"
#include "app/view/wearer/teleport.h"
#include "app/view/wearer/wearer_controls.h"
#include "tests/suite.h"

SUITE(wearer) {

// A hand that points straight at a place of a panel, half a metre before it.
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

    // Where the pointer is then, from the left; -1: nowhere.
    double at(bool shown = true) {
        panel.update(hands, shown);
        return panel.pointer().place_px.value_or(glm::dvec2(-1.0)).x;
    }
    [[nodiscard]] std::size_t rays(const std::optional<int>& aiming = std::nullopt) const {
        return panel.rays(glm::dvec3(0.0), aiming).size();
    }
};

// A wearer, who is updated each tenth of a second.
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

ViewSettings teleporting(bool panel) {
    ViewSettings settings;
    settings.panel = panel;
    settings.teleport = true;
    return settings;
}

// Both eyes at the middle, each seeing so far to every side.
std::array<xr::EyeView, 2> eyesThatSee(float angle_rad) {
    const xr::EyeView eye{{{0, 0, 0, 1}, {0, 0, 0}}, {-angle_rad, angle_rad, angle_rad, -angle_rad}};
    return {eye, eye};
}

double alphaAt(const TexelPicture& picture, std::uint32_t x, std::uint32_t y) {
    return static_cast<double>(picture.texels.at(std::size_t{y} * picture.size_px.x + x) >> 24) / 255.0;
}

// A flat hand, fingers along -y, whose palm is at `palm`.
xr::HandJoints flatHand(const glm::dvec3& palm) {
    xr::HandJoints joints{};
    for (auto& joint : joints) { joint = {palm, 0.01}; }
    joints[XR_HAND_JOINT_WRIST_EXT].place = palm + glm::dvec3(0.0, 0.06, 0.0);
    for (std::size_t finger = 0; finger < 5; ++finger) {
        const std::size_t first = finger == 0 ? 2 : 6 + 5 * (finger - 1), count = finger == 0 ? 4 : 5;
        for (std::size_t i = 0; i < count; ++i) {
            joints[first + i].place =
                palm + glm::dvec3(0.02 * (static_cast<double>(finger) - 2.0), 0.03 - 0.03 * static_cast<double>(i), 0.0);
        }
    }
    return joints;
}

constexpr double kStep = 0.01;
const double kLensClear = glm::radians(15.0);

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return 2.0 * std::asin(0.5 * glm::distance(glm::normalize(a), glm::normalize(b)));
}

// Canted eyes: the left one is turned outwards by 5 degrees.
const std::array<Pose, 2> kEyes{Pose{glm::angleAxis(glm::radians(-5.0), glm::dvec3(0, 1, 0)), {-0.03, 0.0, 0.0}},
                                Pose{{1, 0, 0, 0}, {0.03, 0.0, 0.0}}};
const glm::dvec3 kAside = glm::normalize(glm::dvec3(0.3, -0.2, 1.0));

TEST_CASE("both hands point, and the one that clicked last is the pointer until the other one clicks or it misses") {
    Pointing pointing;
    auto& [panel, hands] = pointing;
    hands = {pointingAt(panel, {-0.2, 0.0}), pointingAt(panel, {0.2, 0.0})};
    CHECK(pointing.at() == doctest::Approx(600));
    CHECK(pointing.rays() == 2);
    CHECK(panel.pulses(kLeft));
    CHECK(panel.pulses(kRight));
    hands[kLeft].clicks = true;
    CHECK(pointing.at() == doctest::Approx(200));
    CHECK(panel.pointer().pressed);
    CHECK(panel.pulses(kLeft));
    CHECK_FALSE(panel.pulses(kRight));
    hands[kLeft].clicks = false;
    CHECK(pointing.at() == doctest::Approx(200));
    const xr::Hand left = std::exchange(hands[kLeft], pointingAway());
    CHECK(pointing.at() == doctest::Approx(600));
    hands[kLeft] = left;
    CHECK(pointing.at() == doctest::Approx(200));
    hands[kRight].clicks = true;
    CHECK(pointing.at() == doctest::Approx(600));
}

TEST_CASE("a trigger that was pulled beside the panel does not click when the ray comes over it") {
    Pointing pointing;
    auto& [panel, hands] = pointing;
    hands[kRight] = pointingAway();
    hands[kRight].clicks = true;
    CHECK(pointing.at() < 0.0);
    CHECK(panel.clicksElsewhere(kRight));
    hands[kRight] = pointingAt(panel, {0.0, 0.0}, true);
    CHECK(pointing.at() == doctest::Approx(400));
    CHECK_FALSE(panel.pointer().pressed);
    CHECK(panel.clicksElsewhere(kRight));
    for (const bool clicks : {false, true}) {
        hands[kRight].clicks = clicks;
        pointing.at();
    }
    CHECK(panel.pointer().pressed);
    CHECK_FALSE(panel.clicksElsewhere(kRight));
}

TEST_CASE("without a panel a hand shows its ray only while its trigger is pulled") {
    Pointing pointing;
    auto& [panel, hands] = pointing;
    hands.fill(pointingAt(panel, {0.0, 0.0}));
    CHECK(pointing.at(false) < 0.0);
    CHECK(pointing.rays() == 0);
    hands[kLeft].clicks = true;
    pointing.at(false);
    const auto rays = panel.rays(glm::dvec3(0.1, -0.2, 0.0), std::nullopt);
    REQUIRE(rays.size() == 1);
    CHECK(rays[0].sprite == Sprite::kFadingRay);
    CHECK(pointing.rays(kLeft) == 0);
}

TEST_CASE("a ray meets the panel where it points, from the front alone, and a strip joins its ends and shows its face to the eye") {
    Pointing pointing;
    auto& [panel, hands] = pointing;
    // A quarter to the right and downwards of the panel's middle.
    hands[kRight] = pointingAt(panel, {0.2, 0.1});
    CHECK(pointing.at() == doctest::Approx(600));
    CHECK(panel.pointer().place_px->y == doctest::Approx(300));
    CHECK_FALSE(panel.pointer().pressed);
    const auto rays = panel.rays(glm::dvec3(0.0), std::nullopt);
    REQUIRE(rays.size() == 1);
    CHECK(rays[0].sprite == Sprite::kRay);
    CHECK(rays[0].strip.size_m.y == doctest::Approx(0.5));
    CHECK(glm::distance(rays[0].strip.room_from_strip.position, transform(panel.roomFromPanel(), {0.2, 0.1, -0.25})) < 1e-9);
    hands[kRight].aim = compose(panel.roomFromPanel(), {glm::dquat(0, 0, 1, 0), {0.2, 0.1, 0.5}});  // behind it, towards it
    CHECK(pointing.at() < 0.0);
    // It fades before it is there.
    const auto behind = panel.rays(glm::dvec3(0.0), std::nullopt);
    REQUIRE(behind.size() == 1);
    CHECK(behind[0].sprite == Sprite::kFadingRay);
    CHECK(behind[0].strip.size_m.y < 0.5);

    const glm::dvec3 from(0.2, 0.4, 0.3), to(-0.3, 0.1, 0.9), eye(0.1, -0.2, 0.0);
    const auto strip = stripBetween(from, to, 0.01, eye);
    REQUIRE(strip.has_value());
    CHECK(glm::distance(transform(strip->room_from_strip, {0.0, -0.5 * strip->size_m.y, 0.0}), from) < 1e-12);
    CHECK(glm::distance(transform(strip->room_from_strip, {0.0, 0.5 * strip->size_m.y, 0.0}), to) < 1e-12);
    CHECK(transform(inverse(strip->room_from_strip), eye).z < 0.0);
    CHECK(std::abs(transform(inverse(strip->room_from_strip), eye).x) < 1e-12);
    CHECK_FALSE(stripBetween(from, from, 0.01, eye).has_value());
    CHECK_FALSE(stripBetween(from, to, 0.01, from - 2.0 * (to - from)).has_value());
    // Also straight above and below the eye.
    for (const double y : {-1.0, 1.0}) {
        const Strip faced = facing(eye + glm::dvec3(0.0, y, 0.0), {0.1, 0.1}, eye);
        CHECK(glm::distance(transform(inverse(faced.room_from_strip), eye), {0.0, 0.0, -1.0}) < 1e-9);
    }
}

TEST_CASE("a throw lands on the floor, where physics puts it") {
    // 7 m/s straight ahead from 1.2 m: it falls for sqrt(2 h / g).
    const TeleportAim level = aimTeleport({{1, 0, 0, 0}, {0.2, 0.4, 0.3}}, 1.6);
    REQUIRE(level.target.has_value());
    CHECK(level.target->y == doctest::Approx(1.6));
    CHECK(level.target->x == doctest::Approx(0.2));
    CHECK(level.target->z == doctest::Approx(0.3 + 7.0 * std::sqrt(2.0 * 1.2 / 9.8)));
    CHECK(level.arc.size() == kTeleportStrips + 1);
    CHECK(glm::distance(level.arc.front(), glm::dvec3(0.2, 0.4, 0.3)) < 1e-12);
    // Upwards it flies farther, and down at one's feet not at all.
    const auto reach = [](double up_rad) {
        const TeleportAim aim = aimTeleport({glm::angleAxis(up_rad, glm::dvec3(1, 0, 0)), {0.0, 0.4, 0.0}}, 1.6);
        return glm::length(glm::dvec2(aim.target->x, aim.target->z));
    };
    CHECK(reach(0.6) > reach(0.0) + 1.0);
    CHECK(reach(0.6) < 7.0);
    CHECK(reach(-1.5707) < 0.01);
    CHECK_FALSE(aimTeleport({{1, 0, 0, 0}, {0.0, 1.7, 0.0}}, 1.6).target.has_value());
}

TEST_CASE("who teleports stands where the throw lands, once the stick is let go, and does not walk") {
    Wearer wearer(teleporting(false));
    auto& [panel, controls, state, now] = wearer;
    now.room_from_head.position = {0.3, 0.0, -0.2};
    now.floor_m = 1.6;
    now.hands[kLeft].aim = Pose{{1, 0, 0, 0}, {-0.2, 0.4, 0.3}};
    wearer.push(kLeft, {0.0, 1.0});
    CHECK(controls.aimingHand() == kLeft);
    CHECK_FALSE(controls.isMoving());
    CHECK(wearer.place() == glm::dvec3(0.0));
    const glm::dvec3 target = aimTeleport(*now.hands[kLeft].aim, *now.floor_m).target.value();
    CHECK(controls.things(now.room_from_head.position).size() == kTeleportStrips + 1);
    wearer.push(kLeft, {0.0, 0.0});
    CHECK_FALSE(controls.aimingHand().has_value());
    CHECK(controls.things(now.room_from_head.position).empty());
    // The head is above the target now, as high as before.
    const glm::dvec3 head = transform(state.sceneFromRoom(), now.room_from_head.position);
    CHECK(head.x == doctest::Approx(target.x));
    CHECK(head.y == doctest::Approx(0.0));
    CHECK(head.z == doctest::Approx(target.z));
    // A hand that is lost while it aims moves nobody.
    const glm::dvec3 before = wearer.place();
    wearer.push(kLeft, {0.0, 1.0});
    now.hands[kLeft] = {};
    wearer.update();
    CHECK(wearer.place() == before);
    // The trigger does it, too, where there is no stick.
    now.hands[kRight].aim = Pose{{1, 0, 0, 0}, {0.2, 0.4, 0.3}};
    now.hands[kRight].clicks = true;
    wearer.update();
    CHECK(controls.aimingHand() == kRight);
    now.hands[kRight].clicks = false;
    wearer.update();
    CHECK(glm::distance(wearer.place(), before) > 1.0);
}

TEST_CASE("the stick of the hand that points at the panel scrolls there, the other hand's moves the wearer, and a throw goes on over it") {
    for (const int pointing : {kLeft, kRight}) {
        for (const bool teleports : {false, true}) {
            CAPTURE(pointing);
            CAPTURE(teleports);
            Wearer wearer(teleports ? teleporting(true) : ViewSettings());
            auto& [panel, controls, state, now] = wearer;
            now.hands[static_cast<std::size_t>(pointing)] = pointingAt(panel, {0.1, 0.1});
            now.hands[static_cast<std::size_t>(1 - pointing)] = pointingAway();
            wearer.push(pointing, {0.0, 1.0});
            CHECK(panel.isPointedAtBy(pointing));
            CHECK_FALSE(panel.isPointedAtBy(1 - pointing));
            CHECK(panel.pointer().wheel > 0.0);
            CHECK(wearer.place() == glm::dvec3(0.0));
            CHECK_FALSE(controls.aimingHand().has_value());
            now.hands[static_cast<std::size_t>(pointing)].stick = {};
            wearer.push(1 - pointing, {0.0, 1.0});
            CHECK(controls.aimingHand().has_value() == (teleports && pointing == kRight));
            CHECK((wearer.place() != glm::dvec3(0.0)) == !(teleports && pointing == kRight));
        }
    }
    Wearer wearer(teleporting(true));
    auto& [panel, controls, state, now] = wearer;
    now.hands[kLeft].aim = Pose{{1, 0, 0, 0}, {1.5, 0.4, 0.3}};
    wearer.push(kLeft, {0.0, 1.0});
    CHECK(controls.aimingHand() == kLeft);
    now.hands[kLeft].aim = pointingAt(panel, {0.1, 0.1}).aim;
    wearer.update();
    CHECK(panel.isPointedAtBy(kLeft));
    CHECK(controls.aimingHand() == kLeft);
    CHECK(wearer.place() == glm::dvec3(0.0));
}

TEST_CASE("the stick turns smoothly, a right angle in a second, which counts as moving, or once until it comes back") {
    ViewSettings settings;
    settings.smooth_turn = true;
    Wearer smooth(settings);
    for (int i = 0; i < 10; ++i) { smooth.push(kRight, {1.0, 0.0}); }
    CHECK(smooth.controls.isMoving());
    CHECK(smooth.turn_rad() == doctest::Approx(1.5707963).epsilon(1e-6));
    smooth.push(kRight, {0.0, 0.0});
    CHECK_FALSE(smooth.controls.isMoving());
    Wearer wearer;
    // Turns by 30 degrees since the last one.
    const auto turns = [&](const glm::dvec2& stick) {
        const double before_rad = wearer.turn_rad();
        wearer.push(kRight, stick);
        return std::lround((wearer.turn_rad() - before_rad) / 0.5235987755982988);
    };
    CHECK(turns({0.9, 0.0}) == 1);
    CHECK(turns({0.6, 0.7}) == 0);  // rises and sinks here
    CHECK(turns({0.9, 0.0}) == 0);
    CHECK(turns({0.3, 0.7}) == 0);
    CHECK(turns({0.9, 0.0}) == 1);
    CHECK(turns({0.0, 0.0}) == 0);
    CHECK(turns({-0.9, 0.0}) == -1);
}

TEST_CASE("a stick that is pressed in goes to the next viewpoint once, the left one to the one before") {
    Wearer wearer;
    const auto steps = [&](bool left, bool right) {
        wearer.now.hands[kLeft].stick_presses = left;
        wearer.now.hands[kRight].stick_presses = right;
        wearer.update();
        return wearer.controls.viewpointStep();
    };
    CHECK(steps(false, true) == 1);
    CHECK(steps(false, true) == 0);
    CHECK(steps(false, false) == 0);
    CHECK(steps(true, false) == -1);
    CHECK(steps(true, true) == 1);
}

TEST_CASE("a trigger that was pressed while nobody looked counts once it was let go") {
    xr::Hold hold;
    for (const double value : {1.0, 0.4}) { CHECK_FALSE(hold.update(value)); }
    CHECK_FALSE(hold.update(0.2));
    for (const double value : {0.6, 0.4}) { CHECK(hold.update(value)); }
    CHECK_FALSE(hold.update(0.2));
    CHECK(hold.update(0.6));
    // Nor what the controller did that could not be seen.
    CHECK_FALSE(hold.update(std::nullopt));
    CHECK_FALSE(hold.update(0.6));
    CHECK_FALSE(hold.update(0.0));
    CHECK(hold.update(0.6));
    hold.forget();
    CHECK_FALSE(hold.update(0.6));
}

TEST_CASE("the vignette closes while the wearer moves, covers all that the eyes see, and is gone afterwards") {
    Vignette vignette;
    for (const float angle_rad : {0.6f, 0.8f, 1.1f}) {
        const auto eyes = eyesThatSee(angle_rad);
        CHECK_FALSE(vignette.widthMetres(eyes).has_value());
        double width_m = 1e9;
        for (int i = 0; i < 5; ++i) {
            vignette.update(true, 0.05);
            const double next_m = vignette.widthMetres(eyes).value();
            CHECK(next_m <= width_m);
            width_m = next_m;
        }
        const double seen_m = 2.0 * kVignetteMetres * std::tan(static_cast<double>(angle_rad));
        CHECK(width_m >= seen_m);
        // Its clear part lies within what is seen.
        CHECK(kVignetteClear * width_m < seen_m);
        for (int i = 0; i < 10; ++i) { vignette.update(false, 0.05); }
        CHECK_FALSE(vignette.widthMetres(eyes).has_value());
    }
}

TEST_CASE("a hand is drawn where its joints are, and nowhere else") {
    const glm::dvec3 eye(0.0), palm(0.1, 0.2, 0.6);
    const xr::HandJoints joints = flatHand(palm);
    const Strip place = handPicturePlace(joints, eye);
    const TexelPicture picture = drawHand(joints, place, eye, {false, false});
    REQUIRE(picture.texels.size() == std::size_t{kHandPicturePx.x} * kHandPicturePx.y);
    // The palm is in the middle; each joint shows where its line of sight meets the picture.
    CHECK(alphaAt(picture, kHandPicturePx.x / 2, kHandPicturePx.y / 2) == 1.0);
    for (const xr::HandJoint& joint : joints) {
        const glm::dvec3 from = transform(inverse(place.room_from_strip), eye), to = transform(inverse(place.room_from_strip), joint.place);
        const glm::dvec3 hit = from + (to - from) * (from.z / (from.z - to.z));
        const glm::dvec2 at = (glm::dvec2(hit) / place.size_m + 0.5) * glm::dvec2(kHandPicturePx);
        CHECK(alphaAt(picture, static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y)) == 1.0);
    }
    for (const std::uint32_t border : {0u, kHandPicturePx.x - 1}) {
        CHECK(alphaAt(picture, border, kHandPicturePx.y / 2) == 0.0);
        CHECK(alphaAt(picture, kHandPicturePx.x / 2, border) == 0.0);
    }
}

TEST_CASE("pictures are multiplied by alpha, in the order and the encoding of their image") {
    CHECK(texelOf({1.0, 0.0, 0.0}, 1.0, {false, true}) == 0xff0000ffu);
    CHECK(texelOf({1.0, 0.0, 0.0}, 1.0, {true, true}) == 0xffff0000u);
    CHECK(texelOf({1.0, 1.0, 1.0}, 0.5, {false, true}) == 0x80808080u);
    // Half the light is the byte 188 of sRGB.
    CHECK(texelOf({1.0, 1.0, 1.0}, 0.5, {false, false}) == 0x80bcbcbcu);
    const TexelPicture sheet = drawSprites({false, false});
    const auto alpha = [&](Sprite sprite, const glm::dvec2& share) {
        const auto [from_px, size_px] = placeOf(sprite);
        const glm::uvec2 at = from_px + glm::uvec2(share * glm::dvec2(size_px));
        return alphaAt(sheet, at.x, at.y);
    };
    CHECK(alpha(Sprite::kRay, {0.5, 0.99}) == 1.0);
    CHECK(alpha(Sprite::kFadingRay, {0.5, 0.0}) == 1.0);
    CHECK(alpha(Sprite::kFadingRay, {0.5, 0.99}) < 0.05);
    CHECK(alpha(Sprite::kVignette, {0.5, 0.5}) == 0.0);
    CHECK(alpha(Sprite::kVignette, {0.0, 0.5}) > 0.9);
    CHECK(alpha(Sprite::kKnob, {0.0, 0.0}) == 0.0);
    CHECK(alpha(Sprite::kKnob, {0.5, 0.5}) == 1.0);
}

TEST_CASE("an eye that nobody sees looks at the middle of its lens") {
    GazeFollower follower;
    for (int i = 0; i < 100; ++i) {
        const auto gazes = follower.update(std::nullopt, kEyes, kLensClear, kStep);
        REQUIRE(gazes[kLeft]);
        CHECK(gazes[kLeft]->direction == glm::dvec3(0.0, 0.0, 1.0));
        CHECK(gazes[kRight]->clear_rad == kLensClear);
    }
}

TEST_CASE("an eye that is seen looks where it is seen to, in its own axes, and less about it is clear") {
    GazeFollower follower;
    std::array<std::optional<Gaze>, 2> gazes;
    for (int i = 0; i < 20; ++i) { gazes = follower.update(kAside, kEyes, kLensClear, kStep); }
    CHECK(angleBetween(gazes[kRight]->direction, kAside) < 1e-6);
    CHECK(angleBetween(kEyes[kLeft].orientation * gazes[kLeft]->direction, kAside) < 1e-6);
    CHECK(gazes[kLeft]->clear_rad == doctest::Approx(GazeFollower::kSeenClearRadians));
    // From now on at once.
    gazes = follower.update(glm::dvec3(0.0, 0.0, 1.0), kEyes, kLensClear, kStep);
    CHECK(angleBetween(gazes[kRight]->direction, {0.0, 0.0, 1.0}) < 1e-6);
    // No more than without a tracker.
    CHECK(follower.update(kAside, kEyes, 0.05, kStep)[kLeft]->clear_rad == doctest::Approx(0.05));
}

TEST_CASE("a blink changes nothing, a gaze that stays lost goes back to the lens without a jump, and is found so again") {
    GazeFollower follower;
    std::array<std::optional<Gaze>, 2> gazes;
    for (int i = 0; i < 20; ++i) { gazes = follower.update(kAside, kEyes, kLensClear, kStep); }
    const Gaze seen = *gazes[kRight];
    for (double t = kStep; t < GazeFollower::kHoldSeconds - 0.5 * kStep; t += kStep) {
        gazes = follower.update(std::nullopt, kEyes, kLensClear, kStep);
        CHECK(gazes[kRight]->direction == seen.direction);
        CHECK(gazes[kRight]->clear_rad == seen.clear_rad);
    }
    const auto follow = [&](const std::optional<glm::dvec3>& gaze, double most_rad) {
        const Gaze before = *gazes[kRight];
        gazes = follower.update(gaze, kEyes, kLensClear, kStep);
        CHECK(angleBetween(before.direction, gazes[kRight]->direction) <= most_rad);
        CHECK(std::abs(before.clear_rad - gazes[kRight]->clear_rad) <= most_rad);
    };
    const double whole_rad = angleBetween(seen.direction, {0.0, 0.0, 1.0});
    for (int i = 0; i < 100; ++i) { follow(std::nullopt, 1.1 * whole_rad * kStep / GazeFollower::kLoseSeconds); }
    CHECK(gazes[kRight]->direction == glm::dvec3(0.0, 0.0, 1.0));
    CHECK(gazes[kRight]->clear_rad == kLensClear);
    for (int i = 0; i < 20; ++i) { follow(kAside, 1.1 * whole_rad * kStep / GazeFollower::kFindSeconds); }
    CHECK(angleBetween(gazes[kRight]->direction, kAside) < 1e-6);
}

}  // SUITE(wearer)
