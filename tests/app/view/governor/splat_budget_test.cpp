// Facts about how many splats of a streamed scene are shown.
#include "app/view/governor/splat_budget.h"
#include "tests/suite.h"

SUITE(splat_budget) {

constexpr double kPeriodMs = 1000.0 / 90.0;

TEST_CASE("a streamed scene has as many splats as frames have time for") {
    // Two milliseconds, plus a microsecond for each thousand splats: 7 ms of 11.1 leave room for 5 million.
    SplatBudget budget(20'000'000);
    std::uint64_t shown = 0;
    for (int frame = 0; frame < 4000; ++frame) {
        shown = budget.splats();
        budget.measure(2.0 + 1e-6 * static_cast<double>(shown), kPeriodMs, shown);
    }
    const double shown_ms = 2.0 + 1e-6 * static_cast<double>(shown);
    CHECK(shown_ms == between(0.5 * kPeriodMs, 0.9 * kPeriodMs));
    int changes = 0;
    for (int frame = 0; frame < 4000; ++frame) { changes += budget.measure(shown_ms, kPeriodMs, shown); }
    CHECK(changes == 0);
    for (int frame = 0; frame < 4000; ++frame) { budget.measure(100.0, kPeriodMs, budget.splats()); }
    CHECK(budget.splats() == SplatBudget::kLeast);
    // The budget does not grow beyond what the view asks for.
    for (int frame = 0; frame < 4000; ++frame) { budget.measure(1.0, kPeriodMs, 100'000); }
    CHECK(budget.splats() <= 600'000);
    SplatBudget small(1000);
    for (int frame = 0; frame < 4000; ++frame) { small.measure(100.0, kPeriodMs, small.splats()); }
    CHECK(small.splats() == 1000);
}

}  // SUITE(splat_budget)
