// What the viewer says on stdout, by the number of the frame.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <string>

namespace binosplat {

struct FrameLog {
    std::uint64_t frame = 0;  // shown so far

    void say(const std::string& message) const { print(fmt::format("frame {}: {}", frame, message)); }
    // A line without it. Each is written at once: who looks into a crash wants the last ones.
    static void print(const std::string& line) {
        fmt::print("{}\n", line);
        std::fflush(stdout);
    }
};

}  // namespace binosplat
