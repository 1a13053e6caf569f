// Periods between frames.
#include "xr/display_pace.h"

#include <cmath>
#include <utility>

namespace binosplat::xr {
namespace {

// Longer than that nobody waits for a device: the runtime paused, or the machine slept.
constexpr double kMostLostPeriods = 10.0;
constexpr double kMostStretched = 8.0;
constexpr double kJitter = 0.01;  // of a period that is the same

// Whether `stated` is so many times `display`, or just that.
bool isMultiple(XrDuration stated, XrDuration display) {
    if (display <= 0) { return false; }
    const double times = static_cast<double>(stated) / static_cast<double>(display), whole = std::round(times);
    return whole >= 1.0 && whole <= kMostStretched && std::abs(times - whole) <= kJitter * whole;
}

}  // namespace

void DisplayPace::begin(XrTime display_time, XrDuration stated_period) {
    const bool is_same = isMultiple(stated_period, period_);
    const XrDuration period = is_same ? period_ : stated_period;
    const bool is_alike = std::exchange(says_something_, false) && is_same;
    const double step = is_alike ? static_cast<double>(display_time - last_display_time_) / static_cast<double>(period) : 1.0;
    lost_periods_ = step > 0.0 && step <= 1.0 + kMostLostPeriods ? step - 1.0 : 0.0;
    last_display_time_ = display_time;
    period_ = period;
}

void DisplayPace::end(bool shows, double busy_seconds) { says_something_ = shows && 1e9 * busy_seconds < static_cast<double>(period_); }

}  // namespace binosplat::xr
