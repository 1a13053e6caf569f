// One line on a terminal for work that takes longer than a second; nothing where stderr is not a terminal.
#pragma once

#include <chrono>
#include <string>

namespace binosplat {

class ProgressLine {
public:
    explicit ProgressLine(std::string what);
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine();  // clears the line

    // `share` done, 0 to 1. Cheap enough for inner loops: the line is drawn at most ten times a second.
    void show(double share);

private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    bool terminal_;
    bool shown_ = false;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace binosplat
