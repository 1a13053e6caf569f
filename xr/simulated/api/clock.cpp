// When each frame is shown: a period after the one before in lock-step, or by the machine's steady clock.
#include "xr/simulated/api/clock.h"

#include <utility>

namespace simulated {

Clock::Clock(bool is_real, XrDuration period, double irregularity)
    : is_real_(is_real), period_(period), irregularity_(irregularity) {}

XrDuration Clock::delayOf(std::int64_t of_frame) const {
    if (is_real_ || irregularity_ == 0 || of_frame <= 0) { return 0; }
    // The same in every run, and without a pattern that a program could follow.
    auto mixed = static_cast<std::uint32_t>(of_frame) * 2654435761u;
    mixed = (mixed ^ mixed >> 15) * 2246822519u;
    const double drawn = static_cast<double>((mixed ^ mixed >> 13) & 0xffff) / 65535.0;
    return static_cast<XrDuration>(irregularity_ * (drawn - 0.5) * static_cast<double>(period_));
}

Clock::Frame Clock::nextFrame(std::int64_t skipped) {
    if (!birth_) { birth_ = std::chrono::steady_clock::now(); }
    frame_ += is_real_ ? 1 : 1 + skipped;
    // A late frame takes the next free slot, as on a display.
    if (is_real_ && (frame_ > 0 || is_early_)) {
        frame_ = std::max<std::int64_t>(frame_, (now() - origin_) / period_ + 1);
    }
    const std::chrono::nanoseconds wake(shown() - period_ - kStart);
    return {shown(), *birth_ + std::max(wake, std::chrono::nanoseconds(0))};
}

void Clock::pass() {
    if (!birth_) { birth_ = std::chrono::steady_clock::now(); }
    if (!is_real_) { ++frame_; }
}

XrTime Clock::now() const {
    if (!is_real_ || !birth_) { return shown(); }
    return kStart +
           std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - *birth_)
               .count();
}

void Clock::setPeriod(XrDuration period) {
    if (frame_ > 0) {
        origin_ = shown();
        frame_ = 0;
    }
    period_ = period;
}

std::int64_t Clock::monotonicOffset() {
    if (offset_) { return *offset_; }
    const auto monotonic = std::chrono::steady_clock::now();
    if (is_real_ && !birth_) {
        birth_ = monotonic;
        is_early_ = true;
    }
    const auto nanoseconds = [](auto time) {
        return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
    };
    offset_ = is_real_ ? nanoseconds(*birth_) - kStart : nanoseconds(monotonic) - now();
    return *offset_;
}

}  // namespace simulated
