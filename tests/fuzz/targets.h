// The parsers that are fuzzed, by name. The same list is replayed over the kept inputs as an ordinary test.
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

// All of this build: one may be without SOG.
std::span<const Target> targets();

// Reads `input` as target `name` does. Ends the process if what is thrown is no Error or its message is not one line.
void runTarget(const std::string& name, std::span<const std::uint8_t> input);

}  // namespace binosplat::fuzz
