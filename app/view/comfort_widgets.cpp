// Checkboxes beside one another.
#include "app/view/comfort_widgets.h"

#include <imgui.h>

namespace binosplat {

void drawComfort(PanelWidgets& widgets, ViewSettings& settings, bool can_pass_through) {
    const float width = ImGui::GetContentRegionAvail().x;
    widgets.checkbox("Teleport", &settings.teleport);
    ImGui::SameLine(0.25f * width);
    widgets.checkbox("Vignette", &settings.vignette);
    ImGui::SameLine(0.5f * width);
    widgets.checkbox("Hands", &settings.hands);
    if (!can_pass_through) { return; }
    ImGui::SameLine(0.7f * width);
    widgets.checkbox("Passthrough", &settings.passthrough);
}

}  // namespace binosplat
