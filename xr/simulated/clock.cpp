#include "xr/simulated/clock.h"

#include <algorithm>

namespace simulated {

Clock::Clock(bool real, XrDuration period) : is_real(real), frame_period(period) {}

Clock::Frame Clock::nextFrame() {
    if (!birth) birth = std::chrono::steady_clock::now();
    ++frame;
    // A frame that comes late takes the next place that is left, as on a display.
    if (is_real && frame > 0) frame = std::max<std::int64_t>(frame, (now() - kStart) / frame_period + 1);
    const std::chrono::nanoseconds wake((frame - 1) * frame_period);
    return {kStart + frame * frame_period, *birth + std::max(wake, std::chrono::nanoseconds(0))};
}

void Clock::pass() {
    if (!birth) birth = std::chrono::steady_clock::now();
    if (!is_real) ++frame;
}

XrTime Clock::now() const {
    if (!is_real || !birth) return kStart + std::max<std::int64_t>(frame, 0) * frame_period;
    return kStart + std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - *birth).count();
}

}  // namespace simulated
