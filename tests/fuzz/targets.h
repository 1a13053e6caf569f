// The fuzzed parsers, by name. An ordinary test runs the same list on the inputs that were kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace binosplat::fuzz {

struct Target {
    const char* name;
    void (*read)(std::span<const std::uint8_t> input);
};

// All targets of this build, which may lack SOG.
std::span<const Target> targets();

// Reads `input` as target `name` does. Ends the process if anything but an Error is thrown, or if its message
// is not one line.
void runTarget(const std::string& name, std::span<const std::uint8_t> input);

}  // namespace binosplat::fuzz
