// The system's fonts, by the letters that they have.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <vector>

namespace binosplat {

// A font of a file; of a collection the one with this number.
struct SystemFont {
    std::filesystem::path file;
    int number = 0;
};

// As few as have as many of these letters (Unicode) as any do, the user's favourite ones first. Reads what the system knows of its fonts,
// and no font.
std::vector<SystemFont> fontsWith(const std::set<std::uint32_t>& letters);

}  // namespace binosplat
