// Facts about where the viewer takes the eyes to look.
#include "app/view/wearer/gaze_follower.h"

#include <doctest/doctest.h>

#include <cmath>

TEST_SUITE_BEGIN("gaze_follower");

namespace gaze_follower_test {

using namespace binosplat;

namespace {

constexpr double kStep = 0.01;
const double kLensClear = glm::radians(15.0);

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return 2.0 * std::asin(0.5 * glm::distance(glm::normalize(a), glm::normalize(b)));
}

// Canted eyes: the left one is turned outwards by 5 degrees.
const std::array<Pose, 2> kEyes{Pose{glm::angleAxis(glm::radians(-5.0), glm::dvec3(0, 1, 0)), {-0.03, 0.0, 0.0}},
                                Pose{{1, 0, 0, 0}, {0.03, 0.0, 0.0}}};
const glm::dvec3 kAside = glm::normalize(glm::dvec3(0.3, -0.2, 1.0));

}  // namespace

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

}  // namespace gaze_follower_test
