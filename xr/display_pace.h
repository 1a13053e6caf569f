// The pace of frames, from the runtime's data: the distance between the times at which it displays them.
// Pure: no runtime, no clock.
#pragma once

#include "xr/platform.h"

namespace binosplat::xr {

class DisplayPace {
public:
    // Call with each result of xrWaitFrame and the period that the runtime states. That may be a multiple of
    // the display's if the program needs so long (as with Monado); to take it for the display's would be to
    // settle for half the rate. `told_period` is the display's period if the runtime reports it
    // (XR_FB_display_refresh_rate), otherwise 0.
    void begin(XrTime display_time, XrDuration stated_period, XrDuration told_period = 0);
    // Call for each xrEndFrame, with the program's own working time. A frame that shows nothing, or in which
    // the program alone needed more than the period, says nothing about the device.
    void end(bool shows, double busy_seconds);
    // The session's state changed: the next frames are unrelated to the previous ones.
    void interrupt() { says_something_ = false; }
    // The display's period in nanoseconds: the stated one, or the one stated before if that divides it.
    [[nodiscard]] XrDuration period() const { return period_; }

    // Periods between the last frame's display and this one's, less one; negative if it came early, zero
    // if unknown: for the first frame, and after a pause, a change of period or an interruption.
    [[nodiscard]] double lostPeriods() const { return lost_periods_; }

private:
    XrTime last_display_time_ = 0;
    XrDuration period_ = 0;
    bool says_something_ = false;
    double lost_periods_ = 0.0;
};

}  // namespace binosplat::xr
