// Whether frames come when they should, as the runtime shows: how far the times at which it displays them lie apart. Pure: no runtime, no
// clock.
#pragma once

#include "xr/platform.h"

namespace binosplat::xr {

class DisplayPace {
public:
    // Each answer of xrWaitFrame, with the period that the runtime states: it may be several of the display's where the program needs as
    // long as that (Monado's is), and to take them for what there is would be to settle for half the rate. `told_period` is the display's
    // where the runtime says it (XR_FB_display_refresh_rate), otherwise 0.
    void begin(XrTime display_time, XrDuration stated_period, XrDuration told_period = 0);
    // Each xrEndFrame: whether the frame has something to show, and how long the program itself worked at it. One that had nothing, or
    // where the program alone needed more than the period, says nothing of the device.
    void end(bool shows, double busy_seconds);
    // The session's state changed: what comes next has nothing to do with what was.
    void interrupt() { says_something_ = false; }
    // Of the display, in nanoseconds; what the runtime states, or the part of it that was stated before.
    [[nodiscard]] XrDuration period() const { return period_; }

    // Periods that passed between the last frame's display and this one's, beyond the one that it has; below zero where it came early, zero
    // where nothing can be said: of the first frame, after a pause, another period or an interruption.
    [[nodiscard]] double lostPeriods() const { return lost_periods_; }

private:
    XrTime last_display_time_ = 0;
    XrDuration period_ = 0;
    bool says_something_ = false;
    double lost_periods_ = 0.0;
};

}  // namespace binosplat::xr
