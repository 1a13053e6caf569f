// The panel, top to bottom.
#include "app/view/overlay.h"

#include "app/options/modes.h"
#include "app/report/report.h"
#include "app/view/comfort_widgets.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

namespace binosplat {

namespace {

constexpr float kLabelShare = 0.62f;  // of the width, for sliders beside their label

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str()); }

// A row of names of which one is chosen.
template <std::size_t N>
void chooseFrom(const char* label, const std::array<const char*, N>& names, std::string& chosen, std::size_t per_row) {
    text(label);
    for (std::size_t i = 0; i < N; ++i) {
        if (i % per_row != 0) {
            ImGui::SameLine(ImGui::GetContentRegionAvail().x * static_cast<float>(i % per_row) / static_cast<float>(per_row));
        }
        if (ImGui::RadioButton(names[i], chosen == names[i])) { chosen = names[i]; }
    }
}

// By the table of names; one eye last.
void chooseMode(Mode& mode) {
    std::string chosen(nameOf(mode));
    std::array<const char*, kModeNames.size()> names{};
    std::ranges::transform(kModeNames, names.begin(), [](std::string_view name) { return name.data(); });
    std::ranges::rotate(names, names.begin() + 1);
    chooseFrom("Method", names, chosen, 3);
    mode = static_cast<Mode>(std::ranges::find(kModeNames, chosen) - kModeNames.begin());
}

void drawMethod(ViewSettings& settings) {
    StereoOptions& stereo = settings.stereo;
    chooseMode(stereo.mode);
    std::string side = stereo.dominant == kLeft ? "left" : "right";
    chooseFrom("Dominant eye", std::array{"left", "right"}, side, 3);
    stereo.dominant = side == "left" ? kLeft : kRight;
    ImGui::SameLine(ImGui::GetContentRegionAvail().x * 2.0f / 3.0f);  // the row's last third is free
    bool by_distance = stereo.order == "distance";
    if (ImGui::Checkbox("Sort by distance", &by_distance)) { stereo.order = by_distance ? "distance" : "depth"; }
    chooseFrom("Depth of a pixel", std::array{"sum", "mean", "inverse"}, stereo.depth, 3);
    ImGui::Checkbox("Centre ROI (paper)", &stereo.center_roi);
    ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.55f);
    ImGui::Checkbox("Show what made it", &settings.tint);
    int margin = static_cast<int>(stereo.margin_px);
    if (ImGui::SliderInt("margin (paper)", &margin, 0, 128, "%d px")) {
        stereo.margin_px = static_cast<std::uint32_t>(std::clamp(margin, 0, 128));
    }
    auto budget = static_cast<float>(100.0 * stereo.budget);
    if (ImGui::SliderFloat("budget (predicted)", &budget, 0.0f, 100.0f, "%.0f %% of an eye")) {
        stereo.budget = std::clamp(static_cast<double>(budget) / 100.0, 0.0, 1.0);
    }
}

// The images are made anew for another resolution, so it changes once the slider is let go.
void drawResolution(ViewSettings& settings) {
    static constexpr float kLeast = 0.25f, kMost = 1.5f;
    ImGuiStorage* storage = ImGui::GetStateStorage();
    const ImGuiID id = ImGui::GetID("resolution being chosen");
    auto scale = storage->GetFloat(id, static_cast<float>(settings.resolution_scale));
    ImGui::SliderFloat("resolution", &scale, kLeast, kMost, "%.2f");
    if (ImGui::IsItemActive()) {
        storage->SetFloat(id, scale);
        return;
    }
    // As many digits as are shown.
    if (ImGui::IsItemDeactivatedAfterEdit()) { settings.resolution_scale = std::round(100.0 * std::clamp(scale, kLeast, kMost)) / 100.0; }
    storage->SetFloat(id, static_cast<float>(settings.resolution_scale));
}

void drawQuality(ViewSettings& settings) {
    std::string chosen = kQualityNames[static_cast<std::size_t>(settings.quality)];
    chooseFrom("Hold the frame rate", std::array{"off", "sharp", "balanced", "fast"}, chosen, 4);
    settings.quality = static_cast<Quality>(std::ranges::find(kQualityNames, chosen) - std::begin(kQualityNames));
}

void drawTimes(const OverlayStatus& status) {
    const std::vector<float>& times = status.frame_ms;
    const float last = times.empty() ? 0.0f : times.back();
    const std::string label = last > 0.0f ? fmt::format("{:.1f} ms, {:.0f} frames/s", last, 1000.0f / last) : "";
    // A first frame that makes its kernels does not press the others flat.
    std::vector<float> sorted = times;
    std::ranges::sort(sorted);
    const float highest = sorted.empty() ? 0.0f : 2.0f * sorted[sorted.size() / 2];
    ImGui::PlotLines("frame", times.data(), static_cast<int>(times.size()), 0, label.c_str(), 0.0f, std::max(highest, 33.3f),
                     ImVec2(0.0f, 60.0f));
    if (status.frame == nullptr) { return; }
    const auto count = [&](const std::string& name) {
        const auto found = status.frame->counters.find(name);
        return found == status.frame->counters.end() ? 0.0 : static_cast<double>(found->second);
    };
    const double tiles = std::max(count("tiles_left"), count("tiles_right"));
    const double hidden = count("tiles_hidden_left") + count("tiles_hidden_right");
    const double made = count("pixels_covered") + count("pixels_gap") + count("pixels_hole");
    text(fmt::format("GPU {:.2f} ms   patched {:.1f} %   holes {:.2f} %   splats {:.0f} k", status.frame->gpu_total_ms,
                     100.0 * count("tiles_patched") / std::max(tiles - 0.5 * hidden, 1.0),
                     100.0 * count("pixels_hole") / std::max(made, 1.0),
                     std::max({count("splats_visible"), count("splats_visible_left"), count("splats_visible_right")}) / 1000.0));
    if (hidden > 0.0) {
        text(fmt::format("the lenses hide {:.0f} and {:.0f} of {:.0f} tiles", count("tiles_hidden_left"), count("tiles_hidden_right"),
                         tiles));
    }
    if (const double cut_short = count("frames_cut_short"); cut_short > 0.0) {
        text(fmt::format("{:.0f} frames had no room in their lists, {:.0f} were drawn again", cut_short, count("frames_done_again")));
    }
    ImGui::BeginChild("stages", ImVec2(0.0f, 0.0f), true);
    ImGui::Columns(2, "stages", false);
    for (const auto& [name, ms] : addUp(status.frame->gpu_ms)) {
        text(fmt::format("{:>6.2f} {}", ms, name));
        ImGui::NextColumn();
    }
    ImGui::Columns(1);
    ImGui::EndChild();
}

}  // namespace

OverlayActions drawOverlay(glm::uvec2 size_px, ViewSettings& settings, const OverlayStatus& status) {
    OverlayActions actions;
    ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(static_cast<float>(size_px.x), static_cast<float>(size_px.y)));
    ImGui::Begin("binosplat", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * kLabelShare);
    text(status.state.empty() ? status.scene : fmt::format("{}  {}", status.state, status.scene));
    const auto drawLoading = [&] {
        if (status.loading) { ImGui::ProgressBar(static_cast<float>(*status.loading), ImVec2(-1.0f, 0.0f)); }
    };
    if (!status.has_scene) {
        drawLoading();
    } else {
        drawMethod(settings);
        drawResolution(settings);
        actions.save = ImGui::Button("Save");
        ImGui::SameLine();
        actions.load = ImGui::Button("Load");
        ImGui::SameLine();
        actions.reset_scene = ImGui::Button("Scene back to its place");
        ImGui::SameLine();
        actions.quit = ImGui::Button("Quit");
        ImGui::SameLine();
        actions.recentre = ImGui::Button("Recentre");
        if (status.can_reload_shaders) {
            ImGui::SameLine();
            actions.reload_shaders = ImGui::Button("Shaders");
        }
        drawQuality(settings);
        ImGui::Checkbox("Two hands may tilt the scene", &settings.tilt);
        ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.75f);
        actions.level_scene = ImGui::Button("Level");
        if (ImGui::Button("Scene before")) { actions.scene_step = -1; }
        ImGui::SameLine();
        if (ImGui::Button("Next scene")) { actions.scene_step = 1; }
        ImGui::SameLine();
        actions.take_picture = ImGui::Button("Picture");
        drawComfort(settings, status.can_pass_through);
        // What is said may take several lines, and moves nothing that is pointed at.
        ImGui::TextWrapped("%s",
                           status.message.empty() ? "Trigger clicks, squeeze grabs; both squeezed hold the scene" : status.message.c_str());
        drawLoading();
        if (!status.governor.empty()) { ImGui::TextWrapped("%s", status.governor.c_str()); }
        drawTimes(status);
    }
    ImGui::PopItemWidth();
    // The ray's end.
    if (ImGui::IsMousePosValid()) {
        ImGui::GetForegroundDrawList()->AddCircleFilled(ImGui::GetIO().MousePos, 6.0f, IM_COL32(255, 220, 80, 255));
    }
    ImGui::End();
    return actions;
}

}  // namespace binosplat
