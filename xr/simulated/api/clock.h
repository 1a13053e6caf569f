// Where OpenXR's time comes from. In lock-step, the default, a frame takes exactly one period however long it
// took to render, nothing sleeps, and every run is the same. With the real clock, frames are paced as by a
// display.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "xr/simulated/openxr.h"

namespace simulated {

class Clock {
public:
    // True for real pacing. The period must not be zero. In lock-step frames come up to half this share of a
    // period early or late.
    Clock(bool is_real, XrDuration period, double irregularity = 0);

    struct Frame {
        XrTime display_time;
        // With the real clock: when its xrWaitFrame returns.
        std::chrono::steady_clock::time_point wake_time;
    };
    // In lock-step, `skipped` periods pass before the frame.
    Frame nextFrame(std::int64_t skipped = 0);
    // Lets a period pass without a frame, while nobody asks for one.
    void pass();
    XrTime now() const;
    XrDuration period() const { return period_; }
    bool isReal() const { return is_real_; }
    // Seconds since the first frame: the time that scripts know. It does not count how long a program takes
    // to start.
    double secondsAt(XrTime time) const { return static_cast<double>(time - kStart) * 1e-9; }
    XrTime timeAt(double seconds) const { return kStart + static_cast<XrTime>(seconds * 1e9); }
    // Another display rate, from the next frame on.
    void setPeriod(XrDuration period);
    // CLOCK_MONOTONIC minus OpenXR's time, the same for the clock's life. In lock-step it is fixed when this
    // is first asked for; with the real clock both run at the same rate, and time begins with this call if
    // there was no frame yet.
    std::int64_t monotonicOffset();

private:
    // Not zero, which is not a valid time; the same in every run.
    static constexpr XrTime kStart = 1'000'000'000;

    // The display time of the frame on display.
    XrTime shown() const { return origin_ + std::max<std::int64_t>(frame_, 0) * period_ + delayOf(frame_); }
    XrDuration delayOf(std::int64_t of_frame) const;

    bool is_real_;
    XrDuration period_;
    double irregularity_;
    // The frame on display, counted in periods since this period began.
    XrTime origin_ = kStart;
    std::int64_t frame_ = -1;
    std::optional<std::chrono::steady_clock::time_point> birth_;
    // Time began before the first frame.
    bool is_early_ = false;
    std::optional<std::int64_t> offset_;
};

}  // namespace simulated
