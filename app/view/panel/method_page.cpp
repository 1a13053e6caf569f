// All methods and their costs.
#include "app/options/modes.h"
#include "app/options/option_table.h"
#include "app/report/report.h"
#include "app/view/panel/panel_pages.h"
#include "app/view/settings/view_settings_table.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

namespace binosplat {

namespace {

constexpr float kSliderShare = 0.62f;  // of the width, for sliders beside their label

// One of the names that the table has for an option, in this order.
template <typename Owner>
void choose(PanelWidgets& widgets, const char* label, const OptionRow<Owner>& row,
            std::span<const std::string_view> names, Owner& owner, std::size_t per_row) {
    const auto pressed = widgets.chooseFrom(label, names, textOf(row.field.value(owner)), per_row);
    if (pressed) { row.field.read({label, {std::string(*pressed)}}, owner); }
}
template <typename Owner>
void choose(PanelWidgets& widgets, const char* label, const OptionRow<Owner>& row, Owner& owner,
            std::size_t per_row) {
    choose(widgets, label, row, row.field.choices, owner, per_row);
}

// The table's range of a number; values beyond the slider are for the command line.
struct SliderRange {
    double least, most;
};
template <typename Owner>
SliderRange sliderOf(const OptionRow<Owner>& row) {
    return {*row.field.least, row.field.slider_most.value_or(*row.field.most)};
}

void drawMethod(PanelWidgets& widgets, ViewSettings& settings, bool in_headset) {
    RunOptions options;
    options.stereo = settings.stereo;
    StereoOptions& stereo = options.stereo;
    const OptionRow<RunOptions>& methods = *findRunRow("mode");
    std::vector<std::string_view> names = methods.field.choices;
    std::ranges::rotate(names, names.begin() + 1);  // one eye last
    choose(widgets, "Method", methods, names, options, 3);
    choose(widgets, "Dominant eye", *findRunRow("dominant"), options, 3);
    const float width = ImGui::GetContentRegionAvail().x;
    if (in_headset) {
        ImGui::SameLine(0.75f * width);
        bool stay = stereo.axes == Axes::kStay;
        if (widgets.checkbox("Axes stay", &stay)) { stereo.axes = stay ? Axes::kStay : Axes::kView; }
    }
    choose(widgets, "Pixel depth", *findRunRow("depth"), options, 3);
    widgets.checkbox("Centre ROI (paper)", &stereo.warp.center_rois);
    ImGui::SameLine(0.4f * width);
    bool by_distance = stereo.order.value_or(kWearersOrder) == Order::kDistance;
    if (widgets.checkbox("Sort by distance", &by_distance)) {
        stereo.order = by_distance ? Order::kDistance : Order::kDepth;
    }
    ImGui::SameLine(0.75f * width);
    bool foveated = stereo.foveation_deg > 0.0;
    if (foveated) { settings.last_foveation_deg = stereo.foveation_deg; }
    if (widgets.checkbox("Foveation", &foveated)) {
        stereo.foveation_deg = foveated ? settings.last_foveation_deg : 0.0;
    }
    const SliderRange margins = sliderOf(*findRunRow("margin"));
    const int least_px = static_cast<int>(margins.least), most_px = static_cast<int>(margins.most);
    int margin = static_cast<int>(stereo.warp.margin_px);
    if (ImGui::SliderInt("margin (paper)", &margin, least_px, most_px, "%d px")) {
        stereo.warp.margin_px = static_cast<std::uint32_t>(std::clamp(margin, least_px, most_px));
    }
    widgets.noteSlider("margin (paper)");
    const SliderRange budgets = sliderOf(*findRunRow("budget"));
    auto budget = static_cast<float>(100.0 * stereo.warp.budget);
    if (ImGui::SliderFloat("budget", &budget, static_cast<float>(100.0 * budgets.least),
                           static_cast<float>(100.0 * budgets.most),
                           stereo.mode == Mode::kTemporal ? "%.0f %% of both eyes" : "%.0f %% of an eye")) {
        stereo.warp.budget = std::clamp(static_cast<double>(budget) / 100.0, budgets.least, budgets.most);
    }
    widgets.noteSlider("budget");
    settings.stereo = stereo;
}

// Another resolution needs new images, so it changes once the slider is released.
void drawResolution(PanelWidgets& widgets, ViewSettings& settings) {
    const SliderRange scales = sliderOf(*findViewRow("resolution-scale"));
    ImGuiStorage* storage = ImGui::GetStateStorage();
    const ImGuiID id = ImGui::GetID("resolution being chosen");
    auto scale = storage->GetFloat(id, static_cast<float>(settings.resolution_scale));
    ImGui::SliderFloat("resolution", &scale, static_cast<float>(scales.least),
                       static_cast<float>(scales.most), "%.2f");
    widgets.noteSlider("resolution");
    if (ImGui::IsItemActive()) {
        storage->SetFloat(id, scale);
        return;
    }
    if (ImGui::IsItemDeactivatedAfterEdit()) {
        const double chosen = std::clamp(static_cast<double>(scale), scales.least, scales.most);
        settings.resolution_scale = std::round(100.0 * chosen) / 100.0;  // as many digits as are shown
    }
    storage->SetFloat(id, static_cast<float>(settings.resolution_scale));
}

void drawTimes(const PanelStatus& status) {
    const std::vector<float>& times = status.frame_ms;
    const float last = times.empty() ? 0.0f : times.back();
    const std::string label =
        last > 0.0f ? fmt::format("{:.1f} ms, {:.0f} frames/s", last, 1000.0f / last) : "";
    // A slow first frame, which compiles kernels, must not flatten the others.
    std::vector<float> sorted = times;
    std::ranges::sort(sorted);
    const float highest = sorted.empty() ? 0.0f : 2.0f * sorted[sorted.size() / 2];
    ImGui::PlotLines("frame", times.data(), static_cast<int>(times.size()), 0, label.c_str(), 0.0f,
                     std::max(highest, 33.3f), ImVec2(0.0f, 60.0f));
    if (status.frame == nullptr) { return; }
    const FrameCounters& counters = status.frame->counters;
    std::uint64_t splats = 0;
    for (const TargetCounters& target : counters.targets) {
        splats = std::max(splats, target.splats_visible);
    }
    const WarpedCounters warped = counters.warped.value_or(WarpedCounters{});
    const WarpedCounters::Classes pixels = warped.pixels.value_or(WarpedCounters::Classes{});
    const auto percent = [](std::uint64_t part, double whole) {
        return 100.0 * static_cast<double>(part) / std::max(whole, 1.0);
    };
    writeLine(fmt::format(
        "GPU {:.2f} ms   patched {:.1f} %   holes {:.2f} %   splats {:.0f} k", status.frame->gpu_total_ms,
        percent(warped.tiles_patched, static_cast<double>(warped.tiles_shown)),
        percent(pixels.hole, static_cast<double>(pixels.covered + pixels.gap + pixels.hole)),
        static_cast<double>(splats) / 1000.0));
}

void drawFiles(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status,
               PanelRequests& requests) {
    widgets.checkbox("Show how tiles were made", &settings.tint);
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    requests.save = widgets.button("Save");
    ImGui::SameLine();
    requests.load = widgets.button("Load");
    if (status.can_reload_shaders) {
        ImGui::SameLine();
        requests.reload_shaders = widgets.button("Shaders");
    }
    if (status.takes_depth) { widgets.checkbox("Give the headset depth", &settings.submit_depth); }
}

// Facts about the scene.
void drawFacts(const PanelStatus& status) {
    const float width = ImGui::GetContentRegionAvail().x;
    for (const auto& [name, value] : status.facts) {
        writeLine(name);
        ImGui::SameLine(0.3f * width);
        writeWrapped(value);
    }
}

void drawStages(const FrameResult& frame) {
    const std::vector<TargetCounters>& targets = frame.counters.targets;
    if (targets.size() == 2 && targets[kLeft].tiles_hidden + targets[kRight].tiles_hidden > 0) {
        writeLine(fmt::format("hidden: {} and {} of {} tiles", targets[kLeft].tiles_hidden,
                              targets[kRight].tiles_hidden,
                              std::max(targets[kLeft].tiles, targets[kRight].tiles)));
    }
    if (const auto& ahead = frame.counters.ahead; ahead && ahead->frames_cut_short > 0) {
        writeLine(fmt::format("{} frames lacked capacity, {} were rendered again", ahead->frames_cut_short,
                              ahead->frames_done_again));
    }
    ImGui::Columns(2, "stages", false);
    for (const auto& [label, ms] : addUp(frame.gpu_ms)) {
        writeLine(fmt::format("{:>6.2f} {}", ms, label.text()));
        ImGui::NextColumn();
    }
    ImGui::Columns(1);
}

}  // namespace

void drawMethodPage(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status,
                    PanelRequests& requests) {
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * kSliderShare);
    drawMethod(widgets, settings, !status.window);
    drawResolution(widgets, settings);
    if (!status.window) { choose(widgets, "Frame rate", *findViewRow("quality"), settings, 4); }
    ImGui::PopItemWidth();
    drawFiles(widgets, settings, status, requests);
    drawSaid(status);
    if (!status.governor.empty()) { writeWrapped(status.governor); }
    drawTimes(status);
    ImGui::BeginChild("details", ImVec2(0.0f, 0.0f), true);
    if (status.frame != nullptr) { drawStages(*status.frame); }
    drawFacts(status);
    ImGui::EndChild();
}

}  // namespace binosplat
