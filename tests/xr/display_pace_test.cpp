// Facts about the pace of displays: what predicted times say about frames that came late, and when they say
// nothing.
#include "xr/display_pace.h"
#include "tests/suite.h"

#include <initializer_list>

SUITE(display_pace) {

using binosplat::xr::DisplayPace;

constexpr XrDuration kPeriod = 10'000'000;
constexpr double kQuick = 0.004, kSlow = 0.011;

// A frame this many periods after the one before.
struct Pace : DisplayPace {
    XrTime now = 1'000'000'000;

    double after(double periods, bool shows = true, double busy_seconds = kQuick, XrDuration period = kPeriod,
                 XrDuration told_period = 0) {
        now += static_cast<XrTime>(periods * static_cast<double>(kPeriod));
        begin(now, period, told_period);
        const double lost = lostPeriods();
        end(shows, busy_seconds);
        return lost;
    }
};

TEST_CASE_FIXTURE(Pace, "a frame that is displayed late has lost periods, one that is early gains some") {
    CHECK(after(1.0) == 0.0);
    for (const double periods : {1.0, 3.0, 1.25, 0.75, 1.0}) {
        CHECK(after(periods) == doctest::Approx(periods - 1.0));
    }
}

TEST_CASE_FIXTURE(Pace, "frames not to be seen, or too slow by the program, say nothing of the device") {
    after(1.0);
    CHECK(after(1.0, false) == 0.0);
    CHECK(after(4.0) == 0.0);
    CHECK(after(2.0, true, kSlow) == doctest::Approx(1.0));
    CHECK(after(2.0) == 0.0);
    CHECK(after(2.0) == doctest::Approx(1.0));
}

TEST_CASE_FIXTURE(Pace, "pauses, another period, another state and time that goes back say nothing") {
    CHECK(after(5.0) == 0.0);
    CHECK(after(500.0) == 0.0);
    constexpr XrDuration kOther = kPeriod * 5 / 4;
    CHECK(after(2.5, true, kQuick, kOther) == 0.0);
    CHECK(after(2.5, true, kQuick, kOther) == doctest::Approx(1.0));
    interrupt();
    CHECK(after(2.5, true, kQuick, kOther) == 0.0);
    CHECK(after(-3.0, true, kQuick, kOther) == 0.0);
    CHECK(after(0.0, true, kQuick, 0) == 0.0);
    CHECK(after(3.0, true, kQuick, 0) == 0.0);
}

TEST_CASE_FIXTURE(Pace, "a stated period of several displays is not the display's: the rest was lost") {
    after(1.0);
    CHECK(after(2.0, true, kQuick, 2 * kPeriod) == doctest::Approx(1.0));
    CHECK(period() == kPeriod);
    CHECK(after(3.0, true, kQuick, 3 * kPeriod + kPeriod / 100) == doctest::Approx(2.0));
    CHECK(period() == kPeriod);
    CHECK(after(1.0) == 0.0);
    CHECK(after(9.0, true, kQuick, 9 * kPeriod) == doctest::Approx(8.0));
    // As measured at three frames per second.
    CHECK(after(33.3, true, kQuick, kPeriod * 333 / 10) == 0.0);
    CHECK(period() == kPeriod);
    // A shorter period, or one that is not a multiple, is always the display's own.
    CHECK(after(1.0) == 0.0);
    CHECK(period() == kPeriod);
    CHECK(after(1.5, true, kQuick, kPeriod * 3 / 2) == 0.0);
    CHECK(period() == kPeriod * 3 / 2);
}

TEST_CASE_FIXTURE(Pace, "where the runtime says what the display's period is, it is that") {
    after(1.0);
    CHECK(after(2.0, true, kQuick, 2 * kPeriod, kPeriod) == doctest::Approx(1.0));
    // The display is slower now, and the reported period follows a frame later.
    CHECK(after(1.0, true, kQuick, kPeriod, 2 * kPeriod) == 0.0);
    CHECK(after(2.0, true, kQuick, 2 * kPeriod, 2 * kPeriod) == 0.0);
    CHECK(after(4.0, true, kQuick, 2 * kPeriod, 2 * kPeriod) == doctest::Approx(1.0));
    CHECK(period() == 2 * kPeriod);
}

}  // SUITE(display_pace)
