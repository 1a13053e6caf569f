// Where one stands in captures as people make them, without cameras: each is made here, small, with what makes its kind hard.
#include "tests/engine/scene/made_scenes.h"

TEST_SUITE_BEGIN("standpoint_scenes");

namespace standpoint_scenes_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// A table with a vase on a lawn, a hedge about it, and a sky far away that has a fifth of the splats.
Maker garden() {
    Maker made;
    made.wall({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}, 60.0, 0.05).box({-0.7, -0.75, -0.7}, {0.7, -0.7, 0.7}, 2000.0);
    made.ball({0.1, -0.95, 0.0}, 0.2, 9000).sized(0.1);
    for (const double side : {-9.0, 9.0}) {
        made.wall({side, -4, -9}, {0, 4, 0}, {0, 0, 18}, 60.0, 1.0).wall({-9, -4, side}, {0, 4, 0}, {18, 0, 0}, 60.0, 1.0);
    }
    return made.sized(2.0).ball({0, -5, 0}, 80.0, 12000);
}

// What is scanned on a desk, all around: the object, a piece of the desk, and the room about it as a far, thin shell.
Maker scannedToy() {
    Maker made;
    made.sized(0.003).ball({0, -0.12, 0}, 0.06, 20000).box({-0.04, -0.06, -0.04}, {0.04, 0, 0.04}, 400000.0);
    made.wall({-0.3, 0, -0.3}, {0.6, 0, 0}, {0, 0, 0.6}, 20000.0);
    return made.sized(0.1).ball({0, -1, 0}, 4.0, 6000);
}

// Seen from the front alone, as a few photographs beside one another show it: things on a table, and the wall behind, wide.
Maker facingForward() {
    Maker made;
    for (const double x : {-0.8, 0.0, 0.7}) { made.ball({x, -0.3, 3.0 + 0.3 * x}, 0.25, 5000); }
    return made.wall({-1.6, 0, 2.4}, {3.2, 0, 0}, {0, 0, 1.6}, 800.0).sized(0.08).wall({-5, -3, 7}, {10, 0, 0}, {0, 4, 0}, 400.0, 0.2);
}

// Three walls and a floor: nobody went into the fourth part of the room.
Maker openRoom() {
    Maker made;
    made.wall({-3, 0, 0}, {6, 0, 0}, {0, 0, 5}).wall({-3, -2.8, 5}, {6, 0, 0}, {0, 2.8, 0}).wall({-3, -2.8, 0}, {0, 2.8, 0}, {0, 0, 5});
    made.wall({3, -2.8, 0}, {0, 2.8, 0}, {0, 0, 5});
    return made.box({-0.9, -0.8, 2.8}, {0.9, 0, 3.8}, 1500.0);
}

Maker corridor() {
    Maker made;
    return made.box({-1, -2.5, -8}, {1, 0, 8}, 150.0).box({0.5, -1, 3}, {1, 0, 4}, 1500.0);
}

// From a drone: blocks of houses on level ground.
Maker town() {
    Maker made;
    made.sized(0.6).wall({-150, 0, -150}, {300, 0, 0}, {0, 0, 300}, 0.2, 0.5);
    for (int i = -3; i <= 3; ++i) {
        for (int k = -3; k <= 3; ++k) {
            const glm::dvec3 low(40.0 * i - 12.0, -12.0 - 6.0 * ((i * i + 3 * k) & 3), 40.0 * k - 12.0);
            made.box(low, {low.x + 24.0, 0.0, low.z + 24.0}, 0.3);
        }
    }
    return made;
}

// A car, of which only the outside is seen, in a yard whose ground is all that there is of it.
Maker car() {
    Maker made;
    const auto hull = [&](const glm::dvec3& low, const glm::dvec3& high) {
        const glm::dvec3 s = high - low, x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
        made.wall(low, x, y, 900.0).wall(low, y, z, 900.0).wall(low, x, z, 900.0).wall(high, -x, -y, 900.0).wall(high, -y, -z, 900.0);
    };
    hull({-0.9, -0.9, -2.2}, {0.9, -0.2, 2.2});
    hull({-0.7, -1.5, -1.2}, {0.7, -0.9, 1.0});
    return made.sized(0.06).wall({-6, 0, -6}, {12, 0, 0}, {0, 0, 12}, 60.0, 0.03);
}

// The share of the splats within `reach` of a place that lies in the middle of the picture, 60 degrees wide.
double shareSeen(const Standpoint& point, const Scene& scene, const glm::dvec3& place, double reach) {
    int seen = 0, all = 0;
    for (const glm::vec3& position : scene.positions) {
        if (glm::distance(glm::dvec3(position), place) > reach) { continue; }
        ++all;
        seen += degreesBetween(glm::dvec3(position) - point.view.eye, point.view.look - point.view.eye) < 30.0;
    }
    return static_cast<double>(seen) / std::max(all, 1);
}

}  // namespace

TEST_CASE("a garden is entered: its table is looked at from the lawn, under a sky of a fifth of the splats") {
    tryLies(garden, [](const Standpoint& point, double) {
        CHECK(isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) < 1.5);
        CHECK(-point.view.eye.y == doctest::Approx(1.6).epsilon(0.06));
        CHECK(glm::length(point.view.eye) < 9.0);
        CHECK(degreesBetween(point.view.look - point.view.eye, glm::dvec3(0, -0.9, 0) - point.view.eye) < 10.0);
    });
}

TEST_CASE("a thing that was scanned on a desk is looked at from outside, as large as it is, whatever room there is about it") {
    tryLies(scannedToy, [](const Standpoint& point, double) {
        CHECK_FALSE(isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) < 1.5);
        const double distance = glm::distance(point.view.eye, glm::dvec3(0, -0.09, 0));
        CHECK(distance > 0.12);
        CHECK(distance < 0.6);
        CHECK(point.view.eye.y < 0.0);
    });
    tryLies(car, [](const Standpoint& point, double) {
        CHECK_FALSE(isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) < 1.5);
        CHECK(point.view.eye.y < -1.0);
        CHECK(shareSeen(point, car().scene(), {0, -0.7, 0}, 2.5) > 0.9);
    });
}

TEST_CASE("what was seen from in front alone is looked at from there") {
    const Scene scene = facingForward().scene();
    const Standpoint point = judgeStandpoint(scene);
    CHECK(degreesBetween(point.view.look - point.view.eye, {0, 0, 1}) < 20.0);
    CHECK(degreesBetween(point.view.up, kUp) < 1.5);
    CHECK(point.view.eye.z < 2.4);
    CHECK(shareSeen(point, scene, {0, -0.3, 3}, 1.3) > 0.9);
}

TEST_CASE("a room with three walls, and a corridor eight times as long as wide, are entered") {
    tryLies(openRoom, [](const Standpoint& point, double) {
        CHECK(isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) < 1.5);
        CHECK(std::abs(point.view.eye.x) < 2.7);
        CHECK(point.view.eye.z < 4.7);
        CHECK(degreesBetween(point.view.look - point.view.eye, glm::dvec3(0, -0.6, 3.3) - point.view.eye) < 30.0);
    });
    tryLies(corridor, [](const Standpoint& point, double) {
        CHECK(isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) < 3.0);
        CHECK(std::abs(point.view.eye.x) < 0.8);
        CHECK(std::abs(point.view.eye.z) < 7.5);
    });
}

TEST_CASE("a town is looked at from between its roofs or from outside, never from within a house") {
    tryLies(town, [](const Standpoint& point, double) {
        CHECK(degreesBetween(point.view.up, kUp) < 2.0);
        CHECK(point.view.eye.y < -1.0);
        const glm::dvec2 block(std::abs(std::remainder(point.view.eye.x, 40.0)), std::abs(std::remainder(point.view.eye.z, 40.0)));
        CHECK((std::max(block.x, block.y) > 12.5 || point.view.eye.y < -30.0));
    });
}

TEST_CASE("one stands alike in a scene a hundred times as large, and in one a thousand times smaller") {
    for (const double scale : {100.0, 1.0, 0.001}) {
        CAPTURE(scale);
        Maker large = room(), toy = scannedToy();
        const Standpoint in_room = judgeStandpoint(large.turn({1, 0, 0, 0}, scale).scene(), {60.0, 1.0 / scale, {}});
        CHECK(isInside(in_room));
        CHECK(-in_room.view.eye.y / scale == doctest::Approx(1.6).epsilon(0.06));
        const Standpoint at_toy = judgeStandpoint(toy.turn({1, 0, 0, 0}, scale).scene(), {60.0, 1.0 / scale, {}});
        CHECK_FALSE(isInside(at_toy));
        CHECK(glm::distance(at_toy.view.eye, at_toy.view.look) / scale == doctest::Approx(0.235).epsilon(0.1));
    }
}

TEST_CASE("a single splat and a wall like a photograph are seen from in front") {
    for (const float scale : {1e-4f, 0.03f, 20.0f}) {
        CAPTURE(scale);
        Scene one = Maker().ball({3, 2, 1}, 0.0, 1).scene();
        one.scales[0] = glm::vec2(scale);
        const Standpoint point = judgeStandpoint(one);
        CHECK(point.view.look == glm::dvec3(3, 2, 1));
        CHECK(glm::distance(point.view.eye, point.view.look) > 2.0 * static_cast<double>(scale));
        CHECK(glm::distance(point.view.eye, point.view.look) < std::max(2.0, 10.0 * static_cast<double>(scale)));
    }
    const Scene photograph = Maker().wall({-2, -1.5, 3}, {4, 0, 0}, {0, 3, 0}, 3000.0, 0.01).scene();
    const Standpoint point = judgeStandpoint(photograph);
    CHECK_FALSE(isInside(point));
    CHECK(degreesBetween(point.view.look - point.view.eye, {0, 0, 1}) < 1.0);
    CHECK(glm::distance(point.view.up, kUp) < 1e-12);
    CHECK(shareSeen(point, photograph, {0, 0, 3}, 5.0) > 0.95);
}

}  // namespace standpoint_scenes_test
