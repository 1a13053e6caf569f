// Checkboxes beside one another.
#include "app/view/panel/comfort_widgets.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

// In one row; headsets have up to five, and more are for the command line.
constexpr std::size_t kMostRates = 5;

}  // namespace

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

void drawRates(PanelWidgets& widgets, ViewSettings& settings, const std::vector<double>& rates_hz) {
    if (rates_hz.empty()) { return; }
    const std::size_t shown = std::min(rates_hz.size(), kMostRates);
    const float width = ImGui::GetContentRegionAvail().x;
    // As people write them: 72 for 71.999.
    if (widgets.radio("any rate", settings.refresh_rate == 0.0)) { settings.refresh_rate = 0.0; }
    for (std::size_t i = 0; i < shown; ++i) {
        ImGui::SameLine((0.25f + 0.75f * static_cast<float>(i) / static_cast<float>(shown)) * width);
        ImGui::PushID(static_cast<int>(i));  // 59.94 and 60 read alike
        if (widgets.radio(fmt::format("{:.0f} Hz", rates_hz[i]).c_str(), std::abs(settings.refresh_rate - rates_hz[i]) < 0.5)) {
            settings.refresh_rate = rates_hz[i];
        }
        ImGui::PopID();
    }
}

}  // namespace binosplat
