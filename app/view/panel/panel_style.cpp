// ImGui's style.
#include "app/view/panel/panel_style.h"

#include "app/view/panel/panel_font.h"

#include <imgui.h>

namespace binosplat {

namespace {

// Grey at rest, brighter when pointed at, yellow while pressed, blue if chosen: told apart at a glance.
const ImVec4 kRests{0.20f, 0.23f, 0.28f, 1.0f}, kHovered{0.38f, 0.45f, 0.56f, 1.0f},
    kPressed{0.80f, 0.55f, 0.10f, 1.0f}, kChosen{0.13f, 0.42f, 0.75f, 1.0f},
    kChosenHovered{0.25f, 0.56f, 0.92f, 1.0f};

}  // namespace

void stylePanel() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.ScaleAllSizes(1.6f);  // a ray points less precisely than a mouse
    style.FramePadding.y = 0.5f * (kTargetPx - kFontPx);
    style.ItemSpacing.y = 8.0f;
    style.WindowRounding = style.WindowBorderSize = 0.0f;
    style.FrameRounding = 6.0f;
    ImVec4* const colours = style.Colors;
    colours[ImGuiCol_WindowBg].w = 1.0f;
    colours[ImGuiCol_Button] = colours[ImGuiCol_FrameBg] = kRests;
    colours[ImGuiCol_ButtonHovered] = colours[ImGuiCol_FrameBgHovered] = kHovered;
    colours[ImGuiCol_ButtonActive] = colours[ImGuiCol_FrameBgActive] = kPressed;
}

int pushChosenColours() {
    ImGui::PushStyleColor(ImGuiCol_Button, kChosen);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, kChosenHovered);
    return 2;
}

}  // namespace binosplat
