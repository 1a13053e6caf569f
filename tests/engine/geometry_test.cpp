// Facts about poses, cameras and eyes.
#include "engine/geometry.h"
#include "tests/suite.h"

SUITE(geometry) {

bool isNear(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-12; }

// Two poses with nothing special about them.
const Pose kA{glm::normalize(glm::dquat(0.9, 0.1, -0.3, 0.2)), {1.0, -2.0, 3.0}};
const Pose kB{glm::normalize(glm::dquat(-0.2, 0.5, 0.4, 0.7)), {0.5, 0.25, -4.0}};

TEST_CASE("a pose turns a point and then moves it, a composition applies the inner one first, and an inverse cancels it") {
    // A quarter turn about z takes x to y.
    const Pose pose{glm::dquat(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)), {10.0, 20.0, 30.0}};
    CHECK(isNear(transform(pose, {1.0, 0.0, 0.0}), {10.0, 21.0, 30.0}));
    const glm::dvec3 point(0.3, -0.7, 1.1);
    CHECK(isNear(transform(compose(kA, kB), point), transform(kA, transform(kB, point))));
    CHECK(isNear(transform(compose(kA, inverse(kA)), point), point));
    CHECK(isNear(transform(compose(inverse(kA), kA), point), point));
}

TEST_CASE("a camera's right is forward x up and its down is forward x right, whatever length and slope up has") {
    struct {
        glm::dvec3 eye, look, up, right, down, forward;
    } const cameras[]{{{1.0, 2.0, 3.0}, {1.0, 2.0, 8.0}, {0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                      // Along -z with +y up, as in OpenXR.
                      {{0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {0.0, 0.0, -1.0}},
                      {{0.0, 0.0, 0.0}, {0.0, 0.0, -5.0}, {0.0, 7.0, 3.0}, {1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {0.0, 0.0, -1.0}}};
    for (const auto& camera : cameras) {
        const Pose pose = lookAt(camera.eye, camera.look, camera.up);
        CHECK(isNear(pose.orientation * glm::dvec3(1.0, 0.0, 0.0), camera.right));
        CHECK(isNear(pose.orientation * glm::dvec3(0.0, 1.0, 0.0), camera.down));
        CHECK(isNear(pose.orientation * glm::dvec3(0.0, 0.0, 1.0), camera.forward));
        CHECK(isNear(pose.position, camera.eye));
        CHECK(glm::length(pose.orientation) == doctest::Approx(1.0).epsilon(1e-14));
    }
}

TEST_CASE("a camera without a direction is refused") {
    const glm::dvec3 up(0.0, 1.0, 0.0), nowhere(0.0);
    CHECK_THROWS_AS(lookAt({1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, up), Error);
    CHECK_THROWS_AS(lookAt(nowhere, {0.0, 3.0, 0.0}, up), Error);
    CHECK_THROWS_AS(lookAt(nowhere, {0.0, -3.0, 0.0}, up), Error);
    CHECK_THROWS_AS(lookAt(nowhere, {0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}), Error);
    CHECK_THROWS_AS(lookAt(nowhere, {0.0, 0.0, std::numeric_limits<double>::quiet_NaN()}, up), Error);
}

TEST_CASE("four angles land on the picture's edges, and a field of view gives square pixels about its middle") {
    const ViewAngles angles{glm::radians(-50.0), glm::radians(40.0), glm::radians(45.0), glm::radians(-48.0)};
    const Intrinsics k = intrinsicsFromAngles(angles, {1000, 800});
    // A ray at angle t from the axis has X/Z = tan t; y points down, so the upper edge is at Y/Z = -tan(up).
    CHECK(k.fx * std::tan(angles.left_rad) + k.cx == doctest::Approx(0.0).epsilon(1e-9));
    CHECK(k.fx * std::tan(angles.right_rad) + k.cx == doctest::Approx(1000.0));
    CHECK(k.fy * -std::tan(angles.up_rad) + k.cy == doctest::Approx(0.0).epsilon(1e-9));
    CHECK(k.fy * -std::tan(angles.down_rad) + k.cy == doctest::Approx(800.0));
    CHECK(k.cx > 500.0);
    const Intrinsics wide = intrinsicsFromFovX(glm::radians(60.0), {200, 100});
    CHECK(wide.fx == doctest::Approx(100.0 * std::sqrt(3.0)));
    CHECK(wide.fy == wide.fx);
    CHECK(wide.cx == 100.0);
    CHECK(wide.cy == 50.0);
}

TEST_CASE("the left eye is half the eye distance along the camera's -x, so that it sees what is ahead to its right") {
    const auto eyes = stereoPair({kA, {300.0, 310.0, 20.0, 30.0}, {64, 48}}, 0.064);
    for (const int side : {kLeft, kRight}) {
        const glm::dvec3 away = (side == kLeft ? -0.032 : 0.032) * (kA.orientation * glm::dvec3(1.0, 0.0, 0.0));
        const Eye& eye = eyes[side];
        CHECK(isNear(eye.world_from_camera.position, kA.position + away));
        CHECK(eye.world_from_camera.orientation == kA.orientation);
        CHECK(eye.intrinsics.cx == 20.0);
        CHECK(eye.size_px == glm::uvec2(64, 48));
        const glm::dvec3 ahead = transform(kA, {0.0, 0.0, 2.0});
        CHECK(transform(inverse(eye.world_from_camera), ahead).x == doctest::Approx(side == kLeft ? 0.032 : -0.032));
    }
}

}  // SUITE(geometry)
