// What the viewer says on stdout, by the number of the frame.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace binosplat {

struct FrameLog {
    std::uint64_t frame = 0;  // shown so far

    void say(const std::string& message) const { fmt::print("frame {}: {}\n", frame, message); }
};

}  // namespace binosplat
