// When each frame is shown: a period after the one before in lock-step, or by the machine's steady clock.
#include "xr/simulated/api/clock.h"

#include <utility>

namespace simulated {

Clock::Clock(bool real, XrDuration period, double share) : is_real(real), frame_period(period), irregularity(share) {}

XrDuration Clock::delayOf(std::int64_t of_frame) const {
    if (is_real || irregularity == 0 || of_frame <= 0) return 0;
    // The same in every run, and without a pattern that a program could follow.
    auto mixed = static_cast<std::uint32_t>(of_frame) * 2654435761u;
    mixed = (mixed ^ mixed >> 15) * 2246822519u;
    const double drawn = static_cast<double>((mixed ^ mixed >> 13) & 0xffff) / 65535.0;
    return static_cast<XrDuration>(irregularity * (drawn - 0.5) * static_cast<double>(frame_period));
}

Clock::Frame Clock::nextFrame(std::int64_t skipped) {
    if (!birth) birth = std::chrono::steady_clock::now();
    frame += is_real ? 1 : 1 + skipped;
    // A frame that comes late takes the next place that is left, as on a display.
    if (is_real && (frame > 0 || is_early)) frame = std::max<std::int64_t>(frame, (now() - origin) / frame_period + 1);
    const std::chrono::nanoseconds wake(shown() - frame_period - kStart);
    return {shown(), *birth + std::max(wake, std::chrono::nanoseconds(0))};
}

void Clock::pass() {
    if (!birth) birth = std::chrono::steady_clock::now();
    if (!is_real) ++frame;
}

XrTime Clock::now() const {
    if (!is_real || !birth) return shown();
    return kStart + std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - *birth).count();
}

void Clock::setPeriod(XrDuration period) {
    if (frame > 0) {
        origin = shown();
        frame = 0;
    }
    frame_period = period;
}

std::int64_t Clock::monotonicOffset() {
    if (offset) return *offset;
    const auto monotonic = std::chrono::steady_clock::now();
    if (is_real && !birth) {
        birth = monotonic;
        is_early = true;
    }
    const auto nanoseconds = [](auto time) {
        return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
    };
    offset = is_real ? nanoseconds(*birth) - kStart : nanoseconds(monotonic) - now();
    return *offset;
}

}  // namespace simulated
