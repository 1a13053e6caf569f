// A line on a terminal for work that takes longer than a second; nothing if stderr is not a terminal. Work
// that reports its progress can also be interrupted at that point.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>

namespace binosplat {

// How wide a table on stdout may be: 100 characters on a terminal, any width in a file.
std::size_t terminalColumns();

class ProgressLine {
public:
    explicit ProgressLine(std::string what);
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine();  // clears the line

    // `share` done, 0 to 1. Throws Interrupted after a Ctrl-C, but only on the thread that made the line.
    // Cheap enough for inner loops: the line is drawn at most ten times a second.
    void show(double share);

    // The same as a function, valid for as long as the line exists.
    [[nodiscard]] std::function<void(double)> progress() {
        return [this](double share) { show(share); };
    }

private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    std::thread::id thread_ = std::this_thread::get_id();
    bool terminal_;
    bool shown_ = false;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace binosplat
