// The page that says what hands and controllers do: a drawing of what the hands hold, with words, and more
// words below it.
#include "app/view/panel/panel_pages.h"
#include "app/view/panel/panel_style.h"
#include "engine/geometry.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <utility>

namespace binosplat {

namespace {

constexpr float kWhatShare = 0.36f, kDrawnHighPx = 370.0f, kLabelStepPx = 52.0f;

constexpr std::array<std::pair<const char*, const char*>, 5> kDeeds{{
    {"both grips", "turn the scene, enlarge or shrink it"},
    {"grip on the panel", "carry the panel"},
    {"trigger elsewhere", "with Teleport: to a place on the floor"},
    {"bare hands, pinch", "to a place on the floor; pulled aside: turn"},
    {"pinch, palm to you", "hide the panel, or bring it before the eyes"},
}};

// A part of a controller: its place in the drawing of a left one, in radii of its round head from that one's
// middle; its input, and what that does.
struct Part {
    glm::vec2 place;
    const char* input;
    const char* deed;
};

std::array<Part, 6> partsOf(const xr::ProfileBindings& held, int hand, bool compares) {
    const auto h = static_cast<std::size_t>(hand);
    const bool left = hand == kLeft;
    return {{{{-0.75f, -0.75f}, held.trigger, "click"},
             {{0.35f, -0.45f}, held.menu[h], "the panel"},
             {{0.45f, 0.15f}, held.play[h], compares ? "held: the other scene" : "pause, or play"},
             {{-0.3f, -0.1f}, held.stick, left ? "walk, or teleport" : "turn, rise, sink"},
             {{-0.3f, -0.1f}, held.stick_press, left ? "previous viewpoint" : "next viewpoint"},
             {{-0.55f, 1.5f}, held.squeeze, "hold the scene"}}};
}

// Its outline about a point, its parts, and lines to their words on its outer side.
void drawHeld(const xr::ProfileBindings& held, int hand, bool compares, const ImVec2& corner, float width) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 outline = ImGui::GetColorU32(ImGuiCol_TextDisabled),
                words = ImGui::GetColorU32(ImGuiCol_Text);
    const ImU32 accent = IM_COL32(255, 220, 80, 255);
    const float side = hand == kLeft ? -1.0f : 1.0f, radius = 0.075f * width;
    const ImVec2 middle(corner.x + (0.5f + 0.09f * side) * width, corner.y + 0.36f * kDrawnHighPx);
    // A left one's places, mirrored for a right one.
    const auto there = [&](float x, float y) {
        return ImVec2(middle.x - side * x * radius, middle.y + y * radius);
    };
    list.AddCircle(middle, radius, outline, 48, 2.5f);
    const std::array handle{there(-0.4f, 0.92f), there(-0.3f, 2.4f), there(0.3f, 2.4f), there(0.4f, 0.92f)};
    list.AddPolyline(handle.data(), static_cast<int>(handle.size()), outline, 0, 2.5f);
    float y = corner.y;
    for (const auto& [place, input, deed] : partsOf(held, hand, compares)) {
        if (input == nullptr) { continue; }
        const bool is_press = input == held.stick_press;
        const std::string first = is_press ? "pressed in" : xr::inputName(input);
        const ImVec2 first_px = ImGui::CalcTextSize(first.c_str()), deed_px = ImGui::CalcTextSize(deed);
        const auto from = [&](float text_px) {
            return hand == kLeft ? corner.x : corner.x + width - text_px;
        };
        list.AddText(ImVec2(from(first_px.x), y), accent, first.c_str());
        list.AddText(ImVec2(from(deed_px.x), y + first_px.y), words, deed);
        const ImVec2 at = there(place.x, place.y);
        const float longest = std::max(first_px.x, deed_px.x) + 6.0f;
        list.AddLine(ImVec2(hand == kLeft ? corner.x + longest : corner.x + width - longest, y + first_px.y),
                     at, outline, 1.5f);
        list.AddCircleFilled(at, (place.x == -0.3f ? 0.24f : 0.15f) * radius, accent);
        y += kLabelStepPx + 8.0f;
    }
}

}  // namespace

void drawHelpPage(PanelWidgets& widgets, const PanelStatus& status, PanelRequests& requests) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    for (const int hand : {kLeft, kRight}) {
        const xr::ProfileBindings* const held = status.held[static_cast<std::size_t>(hand)];
        drawHeld(held != nullptr ? *held : xr::usualBindings(), hand, status.compares, corner, width);
    }
    ImGui::Dummy(ImVec2(width, kDrawnHighPx));
    const float left = ImGui::GetCursorPosX() + kWhatShare * width;
    for (const auto& [deed, what] : kDeeds) {
        ImGui::AlignTextToFramePadding();
        writeLine(deed);
        ImGui::SameLine(left);
        writeLine(what);
    }
    static constexpr std::array kWays{"Recentre", "Leave"};
    if (const auto pressed = widgets.row(kWays, {}, kLargeTargetPx)) {
        (*pressed == 0 ? requests.recentre : requests.quit) = true;
    }
    drawSaid(status);
}

}  // namespace binosplat
