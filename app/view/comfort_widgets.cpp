// Checkboxes beside one another.
#include "app/view/comfort_widgets.h"

#include <imgui.h>

namespace binosplat {

void drawComfort(ViewSettings& settings, bool can_pass_through) {
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::Checkbox("Teleport", &settings.teleport);
    ImGui::SameLine(0.25f * width);
    ImGui::Checkbox("Vignette", &settings.vignette);
    ImGui::SameLine(0.5f * width);
    ImGui::Checkbox("Hands", &settings.hands);
    if (!can_pass_through) { return; }
    ImGui::SameLine(0.7f * width);
    ImGui::Checkbox("Passthrough", &settings.passthrough);
}

}  // namespace binosplat
