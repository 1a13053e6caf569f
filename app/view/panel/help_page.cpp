// The page that says what hands and controllers do.
#include "app/view/panel/panel_pages.h"
#include "app/view/panel/panel_style.h"

#include <imgui.h>

#include <array>
#include <utility>

namespace binosplat {

namespace {

constexpr float kWhatShare = 0.36f;

constexpr std::array<std::pair<const char*, const char*>, 11> kDeeds{{
    {"trigger, or pinch", "click, where the ray meets the panel"},
    {"grip, or fist", "hold the scene, and move it"},
    {"both grips", "turn it, and make it larger or smaller"},
    {"grip on the panel", "carry the panel"},
    {"Y, B, or menu", "the panel goes, or comes before the eyes"},
    {"pinch, palm to you", "the same, with bare hands"},
    {"left stick", "walk where you look, or teleport"},
    {"right stick", "turn; ahead and back: rise and sink"},
    {"sticks pressed in", "the viewpoint before, and the next one"},
    {"X, A", "a scene that moves rests, or plays"},
    {"trigger elsewhere", "with Teleport: to a place on the floor"},
}};

}  // namespace

void drawHelpPage(PanelWidgets& widgets, const PanelStatus& status, PanelRequests& requests) {
    const float left = ImGui::GetCursorPosX() + kWhatShare * ImGui::GetContentRegionAvail().x;
    for (const auto& [deed, what] : kDeeds) {
        ImGui::AlignTextToFramePadding();
        writeLine(deed);
        ImGui::SameLine(left);
        writeLine(what);
    }
    static constexpr std::array kWays{"Recentre", "Leave"};
    if (const auto pressed = widgets.row(kWays, {}, kLargeTargetPx)) { (*pressed == 0 ? requests.recentre : requests.quit) = true; }
    drawSaid(status);
}

}  // namespace binosplat
