// How many splats of a streamed scene frames have time for, where nobody says a number.
#pragma once

#include <cstdint>

namespace binosplat {

class SplatBudget {
public:
    static constexpr std::uint64_t kLeast = 500'000;  // below that other things than splats take the time

    // `most`: what the memory holds.
    explicit SplatBudget(std::uint64_t most) : most_(most), splats_(most) {}

    [[nodiscard]] std::uint64_t splats() const { return splats_; }
    // A frame of the device, of `shown` splats. What forty of them took together, as a share of the displays' periods, decides: above nine
    // tenths there are to be fewer splats than are shown, below six tenths there may be more. True where it is another budget then.
    bool measure(double gpu_ms, double period_ms, std::uint64_t shown);

private:
    std::uint64_t most_, splats_;
    double gpu_ms_ = 0.0, period_ms_ = 0.0;
    int frames_ = 0;
};

}  // namespace binosplat
