// How the panel looks: its size, its font, its colours.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

// Of the panel's picture. At the distance it hangs it is 26 degrees wide, so that a degree has 29 of these pixels: more than the 10 to 25
// of a headset, which therefore takes smaller copies of it (mips) where it can, as it does where the panel is carried away.
inline constexpr glm::uvec2 kPanelPx(768, 960);
inline constexpr double kPanelWidthMetres = 0.468;
// Of a line. Capitals of DejaVu Sans are 0.63 times as high: half a degree, which is read at arm's length in any headset.
inline constexpr float kFontPx = 24.0f;

// Where the font may lie, the best place first: BINOSPLAT_FONT alone if it is set, else where systems keep DejaVu Sans.
std::vector<std::filesystem::path> fontFiles();

// Whether the tables that a TrueType or OpenType font says it has, and those that are needed, lie within these bytes.
bool looksLikeFont(std::span<const unsigned char> bytes);

// For the current ImGui context, before its font is made a texture: Latin, Greek and Cyrillic in a vector font, boxes for what it lacks.
// Where there is none, ImGui's own small font, and a line that says so; otherwise empty.
std::string stylePanel();

}  // namespace binosplat
