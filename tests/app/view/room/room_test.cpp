// Facts about what hangs in the room: how hands and other pictures are drawn, and when the view is dark.
#include "app/view/placement/placement.h"
#include "app/view/room/arc_picture.h"
#include "app/view/room/fade.h"
#include "app/view/room/hand_picture.h"
#include "app/view/room/panel_in_room.h"
#include "app/view/room/sprites.h"
#include "app/view/scenes/viewpoints.h"
#include "app/view/wearer/sticks.h"
#include "tests/suite.h"

SUITE(room) {

double alphaAt(const TexelPicture& picture, std::uint32_t x, std::uint32_t y) {
    return static_cast<double>(picture.texels.at(std::size_t{y} * picture.size_px.x + x) >> 24) / 255.0;
}

// Where a strip covers a point for the eye, in the strip's coordinates.
glm::dvec2 coverOf(const Pose& room_from_strip, const glm::dvec3& eye, const glm::dvec3& point) {
    const glm::dvec3 from = transform(inverse(room_from_strip), eye),
                     to = transform(inverse(room_from_strip), point);
    return glm::dvec2(from + (to - from) * (from.z / (from.z - to.z)));
}

// A flat hand, fingers along -y, whose palm is at `palm`.
xr::HandJoints flatHand(const glm::dvec3& palm) {
    xr::HandJoints joints{};
    for (auto& joint : joints) { joint = {palm, 0.01}; }
    joints[XR_HAND_JOINT_WRIST_EXT].place = palm + glm::dvec3(0.0, 0.06, 0.0);
    for (std::size_t finger = 0; finger < 5; ++finger) {
        const std::size_t first = finger == 0 ? 2 : 6 + 5 * (finger - 1), count = finger == 0 ? 4 : 5;
        for (std::size_t i = 0; i < count; ++i) {
            joints[first + i].place = palm + glm::dvec3(0.02 * (static_cast<double>(finger) - 2.0),
                                                        0.03 - 0.03 * static_cast<double>(i), 0.0);
        }
    }
    return joints;
}

TEST_CASE("a hand is drawn where its joints are, and nowhere else") {
    const glm::dvec3 eye(0.0), palm(0.1, 0.2, 0.6);
    const xr::HandJoints joints = flatHand(palm);
    const Strip place = handPicturePlace(joints, eye);
    TexelPicture picture;
    HandDrawing({false, false}).draw(joints, place, eye, picture);
    REQUIRE(picture.texels.size() == std::size_t{kHandPicturePx.x} * kHandPicturePx.y);
    // The palm is in the middle; each joint appears where its line of sight meets the picture.
    CHECK(alphaAt(picture, kHandPicturePx.x / 2, kHandPicturePx.y / 2) == 1.0);
    for (const xr::HandJoint& joint : joints) {
        const glm::dvec2 hit = coverOf(place.room_from_strip, eye, joint.place);
        const glm::uvec2 at((hit / place.size_m + 0.5) * glm::dvec2(kHandPicturePx));
        CHECK(alphaAt(picture, at.x, at.y) == 1.0);
    }
    // At arm's length a degree has eight texels or more, and every border goes over two of them at least.
    CHECK(kHandPicturePx.x > 8.0 * glm::degrees(2.0 * std::atan(0.5 * place.size_m.x / 0.6)));
    double steepest = 0.0;
    for (std::uint32_t y = 0; y + 1 < kHandPicturePx.y; ++y) {
        for (std::uint32_t x = 0; x + 1 < kHandPicturePx.x; ++x) {
            for (const auto& [right, down] : {std::pair(1u, 0u), std::pair(0u, 1u)}) {
                const double step = alphaAt(picture, x, y) - alphaAt(picture, x + right, y + down);
                steepest = std::max(steepest, std::abs(step));
            }
        }
    }
    CHECK(steepest == between(0.5, 0.75));
    for (const std::uint32_t border : {0u, kHandPicturePx.x - 1}) {
        CHECK(these(alphaAt(picture, border, kHandPicturePx.y / 2),
                    alphaAt(picture, kHandPicturePx.x / 2, border)) == these(0.0, 0.0));
    }
}

TEST_CASE("an arc is opaque along its bends and nowhere else, without gaps, and red where it is blocked") {
    const glm::dvec3 eye(0.0), from(0.25, 0.35, 0.3), speed(0.3, -2.0, 6.0);
    constexpr double kSteps = kArcPieces * kPointsOfPiece;
    const auto thrown = [&](double at) {
        const double t = 0.9 * at / kSteps;
        return from + t * speed + glm::dvec3(0.0, 4.9 * t * t, 0.0);
    };
    Arc arc;
    for (std::size_t i = 0; i <= kArcPieces * kPointsOfPiece; ++i) {
        arc.points.push_back(thrown(static_cast<double>(i)));
    }
    const ArcPicture drawn = drawArc(arc, eye, {false, true});
    double bends_m = 0.0;
    for (std::size_t piece = 0; piece < kArcPieces; ++piece) {
        REQUIRE(drawn.places[piece].has_value());
        const auto& [room_from_strip, size_m] = *drawn.places[piece];
        const auto alphaBeside = [&](double step, double aside_m) {
            const glm::dvec2 hit =
                coverOf(room_from_strip, eye, thrown(static_cast<double>(piece * kPointsOfPiece) + step));
            bends_m = std::max(bends_m, std::abs(hit.x));
            const glm::dvec2 at = ((hit + glm::dvec2(aside_m, 0.0)) / size_m + 0.5) * glm::dvec2(kArcPiecePx);
            if (at.x < 0.0 || at.x >= kArcPiecePx.x) { return 0.0; }
            const auto left = static_cast<std::uint32_t>(piece) * kArcPiecePx.x;
            return alphaAt(drawn.picture, left + glm::uvec2(at).x, glm::uvec2(at).y);
        };
        for (double step = 0.0; step <= kPointsOfPiece; step += 0.25) {
            CHECK(alphaBeside(step, 0.0) > 0.9);
            CHECK(these(alphaBeside(step, 0.02), alphaBeside(step, -0.02)) == these(0.0, 0.0));
        }
    }
    CHECK(bends_m > 0.008);  // a straight strip would be off by this much
    const auto isRed = [](std::uint32_t rgba) { return (rgba & 0xffu) > 128u && (rgba >> 8 & 0xffu) < 64u; };
    CHECK(std::ranges::none_of(drawn.picture.texels, isRed));
    arc.is_blocked = true;
    const TexelPicture red = drawArc(arc, eye, {false, true}).picture;
    CHECK(std::ranges::all_of(red.texels,
                              [&](std::uint32_t texel) { return texel >> 24 < 250u || isRed(texel); }));
}

TEST_CASE("the panel covers what is behind it as the head sees it, and nothing else") {
    PanelInRoom panel({100, 100}, 0.5);
    panel.hangBefore({});
    const glm::dvec3 place = panel.roomFromPanel().position;
    constexpr glm::dvec2 kSmall(0.01);
    CHECK(panel.covers({}, place, kSmall));
    CHECK(panel.covers({}, 3.0 * place, kSmall));
    // Its edges are a quarter of a metre from its middle, which may be seen at an angle.
    for (const glm::dvec3 beside : {glm::dvec3(0.3, 0.0, 0.0), glm::dvec3(0.0, -0.3, 0.0)}) {
        CHECK_FALSE(panel.covers({}, place + beside, kSmall));
        CHECK(panel.covers({}, place + beside, glm::dvec2(0.2)));
    }
    const Pose turned_away{glm::angleAxis(3.0, glm::dvec3(0.0, 1.0, 0.0)), glm::dvec3(0.0)};
    CHECK_FALSE(panel.covers(turned_away, place, glm::dvec2(5.0)));
}

TEST_CASE("a panel out of sight comes before the eyes after a while, one that is seen stays") {
    PanelInRoom panel({100, 100}, 0.5);
    const glm::dvec3 before = panel.roomFromPanel().position;
    const auto look = [&](double right_rad, int frames) {
        const Pose head{glm::angleAxis(right_rad, glm::dvec3(0.0, 1.0, 0.0)), glm::dvec3(0.0)};
        for (int i = 0; i < frames; ++i) { panel.comeBefore(head, 0.1); }
    };
    look(0.5, 100);
    look(2.0, 10);
    look(0.0, 1);
    look(2.0, 10);
    CHECK(panel.roomFromPanel().position == before);
    look(2.0, 10);
    const glm::dvec3 ahead(std::sin(2.0), 0.0, std::cos(2.0));
    CHECK(glm::dot(glm::normalize(panel.roomFromPanel().position), ahead) > 0.8);
}

TEST_CASE("a jump begins in the dark, which is gone after 0.3 s; a step and a turn by 30 degrees do not") {
    const Pose head{glm::angleAxis(0.4, glm::dvec3(0.0, 1.0, 0.0)), {0.5, -0.2, 2.0}};
    const View elsewhere{{4.0, 1.0, -2.0}, {4.0, 1.0, 3.0}, {0.0, -1.0, 0.0}, 60.0};
    const Similarity start{{1.0, 0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}, 2.5};
    Fade fade;
    const auto darknessAfter = [&](const Similarity& next, bool is_new = false) {
        fade = {};
        fade.update(start, head, false, 0.01);
        CHECK(fade.darkness() == 0.0);  // the first view
        fade.update(next, head, is_new, 0.01);
        return fade.darkness();
    };
    for (const double side : {-1.0, 1.0}) {
        CAPTURE(side);
        // A teleport, a turn around, and a growth of the scene, or a shrinking.
        for (const Similarity& next :
             {movedBy(start, {0.0, 0.0, 2.0 * side}), turnedBy(start, 1.5 * side, head.position),
              grownBy(start, std::pow(2.0, side), head.position)}) {
            CHECK(darknessAfter(next) == 1.0);
        }
        // A stick's turn, 15 cm of its walk, and a press of Larger or Smaller.
        for (const Similarity& next :
             {turnedBy(start, kTurnRadians * side, head.position), movedBy(start, {0.15 * side, 0.0, 0.0}),
              grownBy(start, std::pow(1.25, side), head.position)}) {
            CHECK(darknessAfter(next) == 0.0);
        }
    }
    CHECK(darknessAfter(start) == 0.0);
    CHECK(darknessAfter(start, /*is_new*/ true) == 1.0);  // another scene
    // A viewpoint of the scene; then it brightens evenly.
    const Similarity viewpoint = placedAt(elsewhere, start, head);
    CHECK(darknessAfter(viewpoint) == 1.0);
    for (const double left : {2.0 / 3.0, 1.0 / 3.0, 0.0}) {
        fade.update(viewpoint, head, false, 0.1);
        CHECK(fade.darkness() == doctest::Approx(left));
    }
}

TEST_CASE("pictures are multiplied by alpha, in the order and the encoding of their image") {
    CHECK(texelOf({1.0, 0.0, 0.0}, 1.0, {false, true}) == 0xff0000ffu);
    CHECK(texelOf({1.0, 0.0, 0.0}, 1.0, {true, true}) == 0xffff0000u);
    CHECK(texelOf({1.0, 1.0, 1.0}, 0.5, {false, true}) == 0x80808080u);
    // Half the light is byte 188 in sRGB.
    CHECK(texelOf({1.0, 1.0, 1.0}, 0.5, {false, false}) == 0x80bcbcbcu);
    const TexelPicture sheet = drawSprites({false, false});
    const auto alpha = [&](Sprite sprite, const glm::dvec2& share) {
        const auto [from_px, size_px] = placeOf(sprite);
        const glm::uvec2 at = from_px + glm::uvec2(share * glm::dvec2(size_px));
        return alphaAt(sheet, at.x, at.y);
    };
    CHECK(these(alpha(Sprite::kRay, {0.5, 0.99}), alpha(Sprite::kFadingRay, {0.5, 0.08})) == these(1.0, 1.0));
    CHECK(alpha(Sprite::kFadingRay, {0.5, 0.99}) < 0.05);
    for (const Sprite ray : {Sprite::kRay, Sprite::kFadingRay}) { CHECK(alpha(ray, {0.5, 0.0}) < 0.1); }
    CHECK(alpha(Sprite::kVignette, {0.5, 0.5}) == 0.0);
    CHECK(alpha(Sprite::kVignette, {0.0, 0.5}) > 0.9);
    CHECK(these(alpha(Sprite::kKnob, {0.0, 0.0}), alpha(Sprite::kKnob, {0.5, 0.5})) == these(0.0, 1.0));
}

}  // SUITE(room)
