// Where one stands in a scene without cameras: made rooms, streets and objects, tilted, and with one splat in fifty a floater.
#include "engine/scene/floor_plane.h"
#include "engine/scene/procedural.h"
#include "tests/engine/scene/made_scenes.h"

TEST_SUITE_BEGIN("standpoint");

namespace standpoint_test {

using namespace binosplat;
using namespace binosplat::test;

TEST_CASE("a room is entered at eye height, clear of its walls, and its densest part is looked at") {
    tryLies(room, [](const Standpoint& point, double) {
        CHECK(isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) < 1.5);
        const glm::dvec3& eye = point.view.eye;
        CHECK(-eye.y == doctest::Approx(1.6).epsilon(0.06));
        CHECK(std::abs(eye.x) < 2.3);
        CHECK(std::abs(eye.z - 2.5) < 1.8);
        // The table's corner.
        CHECK(degreesBetween(point.view.look - eye, glm::dvec3(1.8, -0.5, 3.7) - eye) < 20.0);
    });
}

TEST_CASE("a street is entered between its houses") {
    tryLies(street, [](const Standpoint& point, double) {
        CHECK(isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) < 2.0);
        CHECK(std::abs(point.view.eye.x) < 3.2);
        CHECK(std::abs(point.view.eye.z) < 15.0);
        CHECK(-point.view.eye.y == doctest::Approx(1.6).epsilon(0.15));
    });
}

TEST_CASE("an object is looked at from outside, whole, and upright where it stands on something") {
    const auto isWhole = [](const Standpoint& point, const glm::dvec3& middle, double radius) {
        CHECK_FALSE(isInside(point));
        const double distance = glm::distance(point.view.eye, middle);
        CHECK(distance > 1.3 * radius);
        CHECK(distance < 4.0 * radius);
        CHECK(degreesBetween(point.view.look - point.view.eye, middle - point.view.eye) < 12.0);
    };
    tryLies(statue, [&](const Standpoint& point, double) { isWhole(point, {0.2, -1.2, 0.1}, 1.15); });
    tryLies(statueOnGround, [&](const Standpoint& point, double) {
        isWhole(point, {0.2, -1.2, 0.1}, 1.15);
        CHECK(degreesBetween(point.view.up, kUp) < 1.5);
        CHECK(point.view.eye.y < -1.0);  // above the ground
    });
    // A crate of half a metre is no room, though it has a floor, walls and a ceiling.
    tryLies(
        [] {
            return Maker().box({-0.3, -0.5, -0.25}, {0.3, 0, 0.25}, 8000.0);
        },
        [&](const Standpoint& point, double) {
            isWhole(point, {0, -0.25, 0}, 0.46);
        });
}

TEST_CASE("an object on the ground whose z is up stands upright, too") {
    Maker made = statueOnGround();
    made.turn(glm::angleAxis(glm::radians(90.0), glm::dvec3(1, 0, 0)));  // -y comes to -z
    const Standpoint point = judgeStandpoint(made.scene());
    CAPTURE(point.why);
    CHECK(degreesBetween(point.view.up, {0, 0, -1}) < 1.5);
    CHECK_FALSE(isInside(point));
}

TEST_CASE("an empty room is one by its size, and one whose units are no metres by what stands in it") {
    const auto empty = [] { return Maker().box({-3, -2.8, 0}, {3, 0, 5}); };
    CHECK(isInside(judgeStandpoint(empty().scene())));
    Maker small = room();
    small.turn({1, 0, 0, 0}, 0.1);
    const Standpoint in_small = judgeStandpoint(small.scene());
    CAPTURE(in_small.why);
    CHECK(isInside(in_small));
    CHECK(-in_small.view.eye.y > 0.08);
    CHECK(-in_small.view.eye.y < 0.22);
    CHECK(-judgeStandpoint(small.scene(), {60.0, 10.0, {}}).view.eye.y == doctest::Approx(0.16).epsilon(0.06));
}

TEST_CASE("an up that is given is kept") {
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, -1, 0.1));
    const Standpoint point = judgeStandpoint(room().scene(), {60.0, 1.0, up});
    CHECK(glm::distance(point.view.up, up) < 1e-12);
}

TEST_CASE("what has no floor has none: a ball, a wall and a handful of splats") {
    const auto floorOf = [](const Maker& made) { return findFloorPlane(sampleSplats(made.scene(), 32768), kUp); };
    CHECK_FALSE(floorOf(Maker().ball({0, 0, 0}, 1.0, 20000)));
    CHECK_FALSE(floorOf(Maker().wall({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 5000.0)));
    CHECK_FALSE(floorOf(Maker().ball({0, 0, 0}, 1.0, 100)));
    CHECK_FALSE(floorOf(Maker()));
    CHECK(floorOf(room())->share == doctest::Approx(0.22).epsilon(0.4));
}

TEST_CASE("a wall with something before it is a wall, looked at from in front, though most of the splats lie in it") {
    const auto fence = [] {
        Maker made;
        made.wall({-3, -3, 0}, {6, 0, 0}, {0, 6, 0});
        for (const double x : {-0.8, -0.4, 0.0, 0.4, 0.8}) { made.wall({x, -1, -2}, {0.02, 0, 0}, {0, 2, 0}, 2000.0); }
        return made;
    };
    tryLies(fence, [](const Standpoint& point, double) {
        CHECK_FALSE(isInside(point));
        CHECK(point.why.find("no floor was found") != std::string::npos);
    });
    const Standpoint point = judgeStandpoint(fence().scene());
    CHECK(glm::distance(point.view.up, kUp) < 1e-12);
    CHECK(degreesBetween(point.view.look - point.view.eye, {0, 0, 1}) < 1.0);
    CHECK(point.view.eye.z < -2.0);
    for (const char* name : {"fence", "step-edge", "slanted-wall", "two-layers"}) {
        CAPTURE(name);
        CHECK(glm::distance(judgeStandpoint(makeBuiltin(std::string("builtin:") + name)).view.up, kUp) < 1e-12);
    }
}

TEST_CASE("splats that nobody sees, and those that are equal, place nobody at infinity") {
    Scene scene = room().scene();
    const Standpoint seen = judgeStandpoint(scene);
    std::ranges::fill(scene.opacities, 0.0f);
    CHECK(judgeStandpoint(scene).view.look == glm::dvec3(0.0));
    std::ranges::fill(scene.opacities, 0.9f);
    std::ranges::fill(scene.positions, glm::vec3(1, 2, 3));
    const Standpoint point = judgeStandpoint(scene);
    CHECK(point.view.look == glm::dvec3(1, 2, 3));
    CHECK(glm::distance(point.view.eye, point.view.look) < 10.0);
    CHECK(isInside(seen));
}

}  // namespace standpoint_test
