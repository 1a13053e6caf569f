// The frames that a wearer got in the last second, by the times at which the runtime displays them, and how
// many of them were late. It does not use a clock. Whether a frame is late is judged by the period at its
// time, since runtimes may report longer periods when frames are late.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

namespace binosplat {

class MetDisplays {
public:
    // A frame: when it is displayed, in nanoseconds of any clock, and the display's period. `follows`: the
    // previous frame was shown, too.
    void add(std::int64_t display_time_ns, double period_ms, bool follows) {
        if (!(period_ms > 0.0)) { return; }
        const std::int64_t step_ns = frames_.empty() ? 0 : display_time_ns - frames_.back().time_ns;
        const bool is_known = follows && step_ns > 0 && step_ns <= kPauseNs;
        if (!is_known) { frames_.clear(); }
        // When the rate changes, the step may be either.
        const double longest_ms = kLatePeriods * std::max(period_ms, std::exchange(period_ms_, period_ms));
        frames_.push_back({display_time_ns, is_known && 1e-6 * static_cast<double>(step_ns) > longest_ms});
        // Those of the last second, and the one before them.
        while (frames_.size() > 2 && frames_[1].time_ns <= display_time_ns - kSecondNs) {
            frames_.pop_front();
        }
    }
    // 0: not known yet.
    [[nodiscard]] double displayHz() const { return period_ms_ > 0.0 ? 1000.0 / period_ms_ : 0.0; }
    [[nodiscard]] double metHz() const {
        if (frames_.size() < 2) { return 0.0; }
        return 1e9 * static_cast<double>(frames_.size() - 1) /
               static_cast<double>(frames_.back().time_ns - frames_.front().time_ns);
    }
    // Frames of the last second that were displayed more than a period after the one before.
    [[nodiscard]] int late() const {
        int late = 0;
        for (std::size_t i = 1; i < frames_.size(); ++i) { late += frames_[i].is_late; }
        return late;
    }

private:
    // longer: the machine slept
    static constexpr std::int64_t kSecondNs = 1'000'000'000, kPauseNs = 5 * kSecondNs;
    // Displays may be irregular.
    static constexpr double kLatePeriods = 1.5;

    struct Frame {
        std::int64_t time_ns;
        bool is_late;
    };

    double period_ms_ = 0.0;
    std::deque<Frame> frames_;
};

// What a frame cost, in milliseconds: on the GPU, on the CPU for the program's thread, and the time until the
// frame was handed over.
struct FrameCost {
    double gpu_ms = 0.0, busy_ms = 0.0, open_ms = 0.0;
};

// Why a frame of this cost was late.
inline std::string whyLate(const FrameCost& cost, double period_ms) {
    if (cost.gpu_ms > period_ms) { return fmt::format("the GPU took {:.1f} ms", cost.gpu_ms); }
    if (cost.busy_ms > period_ms) {
        return fmt::format("the program took {:.1f} ms of processor time", cost.busy_ms);
    }
    if (cost.open_ms > period_ms) {
        return fmt::format("the program was held up: it took {:.1f} ms, {:.1f} of processor time",
                           cost.open_ms, cost.busy_ms);
    }
    return fmt::format(
        "neither the GPU ({:.1f} ms) nor the program ({:.1f} ms) took that long; another program or the "
        "runtime did",
        cost.gpu_ms, cost.open_ms);
}

}  // namespace binosplat
