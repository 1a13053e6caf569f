// Sessions that were lost before one showed a frame.
#pragma once

#include <chrono>

namespace binosplat {

class Losses {
public:
    using Time = std::chrono::steady_clock::time_point;

    // One more at `now`; false: too many in a row. A loss long after the previous one is counted as the first
    // again.
    [[nodiscard]] bool add(Time now) {
        if (count_ > 0 && now - last_ > kLong) { count_ = 0; }
        last_ = now;
        return ++count_ <= kMost;
    }
    void forget() { count_ = 0; }
    [[nodiscard]] int count() const { return count_; }

    static constexpr int kMost = 3;
    static constexpr std::chrono::seconds kLong{10};

private:
    int count_ = 0;
    Time last_{};
};

}  // namespace binosplat
