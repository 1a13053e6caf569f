// Facts about poses, cameras and eyes.
#include "engine/geometry.h"
#include "engine/error.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

TEST_SUITE_BEGIN("geometry");

namespace geometry_test {

using namespace binosplat;

namespace {

bool isNear(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-12; }

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

// Two poses with nothing special about them.
const Pose kA{glm::normalize(glm::dquat(0.9, 0.1, -0.3, 0.2)), {1.0, -2.0, 3.0}};
const Pose kB{glm::normalize(glm::dquat(-0.2, 0.5, 0.4, 0.7)), {0.5, 0.25, -4.0}};

}  // namespace

TEST_CASE("a pose turns a point and then moves it") {
    // A quarter turn about z takes x to y.
    const Pose pose{glm::dquat(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)), {10.0, 20.0, 30.0}};
    CHECK(isNear(transform(pose, {1.0, 0.0, 0.0}), {10.0, 21.0, 30.0}));
}

TEST_CASE("composition applies the inner pose first") {
    const glm::dvec3 point(0.3, -0.7, 1.1);
    CHECK(isNear(transform(compose(kA, kB), point), transform(kA, transform(kB, point))));
}

TEST_CASE("a pose and its inverse cancel on both sides") {
    const glm::dvec3 point(0.3, -0.7, 1.1);
    CHECK(isNear(transform(compose(kA, inverse(kA)), point), point));
    CHECK(isNear(transform(compose(inverse(kA), kA), point), point));
}

TEST_CASE("a camera that looks along world z with world -y up has the world's axes") {
    const Pose pose = lookAt({1.0, 2.0, 3.0}, {1.0, 2.0, 8.0}, {0.0, -1.0, 0.0});
    CHECK(isNear(pose.orientation * glm::dvec3(1.0, 0.0, 0.0), {1.0, 0.0, 0.0}));
    CHECK(isNear(pose.orientation * glm::dvec3(0.0, 1.0, 0.0), {0.0, 1.0, 0.0}));
    CHECK(isNear(pose.orientation * glm::dvec3(0.0, 0.0, 1.0), {0.0, 0.0, 1.0}));
    CHECK(isNear(pose.position, {1.0, 2.0, 3.0}));
}

TEST_CASE("a camera's right is forward x up and its down is forward x right") {
    // From the origin along -z with +y up, as in OpenXR: right is +x, down is -y.
    const Pose pose = lookAt({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0});
    CHECK(isNear(pose.orientation * glm::dvec3(1.0, 0.0, 0.0), {1.0, 0.0, 0.0}));
    CHECK(isNear(pose.orientation * glm::dvec3(0.0, 1.0, 0.0), {0.0, -1.0, 0.0}));
    CHECK(isNear(pose.orientation * glm::dvec3(0.0, 0.0, 1.0), {0.0, 0.0, -1.0}));
}

TEST_CASE("up need be neither unit nor square to the line of sight") {
    const Pose pose = lookAt({0.0, 0.0, 0.0}, {0.0, 0.0, -5.0}, {0.0, 7.0, 3.0});
    CHECK(isNear(pose.orientation * glm::dvec3(0.0, 1.0, 0.0), {0.0, -1.0, 0.0}));
    CHECK(glm::length(pose.orientation) == doctest::Approx(1.0).epsilon(1e-14));
}

TEST_CASE("a camera without a direction is refused") {
    const glm::dvec3 up(0.0, 1.0, 0.0);
    CHECK_THROWS_AS(lookAt({1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, up), Error);
    CHECK_THROWS_AS(lookAt({0.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, up), Error);
    CHECK_THROWS_AS(lookAt({0.0, 0.0, 0.0}, {0.0, -3.0, 0.0}, up), Error);
    CHECK_THROWS_AS(lookAt({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}), Error);
    CHECK_THROWS_AS(lookAt({0.0, 0.0, 0.0}, {0.0, 0.0, std::numeric_limits<double>::quiet_NaN()}, up), Error);
}

TEST_CASE("the four angles land on the image's edges") {
    const ViewAngles angles{radians(-50.0), radians(40.0), radians(45.0), radians(-48.0)};
    const Intrinsics k = intrinsicsFromAngles(angles, {1000, 800});
    // A ray at angle t from the axis has X/Z = tan t; y points down, so the upper edge is at Y/Z = -tan(up).
    CHECK(k.fx * std::tan(angles.left_rad) + k.cx == doctest::Approx(0.0).epsilon(1e-9));
    CHECK(k.fx * std::tan(angles.right_rad) + k.cx == doctest::Approx(1000.0));
    CHECK(k.fy * -std::tan(angles.up_rad) + k.cy == doctest::Approx(0.0).epsilon(1e-9));
    CHECK(k.fy * -std::tan(angles.down_rad) + k.cy == doctest::Approx(800.0));
    CHECK(k.cx > 500.0);
}

TEST_CASE("even angles put the principal point in the middle") {
    const ViewAngles angles{radians(-45.0), radians(45.0), radians(45.0), radians(-45.0)};
    const Intrinsics k = intrinsicsFromAngles(angles, {640, 640});
    const Intrinsics same = intrinsicsFromFovX(radians(90.0), {640, 640});
    CHECK(k.fx == doctest::Approx(320.0));
    CHECK(k.cx == doctest::Approx(320.0));
    CHECK(k.fx == doctest::Approx(same.fx));
    CHECK(k.fy == doctest::Approx(same.fy));
    CHECK(k.cy == doctest::Approx(same.cy));
}

TEST_CASE("a field of view in x gives square pixels") {
    const Intrinsics k = intrinsicsFromFovX(radians(60.0), {200, 100});
    CHECK(k.fx == doctest::Approx(100.0 * std::sqrt(3.0)));
    CHECK(k.fy == k.fx);
    CHECK(k.cx == 100.0);
    CHECK(k.cy == 50.0);
}

TEST_CASE("the left eye is half the eye distance along the camera's -x") {
    Eye middle{kA, {300.0, 310.0, 20.0, 30.0}, {64, 48}};
    const auto eyes = stereoPair(middle, 0.064);
    const glm::dvec3 right = kA.orientation * glm::dvec3(1.0, 0.0, 0.0);
    CHECK(isNear(eyes[kLeft].world_from_camera.position, kA.position - 0.032 * right));
    CHECK(isNear(eyes[kRight].world_from_camera.position, kA.position + 0.032 * right));
    for (const Eye& eye : eyes) {
        CHECK(eye.world_from_camera.orientation == kA.orientation);
        CHECK(eye.intrinsics.cx == 20.0);
        CHECK(eye.size_px == glm::uvec2(64, 48));
    }
}

TEST_CASE("a point in the middle lies to the right for the left eye") {
    const auto eyes = stereoPair({Pose{}, {100.0, 100.0, 50.0, 50.0}, {100, 100}}, 0.1);
    const glm::dvec3 point(0.0, 0.0, 2.0);
    CHECK(transform(inverse(eyes[kLeft].world_from_camera), point).x == doctest::Approx(0.05));
    CHECK(transform(inverse(eyes[kRight].world_from_camera), point).x == doctest::Approx(-0.05));
}

}  // namespace geometry_test
