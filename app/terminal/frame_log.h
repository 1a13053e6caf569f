// The viewer's output on stdout, with frame numbers.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <string>

namespace binosplat {

struct FrameLog {
    std::uint64_t frame = 0;  // frames shown so far

    void say(const std::string& message) const { print(fmt::format("frame {}: {}", frame, message)); }
    // A line without the frame. Lines are flushed at once: after a crash the last ones matter.
    static void print(const std::string& line) {
        fmt::print("{}\n", line);
        std::fflush(stdout);
    }
};

}  // namespace binosplat
