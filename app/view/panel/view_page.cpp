// The page that the panel opens with.
#include "app/view/panel/panel_pages.h"
#include "app/view/panel/panel_style.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace binosplat {

namespace {

constexpr float kTextShare = 0.46f;  // of a line, for words before buttons
// In one row; headsets offer up to five, and more are for the command line.
constexpr std::size_t kMostRates = 5;
constexpr double kGrowthStep = 1.25, kRiseStepMetres = 0.1;

// Words to the left of a row of buttons of this height.
void writeBefore(const std::string& words, float height_px) {
    const float y = ImGui::GetCursorPosY(), x = ImGui::GetCursorPosX();
    ImGui::SetCursorPosY(y + 0.5f * (height_px - ImGui::GetTextLineHeight()));
    writeLine(words);
    ImGui::SameLine(x + kTextShare * ImGui::GetContentRegionAvail().x);
    ImGui::SetCursorPosY(y);
}

// Rate and resolution, in plain words.
std::string describeRate(const ShownRate& rate, Quality quality) {
    const std::string resolution = fmt::format("resolution {:.0f} %", 100.0 * rate.resolution);
    if (!(rate.met_hz > 0.0)) { return resolution; }
    const std::string late = rate.late > 0 ? fmt::format(" ({} late)", rate.late) : "";
    std::string words = fmt::format("{:.0f} of {:.0f} Hz{}, {}", std::min(rate.met_hz, rate.display_hz),
                                    rate.display_hz, late, resolution);
    if (rate.is_beaten) { return words + ", still too slow"; }
    if (quality == Quality::kOff) { return words + "; not kept, try Balanced"; }
    if (rate.bound_db) { return fmt::format("{}, errors within {:.0f} dB", words, *rate.bound_db); }
    return rate.budget ? fmt::format("{}, {:.0f} % of it rendered again", words, 100.0 * *rate.budget)
                       : words;
}

void drawQualityRow(PanelWidgets& widgets, ViewSettings& settings, const ShownRate& rate) {
    static constexpr std::array kNames{"Sharp", "Balanced", "Fast"};
    static constexpr std::array kQualities{Quality::kSharp, Quality::kBalanced, Quality::kFast};
    const auto found = std::ranges::find(kQualities, settings.quality);
    const auto chosen =
        found == kQualities.end() ? std::nullopt : std::optional<std::size_t>(found - kQualities.begin());
    if (const auto pressed = widgets.row(kNames, chosen, kLargeTargetPx)) {
        settings.quality = pressed == chosen ? Quality::kOff : kQualities[*pressed];
    }
    writeLine(describeRate(rate, settings.quality));
}

std::string describeSize(const ShownPlace& place) {
    const double g = place.growth;
    const std::string scale = std::abs(g - 1.0) < 0.005 ? "1:1"
                              : g > 1.0                 ? fmt::format("{:.3g}:1", g)
                                                        : fmt::format("1:{:.3g}", 1.0 / g);
    if (!(place.size_m > 0.0)) { return fmt::format("Size {}", scale); }
    return place.size_m < 0.995 ? fmt::format("Size {:.0f} cm, {}", 100.0 * place.size_m, scale)
                                : fmt::format("Size {:.3g} m, {}", place.size_m, scale);
}

std::string describeHeight(const ShownPlace& place) {
    if (place.has_floor) { return fmt::format("Eyes {:.2f} m above the floor", place.eyes_m); }
    return std::abs(place.eyes_m) < 0.005 ? "Height as at the start"
                                          : fmt::format("Height {:+.2f} m", place.eyes_m);
}

void drawPlace(PanelWidgets& widgets, const ShownPlace& place, PanelRequests& requests) {
    static constexpr std::array kPlaces{"Recentre", "Level", "Reset", "True size"};
    static constexpr std::array kSizes{"Smaller", "1:1", "Larger"};
    static constexpr std::array kHeights{"Lower", "Higher"};
    if (const auto pressed = widgets.row(kPlaces, {}, kLargeTargetPx)) {
        (*pressed == 0   ? requests.recentre
         : *pressed == 1 ? requests.level_scene
         : *pressed == 2 ? requests.reset_scene
                         : requests.measure) = true;
    }
    writeBefore(describeSize(place), kTabPx);
    ImGui::PushButtonRepeat(true);
    const auto size = widgets.row(kSizes, {}, kTabPx);
    writeBefore(describeHeight(place), kTargetPx);
    const auto height = widgets.row(kHeights, {}, kTargetPx);
    ImGui::PopButtonRepeat();
    if (size) {
        requests.natural_size = *size == 1;
        requests.growth = *size == 0 ? 1.0 / kGrowthStep : *size == 2 ? kGrowthStep : 1.0;
    }
    if (height) { requests.rise_m = *height == 0 ? -kRiseStepMetres : kRiseStepMetres; }
}

// Some words, and a choice of one of a few names.
template <typename Chosen, std::size_t kCount>
void choose(PanelWidgets& widgets, const char* words, const std::array<const char*, kCount>& names,
            Chosen& chosen) {
    writeBefore(words, kTargetPx);
    if (const auto pressed = widgets.row(names, static_cast<std::size_t>(chosen), kTargetPx)) {
        chosen = static_cast<Chosen>(*pressed);
    }
}

void drawMoving(PanelWidgets& widgets, ViewSettings& settings, const std::vector<ToolChoice>& tools,
                bool can_pass_through) {
    for (const ToolChoice& tool : tools) {
        if (tool.names[0] != nullptr) { choose(widgets, tool.words, tool.names, settings.*tool.chosen); }
    }
    choose(widgets, "Background", std::array{"Default", "Black", "Grey", "White"}, settings.backdrop);
    const float width = ImGui::GetContentRegionAvail().x;
    widgets.checkbox("Vignette", &settings.vignette);
    ImGui::SameLine(0.24f * width);
    widgets.checkbox("Hands", &settings.hands);
    float place = 0.43f;
    const auto tick = [&](const char* words, bool& chosen) {
        if (place < 0.7f) { ImGui::SameLine(place * width); }
        widgets.checkbox(words, &chosen);
        place = place < 0.7f ? place + 0.31f : 0.31f;
    };
    for (const ToolChoice& tool : tools) {
        if (tool.names[0] == nullptr) { tick(tool.words, settings.*tool.chosen); }
    }
    if (can_pass_through) { tick("Passthrough", settings.passthrough); }
}

// The headset's refresh rates; nothing if it offers none.
void drawRates(PanelWidgets& widgets, ViewSettings& settings, const std::vector<double>& rates_hz) {
    if (rates_hz.empty()) { return; }
    const std::size_t shown = std::min(rates_hz.size(), kMostRates);
    std::vector<std::string> words{"Automatic"};
    std::vector<const char*> names;
    std::optional<std::size_t> chosen;
    if (settings.refresh_rate == 0.0) { chosen = 0; }
    for (std::size_t i = 0; i < shown; ++i) {
        // As people write them: 72 for 71.999. Rates that look alike, such as 59.94 and 60, get different
        // names for ImGui.
        const std::string hz = fmt::format("{:.0f} Hz", rates_hz[i]);
        words.push_back(std::ranges::find(words, hz) == words.end() ? hz : fmt::format("{}##{}", hz, i));
        if (std::abs(settings.refresh_rate - rates_hz[i]) < 0.5) { chosen = i + 1; }
    }
    for (const std::string& word : words) { names.push_back(word.c_str()); }
    if (const auto pressed = widgets.row(names, chosen, kTargetPx)) {
        settings.refresh_rate = *pressed == 0 ? 0.0 : rates_hz[*pressed - 1];
    }
}

}  // namespace

void drawViewPage(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status,
                  PanelRequests& requests) {
    drawQualityRow(widgets, settings, status.rate);
    drawPlace(widgets, status.place, requests);
    drawMoving(widgets, settings, status.tools, status.can_pass_through);
    static constexpr std::array kKept{"Picture", "Save", "Load"};
    if (const auto pressed = widgets.row(kKept, {}, kTargetPx, kKeptShare)) {
        (*pressed == 0 ? requests.take_picture : *pressed == 1 ? requests.save : requests.load) = true;
    }
    ImGui::SameLine();
    widgets.checkbox("Both eyes", &settings.picture_both_eyes);
    drawRates(widgets, settings, status.refresh_rates);
    drawSaid(status);
}

}  // namespace binosplat
