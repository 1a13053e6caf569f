// How the panel looks: its size and its colours.
#pragma once

#include <glm/glm.hpp>

namespace binosplat {

// Of the panel's picture. At the distance it hangs it is 26 degrees wide, so that a degree has 29 of these pixels: more than the 10 to 25
// of a headset, which therefore takes smaller copies of it (mips) where it can, as it does where the panel is carried away.
inline constexpr glm::uvec2 kPanelPx(768, 960);
inline constexpr double kPanelWidthMetres = 0.468;

// How high what one points at is: 1.5 degrees at least, which a hand that trembles hits, and twice that for what is used most.
inline constexpr float kTargetPx = 45.0f, kTabPx = 60.0f, kLargeTargetPx = 88.0f;

// Colours and sizes of the current ImGui context.
void stylePanel();

// From now on a button looks like one that is chosen, until ImGui::PopStyleColor of as many colours as this returns.
int pushChosenColours();

}  // namespace binosplat
