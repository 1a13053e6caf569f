// A line on a terminal for work that takes longer than a second.
#include "app/terminal/progress.h"

#include "app/terminal/interrupt.h"
#include "engine/platform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace binosplat {

std::size_t terminalColumns() { return isTerminal(stdout) ? 100 : SIZE_MAX; }

ProgressLine::ProgressLine(std::string what) : what_(std::move(what)), terminal_(isTerminal(stderr)) {}

ProgressLine::~ProgressLine() {
    if (shown_) { fmt::print(stderr, "\r\033[K"); }
}

void ProgressLine::show(double share) {
    if (std::this_thread::get_id() == thread_) { stopIfInterrupted(); }
    const Clock::time_point now = Clock::now();
    if (!terminal_ || now - start_ < std::chrono::seconds(1) ||
        (shown_ && now - last_ < std::chrono::milliseconds(100))) {
        return;
    }
    const int percent = std::clamp(static_cast<int>(std::lround(100.0 * share)), 0, 100);
    fmt::print(stderr, "\r\033[K{} {} %", what_, percent);
    std::fflush(stderr);
    shown_ = true;
    last_ = now;
}

}  // namespace binosplat
