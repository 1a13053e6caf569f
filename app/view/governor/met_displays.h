// How many of the headset's recent displays had a new picture. Pure: no clock.
#pragma once

#include <algorithm>
#include <deque>

namespace binosplat {

class MetDisplays {
public:
    // A frame: the display's period, and how many displays passed before this one without a new picture.
    void add(double period_ms, double lost) {
        if (!(period_ms > 0.0)) { return; }
        if (period_ms != period_ms_) { lost_.clear(); }
        period_ms_ = period_ms;
        lost_.push_back(std::max(lost, 0.0));
        // Keeps one second.
        if (static_cast<double>(lost_.size()) * period_ms > 1000.0) { lost_.pop_front(); }
    }
    // 0: not known yet.
    [[nodiscard]] double displayHz() const { return period_ms_ > 0.0 ? 1000.0 / period_ms_ : 0.0; }
    [[nodiscard]] double metHz() const {
        double displays = 0.0;
        for (const double lost : lost_) { displays += 1.0 + lost; }
        return displays > 0.0 ? displayHz() * static_cast<double>(lost_.size()) / displays : 0.0;
    }

private:
    double period_ms_ = 0.0;
    std::deque<double> lost_;
};

}  // namespace binosplat
