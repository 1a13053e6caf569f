// The system's fonts, by the letters that they have.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <vector>

namespace binosplat {

// A font in a file; in a collection, the one with this number.
struct SystemFont {
    std::filesystem::path file;
    int number = 0;
};

// A short list of fonts that together have all of these letters (Unicode) that any font has, the user's
// preferred ones first. Reads only the system's index of fonts, not the fonts.
std::vector<SystemFont> fontsWith(const std::set<std::uint32_t>& letters);

}  // namespace binosplat
