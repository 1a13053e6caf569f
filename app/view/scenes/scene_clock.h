// The time of a scene that moves: it plays, pauses, and can be moved.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace binosplat {

class SceneClock {
public:
    SceneClock() = default;
    SceneClock(double rate_hz, std::size_t frames) : rate_hz_(rate_hz), frames_(frames) {}

    // Seconds since the first frame; goes on beyond the last one, after which the first follows.
    [[nodiscard]] double time_s() const { return time_s_; }
    [[nodiscard]] bool plays() const { return plays_; }
    [[nodiscard]] std::size_t frameCount() const { return frames_; }
    // 0 .. frameCount() - 1.
    [[nodiscard]] std::size_t frame() const {
        const auto count = static_cast<double>(frames_);
        const double place = std::floor(time_s_ * rate_hz_ + kHairFrames);
        return std::min(static_cast<std::size_t>(place - count * std::floor(place / count)), frames_ - 1);
    }

    void pass(double step_seconds) { time_s_ += plays_ ? step_seconds : 0.0; }
    // Follows another scene's clock from now on.
    void goWith(const SceneClock& other) { time_s_ = other.time_s_, plays_ = other.plays_; }
    void togglePlaying() { plays_ = !plays_; }
    // Steps `frames` forwards or, below 0, back, around the scene's end, and pauses there.
    void step(std::ptrdiff_t frames) {
        plays_ = false;
        const auto count = static_cast<std::ptrdiff_t>(frames_);
        goTo(static_cast<std::size_t>(((static_cast<std::ptrdiff_t>(frame()) + frames) % count + count) %
                                      count));
    }
    // Continues to play from there, or stays paused there.
    void goTo(std::size_t frame) { time_s_ = static_cast<double>(std::min(frame, frames_ - 1)) / rate_hz_; }

private:
    static constexpr double kHairFrames = 1e-4;  // as in MovingScene

    double rate_hz_ = 1.0, time_s_ = 0.0;
    std::size_t frames_ = 1;
    bool plays_ = true;
};

}  // namespace binosplat
