// How many splats of a streamed scene there are, on machines that are made up.
#include "app/view/governor/splat_budget.h"

#include <doctest/doctest.h>

TEST_SUITE_BEGIN("splat_budget");

namespace splat_budget_test {

using namespace binosplat;

namespace {

constexpr double kPeriodMs = 1000.0 / 90.0;

}  // namespace

TEST_CASE("a streamed scene has as many splats as frames have time for, between what the memory holds and a least number") {
    // Two milliseconds, and a microsecond for each thousand splats: 7 ms of 11.1 leave 5 million.
    SplatBudget budget(20'000'000);
    std::uint64_t shown = 0;
    for (int frame = 0; frame < 4000; ++frame) {
        shown = budget.splats();
        budget.measure(2.0 + 1e-6 * static_cast<double>(shown), kPeriodMs, shown);
    }
    CHECK(2.0 + 1e-6 * static_cast<double>(shown) < 0.9 * kPeriodMs);
    CHECK(2.0 + 1e-6 * static_cast<double>(shown) > 0.5 * kPeriodMs);
    int changes = 0;
    for (int frame = 0; frame < 4000; ++frame) { changes += budget.measure(2.0 + 1e-6 * static_cast<double>(shown), kPeriodMs, shown); }
    CHECK(changes == 0);
    for (int frame = 0; frame < 4000; ++frame) { budget.measure(100.0, kPeriodMs, budget.splats()); }
    CHECK(budget.splats() == SplatBudget::kLeast);
    // What the view does not ask for is not counted up.
    for (int frame = 0; frame < 4000; ++frame) { budget.measure(1.0, kPeriodMs, 100'000); }
    CHECK(budget.splats() <= 600'000);
    SplatBudget small(1000);
    for (int frame = 0; frame < 4000; ++frame) { small.measure(100.0, kPeriodMs, small.splats()); }
    CHECK(small.splats() == 1000);
}

}  // namespace splat_budget_test
