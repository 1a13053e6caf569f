// Facts about where the eyes are taken to look while the headset sees them, and while it does not.
#include "app/view/wearer/gaze_follower.h"
#include "tests/suite.h"

SUITE(gaze_follower) {

const double kLensClear = glm::radians(15.0);

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return 2.0 * std::asin(0.5 * glm::distance(glm::normalize(a), glm::normalize(b)));
}

// Canted eyes: the left one is turned outwards by 5 degrees.
const std::array<Pose, 2> kEyes{
    Pose{glm::angleAxis(glm::radians(-5.0), glm::dvec3(0, 1, 0)), {-0.03, 0.0, 0.0}},
    Pose{{1, 0, 0, 0}, {0.03, 0.0, 0.0}}};
const glm::dvec3 kAhead(0.0, 0.0, 1.0), kAside = glm::normalize(glm::dvec3(0.3, -0.2, 1.0));

// Eyes that are followed, and where the right one is taken to look.
struct Eyes {
    static constexpr double kStep = 0.01;
    GazeFollower follower;
    std::array<std::optional<Gaze>, 2> gazes;

    const Gaze& look(const std::optional<glm::dvec3>& seen, double clear_rad = kLensClear) {
        gazes = follower.update(seen, kEyes, clear_rad, kStep);
        REQUIRE(gazes[kLeft]);
        return *gazes[kRight];
    }
    void checkRight(const glm::dvec3& direction, double clear_rad) {
        CHECK(these(gazes[kRight]->direction, gazes[kRight]->clear_rad) == these(direction, clear_rad));
    }
};

TEST_CASE_FIXTURE(Eyes, "an eye looks at the middle of its lens, or where it is seen to") {
    for (int i = 0; i < 100; ++i) {
        look(std::nullopt);
        checkRight(kAhead, kLensClear);
    }
    CHECK(gazes[kLeft]->direction == kAhead);
    for (int i = 0; i < 20; ++i) { look(kAside); }
    CHECK(angleBetween(gazes[kRight]->direction, kAside) < 1e-6);
    CHECK(angleBetween(kEyes[kLeft].orientation * gazes[kLeft]->direction, kAside) < 1e-6);
    CHECK(gazes[kLeft]->clear_rad == doctest::Approx(GazeFollower::kSeenClearRadians));
    // From now on the gaze follows at once.
    CHECK(angleBetween(look(kAhead).direction, kAhead) < 1e-6);
    // Not sharper than without a tracker.
    CHECK(look(kAside, 0.05).clear_rad == doctest::Approx(0.05));
}

TEST_CASE_FIXTURE(Eyes, "a blink changes nothing; a gaze that is lost goes back, without a jump") {
    for (int i = 0; i < 20; ++i) { look(kAside); }
    const Gaze seen = *gazes[kRight];
    for (double t = kStep; t < GazeFollower::kHoldSeconds - 0.5 * kStep; t += kStep) {
        look(std::nullopt);
        checkRight(seen.direction, seen.clear_rad);
    }
    const double whole_rad = angleBetween(seen.direction, kAhead);
    const auto follow = [&](const std::optional<glm::dvec3>& gaze, double seconds) {
        const Gaze before = *gazes[kRight], after = look(gaze);
        const double most_rad = 1.1 * whole_rad * kStep / seconds;
        CHECK(angleBetween(before.direction, after.direction) <= most_rad);
        CHECK(std::abs(before.clear_rad - after.clear_rad) <= most_rad);
    };
    for (int i = 0; i < 100; ++i) { follow(std::nullopt, GazeFollower::kLoseSeconds); }
    checkRight(kAhead, kLensClear);
    for (int i = 0; i < 20; ++i) { follow(kAside, GazeFollower::kFindSeconds); }
    CHECK(angleBetween(gazes[kRight]->direction, kAside) < 1e-6);
}

}  // SUITE(gaze_follower)
