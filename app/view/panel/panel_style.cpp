// ImGui's style.
#include "app/view/panel/panel_style.h"

#include <imgui.h>

namespace binosplat {

void stylePanel() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.ScaleAllSizes(1.6f);  // a ray points less finely than a mouse
    style.WindowRounding = 0.0f;
    style.Colors[ImGuiCol_WindowBg].w = 1.0f;
}

}  // namespace binosplat
