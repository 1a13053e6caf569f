// How many splats of a streamed scene frames have time for, if the user sets no number.
#pragma once

#include <cstdint>

namespace binosplat {

class SplatBudget {
public:
    static constexpr std::uint64_t kLeast = 500'000;  // below that, other things than splats dominate

    // `most`: as many as fit in memory.
    explicit SplatBudget(std::uint64_t most) : most_(most), splats_(most) {}

    [[nodiscard]] std::uint64_t splats() const { return splats_; }
    // A frame's GPU time, with `shown` splats. The time of forty frames as a share of their periods decides:
    // above nine tenths the budget falls below the splats shown, below six tenths it may rise. True if the
    // budget has changed.
    bool measure(double gpu_ms, double period_ms, std::uint64_t shown);

private:
    std::uint64_t most_, splats_;
    double gpu_ms_ = 0.0, period_ms_ = 0.0;
    int frames_ = 0;
};

}  // namespace binosplat
