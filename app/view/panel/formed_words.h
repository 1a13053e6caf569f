// Words in scripts whose letters change with their neighbours, as a font forms them.
#pragma once

#include "app/view/panel/system_fonts.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

struct LoadedFont {
    SystemFont font;
    std::string bytes;
};

// A font's picture of one or several letters, and its place in the word.
struct FormedGlyph {
    glm::uvec2 size_px;                   // of its picture, whose pixels are half as wide as the panel's
    std::vector<unsigned char> coverage;  // row by row
    // The picture's upper left corner, relative to the glyph's start on the base line; y down.
    glm::vec2 low_px;
    float advance_px;
};

struct FormedWords {
    std::map<std::u32string, std::vector<std::size_t>> words;  // their glyphs from left to right
    std::vector<FormedGlyph> signs;
};

// Forms each word with the first font that has all of it; words that no font has are left out. At most
// `most_glyphs` different glyphs. The first font's lines are `line_px` high.
FormedWords formWords(const std::set<std::u32string>& words, std::span<const LoadedFont> fonts, float line_px,
                      std::size_t most_glyphs);

}  // namespace binosplat
