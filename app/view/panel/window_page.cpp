// The first page of the panel in a window.
#include "app/view/panel/panel_pages.h"
#include "app/view/panel/panel_style.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

namespace binosplat {

namespace {

constexpr float kWindowSliderShare = 0.6f, kKeysShare = 0.36f;

constexpr std::array<std::pair<const char*, const char*>, 13> kKeys{{
    {"left button", "orbit around what is under the pointer"},
    {"right, middle button", "move the scene"},
    {"wheel", "towards what is under the pointer"},
    {"double click", "orbit around that point"},
    {"W A S D, Q E", "fly, down and up; Shift: faster"},
    {"arrows", "look around"},
    {"F, R", "the whole scene; the start view"},
    {"1 to 9", "viewpoints"},
    {"Space, comma, full stop", "a moving scene: play, step"},
    {"Tab, F11", "this panel; full screen"},
    {"O, P", "open a file; write a picture"},
    {"C", "compare with a file; held: the other scene"},
    {"H, Escape", "this help; quit"},
}};

void drawKeys() {
    const float left = ImGui::GetCursorPosX() + kKeysShare * ImGui::GetContentRegionAvail().x;
    for (const auto& [keys, what] : kKeys) {
        writeLine(keys);
        ImGui::SameLine(left);
        writeLine(what);
    }
}

void drawStereo(PanelWidgets& widgets, ViewSettings& settings) {
    static constexpr std::array kStereo{"One eye", "Side by side", "Cross-eyed", "Top, bottom", "Red-cyan"};
    if (const auto pressed = widgets.row(kStereo, static_cast<std::size_t>(settings.window_stereo), kTabPx)) {
        settings.window_stereo = static_cast<WindowStereo>(*pressed);
    }
    ImGui::BeginDisabled(settings.window_stereo == WindowStereo::kMono);
    ImGui::PushItemWidth(kWindowSliderShare * ImGui::GetContentRegionAvail().x);
    auto eyes = static_cast<float>(100.0 * settings.window_eyes),
         plane = static_cast<float>(settings.window_plane);
    if (ImGui::SliderFloat("eye distance", &eyes, 0.0f, 20.0f, "%.1f %%")) {
        settings.window_eyes = std::clamp(0.01 * static_cast<double>(eyes), 0.0, 0.2);
    }
    widgets.noteSlider("eye distance");
    if (ImGui::SliderFloat("screen plane", &plane, 0.1f, 10.0f, "%.2f", ImGuiSliderFlags_Logarithmic)) {
        settings.window_plane = std::clamp(static_cast<double>(plane), 0.1, 10.0);
    }
    widgets.noteSlider("screen plane");
    ImGui::PopItemWidth();
    ImGui::EndDisabled();
}

}  // namespace

void drawWindowPage(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status,
                    PanelRequests& requests) {
    static constexpr std::array kPlaces{"Open", "Compare", "Whole scene", "Start view", "True size"};
    const bool compares = status.compares || status.compares_next;
    if (const auto pressed =
            widgets.row(kPlaces, compares ? std::optional<std::size_t>(1) : std::nullopt, kLargeTargetPx)) {
        (*pressed == 0   ? requests.open_file
         : *pressed == 1 ? requests.compare
         : *pressed == 2 ? requests.show_whole
         : *pressed == 3 ? requests.reset_scene
                         : requests.measure) = true;
    }
    drawStereo(widgets, settings);
    static constexpr std::array kBackdrops{"Default", "Black", "Grey", "White"};
    ImGui::AlignTextToFramePadding();
    writeLine("Background");
    ImGui::SameLine();
    if (const auto pressed =
            widgets.row(kBackdrops, static_cast<std::size_t>(settings.backdrop), kTargetPx)) {
        settings.backdrop = static_cast<Backdrop>(*pressed);
    }
    static constexpr std::array kKept{"Picture", "Save", "Load"};
    if (const auto pressed = widgets.row(kKept, {}, kTargetPx, kKeptShare)) {
        (*pressed == 0 ? requests.take_picture : *pressed == 1 ? requests.save : requests.load) = true;
    }
    ImGui::SameLine();
    widgets.checkbox("Both eyes", &settings.picture_both_eyes);
    const std::array window{status.window->fills_screen ? "Window" : "Full screen", "Help"};
    if (const auto pressed = widgets.row(
            window, status.window->helps ? std::optional<std::size_t>(1) : std::nullopt, kTargetPx)) {
        (*pressed == 0 ? requests.fill_screen : requests.help) = true;
    }
    status.window->helps ? drawKeys() : drawSaid(status);
}

}  // namespace binosplat
