// Which way is up: what a scene stands on, whichever axis of the file is up, and what the file says about it.
#include "engine/files/load_scene.h"
#include "engine/places/floor_choice.h"
#include "tests/engine/places/captures.h"
#include "tests/shared_data.h"

SUITE(floor) {

glm::dquat aboutAxis(int axis, double degrees) {
    return glm::angleAxis(glm::radians(degrees), glm::dmat3(1.0)[axis]);
}

// The axis of each turn, and degrees: none, up along z, along x, along y, and neither.
constexpr std::pair<int, double> kTurns[] = {{0, 0.0},  {0, 90.0},  {0, -90.0},
                                             {2, 90.0}, {0, 180.0}, {0, 30.0}};

// The same scene, whichever of the file's axes is up.
void checkTurned(const Scene& scene, bool is_inside,
                 const std::function<void(const glm::dvec3& eye)>& check) {
    for (const auto& [axis, degrees] : kTurns) {
        INFO("axis ", axis, ", degrees ", degrees);
        const glm::dquat turn = aboutAxis(axis, degrees);
        Scene turned = scene;
        turned.name.clear();
        turnScene(turned, turn);
        const Standpoint point = judgeStandpoint(turned);
        INFO("point.why ", point.why, ", point.up_why ", point.up_why);
        CHECK(degreesBetween(glm::conjugate(turn) * point.view.up, kUp) < 5.0);
        CHECK(point.up_why.starts_with("of the floor: "));
        CHECK(isInside(point) == is_inside);
        check(glm::conjugate(turn) * point.view.eye);
    }
}

TEST_CASE("up, eye height and place in a room are the same whichever axis of the file is up") {
    checkTurned(makeBuiltin("builtin:atelier", 20000), true, [](const glm::dvec3& eye) {
        CHECK(std::abs(-eye.y - 1.6) < 0.2);
        CHECK(std::abs(eye.x) < 2.8);
        CHECK(std::abs(eye.z - 2.5) < 2.3);
    });
    checkTurned(statueOnGround().scene(), false,
                [](const glm::dvec3& eye) { CHECK(std::abs(-eye.y - 1.9) < 0.2); });
    checkTurned(scannedToy().scene(), false,
                [](const glm::dvec3& eye) { CHECK(std::abs(-eye.y - 0.15) < 0.02); });
    // Seen from above; z is up.
    CHECK(degreesBetween(judgeStandpoint(town().turn(aboutAxis(0, -90.0)).scene()).view.up, {0, 0, 1}) < 2.0);
}

TEST_CASE("real things are seen upright, from outside, whichever axis of the file is up" *
          test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    for (const auto& [file, height] : {std::pair("playbot/playbot_lod3_2dgs_sh2.ply", 1.18),
                                       std::pair("statues/angel_2dgs_sh0.ply", 1.59)}) {
        CAPTURE(file);
        checkTurned(loadScene((*data / file).string()), false,
                    [&](const glm::dvec3& eye) { CHECK(std::abs(-eye.y - height) < 0.2); });
    }
}

TEST_CASE("a facade is no ground: a wall with a relief, seen from the front, stays upright") {
    const Standpoint point = judgeStandpoint(relief().scene());
    CAPTURE(point.up_why);
    CHECK(degreesBetween(point.view.up, kUp) < 2.0);
    CHECK(point.view.eye.z < -3.0);
}

TEST_CASE("the axis that the file names as vertical is kept; the floor or a format says which way") {
    // On its own this would lie on its back.
    Scene scene = statueOnGround().scene();
    const auto upOf = [&](int vertical_axis, bool y_up) {
        scene.vertical_axis = vertical_axis;
        scene.y_up = y_up;
        return judgeStandpoint(scene).view.up;
    };
    CHECK(degreesBetween(upOf(-1, false), {0, -1, 0}) < 1.5);
    CHECK(degreesBetween(upOf(1, true), {0, 1, 0}) < 1.5);
    CHECK(degreesBetween(upOf(2, false), {0, 0, 1}) < 1.5);
    for (const double degrees : {90.0, -90.0}) {
        scene = statueOnGround().turn(aboutAxis(0, degrees)).scene();
        CHECK(degreesBetween(upOf(2, false), {0, 0, degrees > 0.0 ? -1 : 1}) < 1.5);
    }
}

TEST_CASE("one stands beneath nothing: the floor is on the other side of cameras that look every way") {
    const Scene scene = town().turn(aboutAxis(0, 90.0)).scene();
    const std::optional<glm::dvec3> up = upBeneath(scene, {0, 0, -80});
    REQUIRE(up);
    CHECK(degreesBetween(*up, {0, 0, -1}) < 2.0);
    CHECK_FALSE(upBeneath(scene, {0, 0, 80}));
}

TEST_CASE("cameras that all look one way look down, unless a floor bears out their up") {
    const auto beneath = [](const Scene& scene, const glm::dvec3& cameras, const glm::dvec3& their_up) {
        const std::optional<glm::dvec3> up = upBeneath(scene, cameras, their_up);
        return up ? degreesBetween(*up, kUp) : 180.0;
    };
    // Seen from above, wherever the top of the pictures points.
    for (const glm::dvec3 their_up :
         {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::normalize(glm::dvec3(-1, 0, 1))}) {
        CHECK(beneath(town().scene(), {0, -80, 0}, their_up) < 2.0);
        CHECK(beneath(car().scene(), {0, -8, 0}, their_up) < 2.0);
    }
    // In front of a facade with a street at its foot.
    const Scene facade = relief().wall({-5, 0, -3}, {10, 0, 0}, {0, 0, 3}, 300.0).scene();
    CHECK(beneath(facade, {0, -3, -8}, kUp) < 2.0);
    // What the file says is believed.
    Scene scene = town().scene();
    scene.vertical_axis = 2;
    CHECK(beneath(scene, {0, -80, 0}, {0, 0, 1}) == 180.0);
}

TEST_CASE("what has no floor has none: a ball, a wall and a handful of splats") {
    const auto floorOf = [](const Maker& made) { return chooseFloor(sampleSplats(made.scene(), 32768), {}); };
    for (const Maker& made : {Maker(), Maker().ball({0, 0, 0}, 1.0, 100), Maker().ball({0, 0, 0}, 1.0, 20000),
                              Maker().wall({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 5000.0)}) {
        CHECK_FALSE(floorOf(made));
    }
    CHECK(floorOf(room())->share == doctest::Approx(0.22).epsilon(0.4));
}

}  // SUITE(floor)
