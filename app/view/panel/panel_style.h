// How the panel looks: its size and its colours.
#pragma once

#include <glm/glm.hpp>

namespace binosplat {

// Size of the panel's picture. Where it hangs it is 26 degrees wide, with 29 pixels per degree: more than the
// 10 to 25 of a headset, which therefore samples smaller mips of it if it can, as it does when the panel is
// carried away.
inline constexpr glm::uvec2 kPanelPx(768, 960);
inline constexpr double kPanelWidthMetres = 0.468;

// Heights of targets: at least 1.5 degrees, which a trembling hand hits, and twice that for the most used
// ones.
inline constexpr float kTargetPx = 45.0f, kTabPx = 60.0f, kLargeTargetPx = 88.0f;

// Colours and sizes of the current ImGui context.
void stylePanel();

// Makes buttons look chosen, until ImGui::PopStyleColor with the number that this returns.
int pushChosenColours();

}  // namespace binosplat
