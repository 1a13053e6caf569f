// Where the viewer starts in captures like those that people make, without cameras.
#include "tests/engine/places/captures.h"

SUITE(standpoint) {

double degreesOff(const Standpoint& point, const glm::dvec3& place) {
    return degreesBetween(point.view.look - point.view.eye, place - point.view.eye);
}

// The share of the splats within `reach` of a place that appear in the middle of the picture, which is 60
// degrees wide.
double shareSeen(const Standpoint& point, const Scene& scene, const glm::dvec3& place, double reach) {
    int seen = 0, all = 0;
    for (const glm::vec3& position : scene.positions) {
        if (glm::distance(glm::dvec3(position), place) > reach) { continue; }
        ++all;
        seen +=
            degreesBetween(glm::dvec3(position) - point.view.eye, point.view.look - point.view.eye) < 30.0;
    }
    return static_cast<double>(seen) / std::max(all, 1);
}

// The whole scene, from outside.
void checkWhole(const Standpoint& point, const glm::dvec3& middle, double radius) {
    const double distance = glm::distance(point.view.eye, middle);
    CHECK(distance == between(1.3 * radius, 4.0 * radius));
    CHECK(degreesOff(point, middle) < 12.0);
}

// A scene, whether the view starts inside, by how many degrees up may be wrong, and what else must hold, in
// the scene's own axes.
struct Kind {
    const char* name;
    Maker (*make)();
    std::optional<bool> is_inside;
    double up_deg;
    std::function<void(const glm::dvec3& eye, const Standpoint& point)> check;
};

const Kind kKinds[] = {
    {"a room is entered at eye height, clear of its walls, and looked at is a corner's table, where most is",
     room, true, 1.5,
     [](const glm::dvec3& eye, const Standpoint& point) {
         CHECK(-eye.y == doctest::Approx(1.6).epsilon(0.06));
         CHECK(std::abs(eye.x) < 2.3);
         CHECK(std::abs(eye.z - 2.5) < 1.8);
         CHECK(degreesOff(point, {1.8, -0.5, 3.7}) < 20.0);
     }},
    {"a street is entered between its houses", street, true, 2.0,
     [](const glm::dvec3& eye, const Standpoint&) {
         CHECK(std::abs(eye.x) < 3.2);
         CHECK(std::abs(eye.z) < 15.0);
         CHECK(-eye.y == doctest::Approx(1.6).epsilon(0.15));
     }},
    {"a statue is seen from outside", statue, false, 180.0,
     [](const glm::dvec3&, const Standpoint& point) {
         checkWhole(point, {0.2, -1.2, 0.1}, 1.15);
     }},
    {"a statue on the ground is upright, seen from above the ground", statueOnGround, false, 1.5,
     [](const glm::dvec3& eye, const Standpoint& point) {
         checkWhole(point, {0.2, -1.2, 0.1}, 1.15);
         CHECK(eye.y < -1.0);
     }},
    {"a crate is seen from outside", crate, false, 180.0,
     [](const glm::dvec3&, const Standpoint& point) {
         checkWhole(point, {0, -0.25, 0}, 0.46);
     }},
    {"a garden is entered: its table is looked at from the lawn, under a sky of a fifth of the splats",
     garden, true, 1.5,
     [](const glm::dvec3& eye, const Standpoint& point) {
         CHECK(-eye.y == doctest::Approx(1.6).epsilon(0.06));
         CHECK(glm::length(eye) < 9.0);
         CHECK(degreesOff(point, {0, -0.9, 0}) < 10.0);
     }},
    {"a thing on a desk is seen from outside, as large as it is, whatever room there is about it", scannedToy,
     false, 1.5,
     [](const glm::dvec3& eye, const Standpoint&) {
         CHECK(glm::distance(eye, {0, -0.09, 0}) == between(0.12, 0.6));
         CHECK(eye.y < 0.0);
     }},
    {"a car is seen from outside", car, false, 1.5,
     [](const glm::dvec3& eye, const Standpoint& point) {
         CHECK(eye.y < -1.0);
         CHECK(shareSeen(point, car().scene(), {0, -0.7, 0}, 2.5) > 0.9);
     }},
    {"a room with three walls is entered", openRoom, true, 1.5,
     [](const glm::dvec3& eye, const Standpoint& point) {
         CHECK(std::abs(eye.x) < 2.7);
         CHECK(eye.z < 4.7);
         CHECK(degreesOff(point, {0, -0.6, 3.3}) < 30.0);
     }},
    {"a corridor eight times as long as wide is entered", corridor, true, 3.0,
     [](const glm::dvec3& eye, const Standpoint&) {
         CHECK(std::abs(eye.x) < 0.8);
         CHECK(std::abs(eye.z) < 7.5);
     }},
    {"a town is looked at from between its roofs or from outside, never from within a house", town,
     std::nullopt, 2.0,
     [](const glm::dvec3& eye, const Standpoint&) {
         CHECK(eye.y < -1.0);
         const glm::dvec2 block(std::abs(std::remainder(eye.x, 40.0)), std::abs(std::remainder(eye.z, 40.0)));
         CHECK((std::max(block.x, block.y) > 12.5 || eye.y < -30.0));
     }},
};

void checkKinds(bool has_floaters, double tilt, double heading) {
    const glm::dquat turn = glm::angleAxis(tilt, glm::normalize(glm::dvec3(1, 0, 0.4))) *
                            glm::angleAxis(heading, glm::dvec3(0, 1, 0));
    for (const Kind& kind : kKinds) {
        Maker made = kind.make();
        if (has_floaters) { made.floaters(30.0); }
        Standpoint point = judgeStandpoint(made.turn(turn).scene());
        INFO("kind.name ", kind.name, ", has_floaters ", has_floaters, ", tilt ", tilt, ", heading ", heading,
             ", point.why ", point.why);
        for (glm::dvec3* const end : {&point.view.eye, &point.view.look, &point.view.up}) {
            *end = glm::conjugate(turn) * *end;
        }
        CHECK(kind.is_inside.value_or(isInside(point)) == isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) <= kind.up_deg);
        kind.check(point.view.eye, point);
    }
}

TEST_CASE("every kind of scene is looked at from where people would stand, also with floaters") {
    checkKinds(false, 0.0, 0.0);
    checkKinds(true, 0.3, 2.5);
}

TEST_CASE("and so it is at other angles" * test::nightly()) {
    for (const bool has_floaters : {false, true}) {
        for (const double tilt : {0.0, 0.3, 0.6}) {
            for (const double heading : {0.0, 0.7, 2.5}) { checkKinds(has_floaters, tilt, heading); }
        }
    }
}

TEST_CASE("an up that is given is kept") {
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, -1, 0.1));
    CHECK(glm::distance(judgeStandpoint(room().scene(), {60.0, 1.0, up}).view.up, up) < 1e-12);
}

TEST_CASE("an empty room is one by its size, and one whose units are no metres by what stands in it") {
    CHECK(isInside(judgeStandpoint(Maker().box({-3, -2.8, 0}, {3, 0, 5}).scene())));
    const Standpoint in_small = judgeStandpoint(room().turn({1, 0, 0, 0}, 0.1).scene());
    CAPTURE(in_small.why);
    CHECK(isInside(in_small));
    CHECK(-in_small.view.eye.y == between(0.08, 0.22));
}

TEST_CASE("one stands alike in scenes of any scale, and nothing at the start is too near to be drawn") {
    for (const double scale : {100.0, 1.0, 0.1, 0.001}) {
        CAPTURE(scale);
        const StandpointWish usual{60.0, 1.0 / scale, {}};
        const Standpoint in_room = judgeStandpoint(room().turn({1, 0, 0, 0}, scale).scene(), usual);
        CHECK(isInside(in_room));
        CHECK(-in_room.view.eye.y / scale == doctest::Approx(1.6).epsilon(0.06));
        const Scene scene = scannedToy().turn({1, 0, 0, 0}, scale).scene();
        const Standpoint at_toy = judgeStandpoint(scene, usual);
        const double away = glm::distance(at_toy.view.eye, at_toy.view.look);
        CHECK_FALSE(isInside(at_toy));
        CHECK(away / scale == doctest::Approx(0.235).epsilon(0.1));
        CHECK(usualNear(scene) == doctest::Approx(scale == 100.0 ? 0.2 : 0.2 * coreSize(scene)));
        CHECK(away > 2.0 * usualNear(scene));
    }
    CHECK(these(usualNear({}), usualNear(room().scene())) == these(0.2, 0.2));
}

TEST_CASE("what was seen from in front alone, and a single splat, are looked at from in front") {
    const auto checkFront = [](const Scene& scene, double most_deg) {
        const Standpoint point = judgeStandpoint(scene);
        CHECK(degreesBetween(point.view.look - point.view.eye, {0, 0, 1}) < most_deg);
        return point;
    };
    const Scene things = facingForward().scene();
    const Standpoint point = checkFront(things, 20.0);
    CHECK(degreesBetween(point.view.up, kUp) < 1.5);
    CHECK(point.view.eye.z < 2.4);
    CHECK(shareSeen(point, things, {0, -0.3, 3}, 1.3) > 0.9);

    const Standpoint at_fence = checkFront(fence().scene(), 1.0);
    CHECK(glm::distance(at_fence.view.up, kUp) < 1e-12);
    CHECK(at_fence.view.eye.z < -2.0);
    CHECK_FALSE(isInside(at_fence));
    CHECK(at_fence.up_why.ends_with("no floor was found"));
    for (const std::string name : {"fence", "step-edge", "slanted-wall", "two-layers"}) {
        CAPTURE(name);
        CHECK(glm::distance(judgeStandpoint(makeBuiltin("builtin:" + name)).view.up, kUp) < 1e-12);
    }
    const Scene photograph = Maker().wall({-2, -1.5, 3}, {4, 0, 0}, {0, 3, 0}, 3000.0, 0.01).scene();
    const Standpoint at_photograph = checkFront(photograph, 1.0);
    CHECK_FALSE(isInside(at_photograph));
    CHECK(glm::distance(at_photograph.view.up, kUp) < 1e-12);
    CHECK(shareSeen(at_photograph, photograph, {0, 0, 3}, 5.0) > 0.95);
    for (const float scale : {1e-4f, 0.03f, 20.0f}) {
        CAPTURE(scale);
        Scene one = Maker().ball({3, 2, 1}, 0.0, 1).scene();
        one.scales[0] = glm::vec2(scale);
        const Standpoint at_one = judgeStandpoint(one);
        CHECK(at_one.view.look == glm::dvec3(3, 2, 1));
        CHECK(glm::distance(at_one.view.eye, at_one.view.look) ==
              between(2.0 * scale, std::max(2.0, 10.0 * scale)));
    }
}

TEST_CASE("what is solid is no room, and a huge splat at the head of the file moves nobody") {
    for (const auto& [half, per_square_metre, count] : {std::tuple(glm::dvec3(1, 2, 1), 400.0, 6000),
                                                        {glm::dvec3(3, 2.5, 3), 100.0, 15000},
                                                        {glm::dvec3(1, 2, 8), 100.0, 10000}}) {
        const glm::dvec3 high(half.x, 0, half.z);
        const Maker solid = Maker().box(-half, high, per_square_metre).fill(-half, high, count);
        const Standpoint point = judgeStandpoint(solid.scene());
        CAPTURE(point.why);
        CHECK_FALSE(isInside(point));
        CHECK(shareSeen(point, solid.scene(), point.view.look, 100.0) > 0.95);
    }
    for (Maker (*const make)() : {statue, crate, scannedToy, room}) {
        const View before = judgeStandpoint(make().scene()).view;
        const Scene huge = Maker().sized(300.0).ball({0.1, -0.3, 0.1}, 0.0, 1).scene();
        Scene scene = make().scene();
        scene.positions.front() = huge.positions.front();
        scene.scales.front() = huge.scales.front();
        CHECK(glm::distance(judgeStandpoint(scene).view.eye, before.eye) <
              0.05 * glm::distance(before.eye, before.look));
    }
}

TEST_CASE("splats that nobody sees, and those that are equal, place nobody at infinity") {
    Scene scene = room().scene();
    std::ranges::fill(scene.opacities, 0.0f);
    CHECK(judgeStandpoint(scene).view.look == glm::dvec3(0.0));
    std::ranges::fill(scene.opacities, 0.9f);
    std::ranges::fill(scene.positions, glm::vec3(1, 2, 3));
    const Standpoint point = judgeStandpoint(scene);
    CHECK(point.view.look == glm::dvec3(1, 2, 3));
    CHECK(glm::distance(point.view.eye, point.view.look) < 10.0);
}

}  // SUITE(standpoint)
