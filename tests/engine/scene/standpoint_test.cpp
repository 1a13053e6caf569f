// Where one stands in captures as people make them, without cameras: each is made here, small, with what makes its kind hard.
#include "engine/scene/standpoint.h"
#include "engine/scene/floor_choice.h"
#include "engine/scene/procedural.h"
#include "tests/shared_data.h"
#include "tests/suite.h"

#include <functional>

SUITE(standpoint) {

const glm::dvec3 kUp(0, -1, 0);

void turnScene(Scene& scene, const glm::dquat& turn, double scale = 1.0) {
    for (std::size_t i = 0; i < scene.size(); ++i) {
        scene.positions[i] = glm::vec3(scale * (turn * glm::dvec3(scene.positions[i])));
        scene.rotations[i] = glm::quat(turn * glm::dquat(scene.rotations[i]));
        scene.scales[i] *= static_cast<float>(scale);
    }
}

// Scenes in metres, y down: the floor is y = 0.
class Maker {
public:
    // A rectangle of splats: its corner and two sides, splats evenly at random, facing its normal.
    Maker& wall(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b, double per_square_metre = 250.0, double bumps = 0.0) {
        const glm::dvec3 normal = glm::normalize(glm::cross(a, b));
        const auto count = static_cast<int>(per_square_metre * glm::length(glm::cross(a, b)));
        for (int i = 0; i < count; ++i) { add(corner + next() * a + next() * b + bumps * (next() - 0.5) * normal, normal); }
        return *this;
    }
    // The sides, the top and, as the last one, the bottom of a box.
    Maker& box(const glm::dvec3& low, const glm::dvec3& high, double per_square_metre = 250.0, bool has_bottom = true) {
        const glm::dvec3 s = high - low, x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
        wall(low, x, y, per_square_metre).wall(low, y, z, per_square_metre).wall(low, x, z, per_square_metre);
        wall(high, -x, -y, per_square_metre).wall(high, -y, -z, per_square_metre);
        return has_bottom ? wall(high, -x, -z, per_square_metre) : *this;
    }
    Maker& ball(const glm::dvec3& centre, double radius, int count) {
        std::normal_distribution<double> bell;
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 normal = glm::normalize(glm::dvec3(bell(random_), bell(random_), bell(random_)));
            add(centre + radius * normal, normal);
        }
        return *this;
    }
    // Splats from here on are so large.
    Maker& sized(double size) {
        size_ = size;
        return *this;
    }
    // One splat in fifty lies far away, or anywhere.
    Maker& floaters(double within) {
        for (std::size_t i = 0, count = scene_.size() / 49; i < count; ++i) {
            add(within * (2.0 * glm::dvec3(next(), next(), next()) - 1.0), {0, 0, 1});
            scene_.scales.back() = glm::vec2(0.2f);
        }
        return *this;
    }
    Maker& turn(const glm::dquat& turn, double scale = 1.0) {
        turnScene(scene_, turn, scale);
        return *this;
    }
    // Splats anywhere in a box.
    Maker& fill(const glm::dvec3& low, const glm::dvec3& high, int count) {
        for (int i = 0; i < count; ++i) { add(low + glm::dvec3(next(), next(), next()) * (high - low), {0, 1, 0}); }
        return *this;
    }
    [[nodiscard]] const Scene& scene() const { return scene_; }

private:
    double next() { return std::uniform_real_distribution<double>()(random_); }
    void add(const glm::dvec3& centre, const glm::dvec3& normal) {
        const glm::dvec3 across = glm::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 u = glm::normalize(glm::cross(normal, across));
        scene_.positions.emplace_back(centre);
        scene_.rotations.emplace_back(glm::quat_cast(glm::mat3(u, glm::cross(normal, u), normal)));
        scene_.scales.emplace_back(static_cast<float>(size_));
        scene_.opacities.push_back(0.9f);
    }

    Scene scene_;
    double size_ = 0.03;
    std::mt19937 random_{7};
};

// 6 by 5 metres, 2.8 high, with a table full of things in one corner and a cupboard.
Maker room() {
    Maker made;
    made.box({-3, -2.8, 0}, {3, 0, 5});
    made.box({1.2, -0.8, 3.2}, {2.4, 0, 4.2}, 2000.0);
    return made.box({-2.9, -2.0, 1.0}, {-2.3, 0.0, 2.0});
}

Maker street() {
    Maker made;
    made.wall({-4, 0, -20}, {8, 0, 0}, {0, 0, 40}, 40.0, 0.1);
    for (const double side : {-4.0, 4.0}) { made.wall({side, -9, -20}, {0, 9, 0}, {0, 0, 40}, 20.0); }
    return made.box({-3.5, -1.5, 2}, {-1.8, 0, 6}, 150.0);
}

// A head on a pedestal, with nothing about it.
Maker statue() {
    Maker made;
    made.ball({0.2, -1.9, 0.1}, 0.4, 6000);
    return made.box({0.0, -1.5, -0.1}, {0.4, -0.1, 0.3}, 1000.0);
}

Maker statueOnGround() {
    Maker made = statue();
    return made.wall({-2.5, 0, -2.5}, {5, 0, 0}, {0, 0, 5}, 200.0);
}

// A crate of half a metre is no room, though it has a floor, walls and a ceiling.
Maker crate() { return Maker().box({-0.3, -0.5, -0.25}, {0.3, 0, 0.25}, 8000.0); }

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
    made.box({-0.9, -0.9, -2.2}, {0.9, -0.2, 2.2}, 900.0, false).box({-0.7, -1.5, -1.2}, {0.7, -0.9, 1.0}, 900.0, false);
    return made.sized(0.06).wall({-6, 0, -6}, {12, 0, 0}, {0, 0, 12}, 60.0, 0.03);
}

// A wall with something before it, in which most of the splats lie.
Maker fence() {
    Maker made;
    made.wall({-3, -3, 0}, {6, 0, 0}, {0, 6, 0});
    for (const double x : {-0.8, -0.4, 0.0, 0.4, 0.8}) { made.wall({x, -1, -2}, {0.02, 0, 0}, {0, 2, 0}, 2000.0); }
    return made;
}

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

bool isInside(const Standpoint& point) { return point.why.starts_with("inside"); }

double degreesOff(const Standpoint& point, const glm::dvec3& place) {
    return degreesBetween(point.view.look - point.view.eye, place - point.view.eye);
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

// Whole, from outside.
void checkWhole(const Standpoint& point, const glm::dvec3& middle, double radius) {
    const double distance = glm::distance(point.view.eye, middle);
    CHECK(distance > 1.3 * radius);
    CHECK(distance < 4.0 * radius);
    CHECK(degreesOff(point, middle) < 12.0);
}

// A scene; whether one stands inside; how many degrees up may be off; and what else holds, in the scene's own axes.
struct Kind {
    const char* name;
    Maker (*make)();
    std::optional<bool> is_inside;
    double up_deg;
    std::function<void(const glm::dvec3& eye, const Standpoint& point)> check;
};

const Kind kKinds[] = {
    {"a room is entered at eye height, clear of its walls, and its densest part, a corner's table, is looked at", room, true, 1.5,
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
    {"a fence is seen from in front, without a floor", fence, false, 180.0,
     [](const glm::dvec3&, const Standpoint& point) { CHECK(point.up_why.ends_with("no floor was found")); }},
    {"a garden is entered: its table is looked at from the lawn, under a sky of a fifth of the splats", garden, true, 1.5,
     [](const glm::dvec3& eye, const Standpoint& point) {
         CHECK(-eye.y == doctest::Approx(1.6).epsilon(0.06));
         CHECK(glm::length(eye) < 9.0);
         CHECK(degreesOff(point, {0, -0.9, 0}) < 10.0);
     }},
    {"a thing on a desk is seen from outside, as large as it is, whatever room there is about it", scannedToy, false, 1.5,
     [](const glm::dvec3& eye, const Standpoint&) {
         CHECK(glm::distance(eye, {0, -0.09, 0}) > 0.12);
         CHECK(glm::distance(eye, {0, -0.09, 0}) < 0.6);
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
    {"a town is looked at from between its roofs or from outside, never from within a house", town, std::nullopt, 2.0,
     [](const glm::dvec3& eye, const Standpoint&) {
         CHECK(eye.y < -1.0);
         const glm::dvec2 block(std::abs(std::remainder(eye.x, 40.0)), std::abs(std::remainder(eye.z, 40.0)));
         CHECK((std::max(block.x, block.y) > 12.5 || eye.y < -30.0));
     }},
};

void checkKinds(bool has_floaters, double tilt, double heading) {
    const glm::dquat turn = glm::angleAxis(tilt, glm::normalize(glm::dvec3(1, 0, 0.4))) * glm::angleAxis(heading, glm::dvec3(0, 1, 0));
    for (const Kind& kind : kKinds) {
        Maker made = kind.make();
        if (has_floaters) { made.floaters(30.0); }
        Standpoint point = judgeStandpoint(made.turn(turn).scene());
        CAPTURE(kind.name);
        CAPTURE(has_floaters);
        CAPTURE(tilt);
        CAPTURE(heading);
        CAPTURE(point.why);
        for (glm::dvec3* const end : {&point.view.eye, &point.view.look, &point.view.up}) { *end = glm::conjugate(turn) * *end; }
        CHECK(kind.is_inside.value_or(isInside(point)) == isInside(point));
        CHECK(degreesBetween(point.view.up, kUp) <= kind.up_deg);
        kind.check(point.view.eye, point);
    }
}

TEST_CASE("every kind of scene is looked at from where people would stand, as it is, and turned with floaters") {
    checkKinds(false, 0.0, 0.0);
    checkKinds(true, 0.3, 2.5);
}

TEST_CASE("every kind of scene is looked at from where people would stand, with floaters and without, turned and tilted" *
          test::nightly()) {
    for (const bool has_floaters : {false, true}) {
        for (const double tilt : {0.0, 0.3, 0.6}) {
            for (const double heading : {0.0, 0.7, 2.5}) { checkKinds(has_floaters, tilt, heading); }
        }
    }
}

glm::dquat aboutAxis(int axis, double degrees) {
    glm::dvec3 direction(0.0);
    direction[axis] = 1.0;
    return glm::angleAxis(glm::radians(degrees), direction);
}

// The axis of each, and degrees: none, up along z, along x, along y and neither.
constexpr std::pair<int, double> kTurns[] = {{0, 0.0}, {0, 90.0}, {0, -90.0}, {2, 90.0}, {0, 180.0}, {0, 30.0}};

// The same scene, whichever of the file's axes is up.
void checkTurned(const Scene& scene, bool is_inside, const std::function<void(const glm::dvec3& eye)>& check) {
    for (const auto& [axis, degrees] : kTurns) {
        CAPTURE(axis);
        CAPTURE(degrees);
        const glm::dquat turn = aboutAxis(axis, degrees);
        Scene turned = scene;
        turned.name.clear();
        turnScene(turned, turn);
        const Standpoint point = judgeStandpoint(turned);
        CAPTURE(point.why);
        CAPTURE(point.up_why);
        CHECK(degreesBetween(glm::conjugate(turn) * point.view.up, kUp) < 5.0);
        CHECK(point.up_why.starts_with("of the floor: "));
        CHECK(isInside(point) == is_inside);
        check(glm::conjugate(turn) * point.view.eye);
    }
}

TEST_CASE("up, the height of the eye and the place within a room are the same whichever axis of the file is up") {
    checkTurned(makeBuiltin("builtin:atelier", 20000), true, [](const glm::dvec3& eye) {
        CHECK(std::abs(-eye.y - 1.6) < 0.2);
        CHECK(std::abs(eye.x) < 2.8);
        CHECK(std::abs(eye.z - 2.5) < 2.3);
    });
    checkTurned(statueOnGround().scene(), false, [](const glm::dvec3& eye) { CHECK(std::abs(-eye.y - 1.9) < 0.2); });
    checkTurned(scannedToy().scene(), false, [](const glm::dvec3& eye) { CHECK(std::abs(-eye.y - 0.15) < 0.02); });
    // From above, whose z is up.
    Maker drone = town();
    CHECK(degreesBetween(judgeStandpoint(drone.turn(aboutAxis(0, -90.0)).scene()).view.up, {0, 0, 1}) < 2.0);
}

TEST_CASE("real things are seen upright, from outside, whichever axis of the file is up" * test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    for (const auto& [file, height] :
         {std::pair("playbot/playbot_lod3_2dgs_sh2.ply", 1.18), std::pair("statues/angel_2dgs_sh0.ply", 1.59)}) {
        CAPTURE(file);
        checkTurned(loadScene((*data / file).string()), false, [&](const glm::dvec3& eye) { CHECK(std::abs(-eye.y - height) < 0.2); });
    }
}

TEST_CASE("a facade is no ground: a wall with a relief, seen from the front, stays upright") {
    Maker made;
    made.wall({-5, -6, 0}, {10, 0, 0}, {0, 6, 0}, 300.0);
    for (const double x : {-3.5, -1.0, 1.5}) { made.box({x, -4.5, -0.8}, {x + 1.5, -3.0, 0}, 400.0, false); }
    const Standpoint point = judgeStandpoint(made.scene());
    CAPTURE(point.up_why);
    CHECK(degreesBetween(point.view.up, kUp) < 2.0);
    CHECK(point.view.eye.z < -3.0);
}

TEST_CASE("the axis that the file names as vertical is kept to; the floor says which way is up, or a format") {
    // On its own this would lie on its back.
    Maker made = statueOnGround();
    Scene scene = made.scene();
    const auto upOf = [&](int vertical_axis, bool y_up) {
        scene.vertical_axis = vertical_axis;
        scene.y_up = y_up;
        return judgeStandpoint(scene).view.up;
    };
    CHECK(degreesBetween(upOf(-1, false), {0, -1, 0}) < 1.5);
    CHECK(degreesBetween(upOf(1, true), {0, 1, 0}) < 1.5);
    CHECK(degreesBetween(upOf(2, false), {0, 0, 1}) < 1.5);
    for (const double degrees : {90.0, -90.0}) {
        Maker turned = statueOnGround();
        scene = turned.turn(aboutAxis(0, degrees)).scene();
        CHECK(degreesBetween(upOf(2, false), {0, 0, degrees > 0.0 ? -1 : 1}) < 1.5);
    }
}

TEST_CASE("one stands beneath nothing: the floor is on the other side of cameras that look every way") {
    Maker made = town();
    const Scene scene = made.turn(aboutAxis(0, 90.0)).scene();
    const std::optional<glm::dvec3> up = upBeneath(scene, {0, 0, -80});
    REQUIRE(up);
    CHECK(degreesBetween(*up, {0, 0, -1}) < 2.0);
    CHECK_FALSE(upBeneath(scene, {0, 0, 80}));
}

TEST_CASE("an up that is given is kept") {
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, -1, 0.1));
    CHECK(glm::distance(judgeStandpoint(room().scene(), {60.0, 1.0, up}).view.up, up) < 1e-12);
}

TEST_CASE("an empty room is one by its size, and one whose units are no metres by what stands in it") {
    CHECK(isInside(judgeStandpoint(Maker().box({-3, -2.8, 0}, {3, 0, 5}).scene())));
    Maker small = room();
    small.turn({1, 0, 0, 0}, 0.1);
    const Standpoint in_small = judgeStandpoint(small.scene());
    CAPTURE(in_small.why);
    CHECK(isInside(in_small));
    CHECK(-in_small.view.eye.y > 0.08);
    CHECK(-in_small.view.eye.y < 0.22);
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

TEST_CASE("what has no floor has none: a ball, a wall and a handful of splats") {
    const auto floorOf = [](const Maker& made) { return chooseFloor(sampleSplats(made.scene(), 32768), {}); };
    CHECK_FALSE(floorOf(Maker().ball({0, 0, 0}, 1.0, 20000)));
    CHECK_FALSE(floorOf(Maker().wall({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 5000.0)));
    CHECK_FALSE(floorOf(Maker().ball({0, 0, 0}, 1.0, 100)));
    CHECK_FALSE(floorOf(Maker()));
    CHECK(floorOf(room())->share == doctest::Approx(0.22).epsilon(0.4));
}

TEST_CASE("what was seen from in front alone, a wall, a photograph and a single splat are looked at from in front") {
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
    for (const char* name : {"fence", "step-edge", "slanted-wall", "two-layers"}) {
        CAPTURE(name);
        CHECK(glm::distance(judgeStandpoint(makeBuiltin(std::string("builtin:") + name)).view.up, kUp) < 1e-12);
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
        CHECK(glm::distance(at_one.view.eye, at_one.view.look) > 2.0 * static_cast<double>(scale));
        CHECK(glm::distance(at_one.view.eye, at_one.view.look) < std::max(2.0, 10.0 * static_cast<double>(scale)));
    }
}

TEST_CASE("what is solid is no room, and a huge splat at the head of the file moves nobody") {
    Maker solids[] = {Maker().box({-1, -2, -1}, {1, 0, 1}, 400.0).fill({-1, -2, -1}, {1, 0, 1}, 6000),
                      Maker().box({-3, -2.5, -3}, {3, 0, 3}, 100.0).fill({-3, -2.5, -3}, {3, 0, 3}, 15000),
                      Maker().box({-1, -2, -8}, {1, 0, 8}, 100.0).fill({-1, -2, -8}, {1, 0, 8}, 10000)};
    for (const Maker& solid : solids) {
        const Standpoint point = judgeStandpoint(solid.scene());
        CAPTURE(point.why);
        CHECK_FALSE(isInside(point));
        CHECK(shareSeen(point, solid.scene(), point.view.look, 100.0) > 0.95);
    }
    for (Maker (*const make)() : {statue, crate, scannedToy, room}) {
        const View before = judgeStandpoint(make().scene()).view;
        Maker first = Maker().sized(300.0).ball({0.1, -0.3, 0.1}, 0.0, 1);
        Scene scene = make().scene();
        scene.positions.front() = first.scene().positions.front();
        scene.scales.front() = first.scene().scales.front();
        CHECK(glm::distance(judgeStandpoint(scene).view.eye, before.eye) < 0.05 * glm::distance(before.eye, before.look));
    }
}

TEST_CASE("nothing at the start is nearer than what is drawn") {
    for (const double scale : {100.0, 1.0, 0.1, 0.001}) {
        CAPTURE(scale);
        Maker toy = scannedToy();
        const Scene scene = toy.turn({1, 0, 0, 0}, scale).scene();
        const Standpoint point = judgeStandpoint(scene, {60.0, 1.0 / scale, {}});
        CHECK(usualNear(scene) == doctest::Approx(scale == 100.0 ? 0.2 : 0.2 * coreSize(scene)));
        CHECK(glm::distance(point.view.eye, point.view.look) > 2.0 * usualNear(scene));
    }
    CHECK(usualNear({}) == 0.2);
    CHECK(usualNear(room().scene()) == 0.2);
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
