// Facts about when a headset counts as worn.
#include "xr/wearing.h"
#include "tests/suite.h"

SUITE(wearing) {

using binosplat::xr::Wearing;

constexpr double kStep = 0.01;

// The seconds until wearing begins, for a head at `place(seconds)`; none if it does not begin within ten.
std::optional<double> beginsAfter(Wearing wearing, const std::function<glm::dvec3(double)>& place,
                                  double focus_from = 0.0) {
    for (double t = 0.0; t < 10.0; t += kStep) {
        if (wearing.begins(t >= focus_from, {glm::dquat(1.0, 0.0, 0.0, 0.0), place(t)}, kStep)) { return t; }
    }
    return std::nullopt;
}

const auto kStill = [](double t) { return glm::dvec3(0.001 * std::sin(40.0 * t), 0.0, 0.0); };
const auto kHead = [](double t) { return glm::dvec3(0.05 * std::sin(t), 0.0, 0.0); };
const auto kLifted = [](double t) { return glm::dvec3(0.0, -std::clamp(t - 5.0, 0.0, 1.0), 0.0); };

TEST_CASE("a head that moves is worn at once, a headset that is lifted after a while, one that lies never") {
    CHECK(beginsAfter({}, kHead).value_or(9.0) < 1.0);
    CHECK(beginsAfter({}, kLifted).value_or(0.0) == doctest::Approx(7.0).epsilon(0.02));
    CHECK_FALSE(beginsAfter({}, kStill).has_value());
}

TEST_CASE("what the runtime says counts, once the program has the input") {
    Wearing wearing;
    wearing.hear(false);
    CHECK_FALSE(beginsAfter(wearing, kHead).has_value());
    Wearing unsure = wearing;
    unsure.forgetPresence();
    CHECK(beginsAfter(unsure, kHead).value_or(9.0) < 1.0);
    wearing.hear(true);
    CHECK(beginsAfter(wearing, kStill, 2.0).value_or(0.0) == doctest::Approx(2.0).epsilon(0.01));
}

}  // SUITE(wearing)
