// Measures the periods between frames.
#include "xr/display_pace.h"

#include <cmath>
#include <utility>

namespace binosplat::xr {
namespace {

// A longer gap is not the device's fault: the runtime paused, or the machine slept.
constexpr double kMostLostPeriods = 10.0;
// Relative tolerance of isMultiple, since the error of a measured period grows with the period.
constexpr double kJitter = 0.02;

// True if `stated` is `display` or a multiple of it.
bool isMultiple(XrDuration stated, XrDuration display) {
    if (display <= 0) { return false; }
    const double times = static_cast<double>(stated) / static_cast<double>(display),
                 whole = std::round(times);
    return whole >= 1.0 && std::abs(times - whole) <= kJitter * whole;
}

}  // namespace

void DisplayPace::begin(XrTime display_time, XrDuration stated_period, XrDuration told_period) {
    const bool is_known = told_period <= 0 && isMultiple(stated_period, period_);
    const XrDuration period = is_known ? period_ : told_period > 0 ? told_period : stated_period;
    const bool is_same = period == period_ && period > 0;
    const bool is_alike = std::exchange(says_something_, false) && is_same;
    const double step =
        is_alike ? static_cast<double>(display_time - last_display_time_) / static_cast<double>(period) : 1.0;
    lost_periods_ = step > 0.0 && step <= 1.0 + kMostLostPeriods ? step - 1.0 : 0.0;
    last_display_time_ = display_time;
    period_ = period;
}

void DisplayPace::end(bool shows, double busy_seconds) {
    says_something_ = shows && 1e9 * busy_seconds < static_cast<double>(period_);
}

}  // namespace binosplat::xr
