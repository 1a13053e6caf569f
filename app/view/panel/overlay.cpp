// The panel, top to bottom.
#include "app/view/panel/overlay.h"

#include "app/options/option_table.h"
#include "app/report/report.h"
#include "app/view/panel/comfort_widgets.h"
#include "app/view/panel/shown_text.h"
#include "app/view/view_settings_table.h"
#include "engine/platform.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace binosplat {

namespace {

constexpr float kLabelShare = 0.62f;  // of the width, for sliders beside their label

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str()); }

// As much of its end as fits into a line: of a path the end says more.
std::string endOf(std::string line) {
    const float room = ImGui::GetContentRegionAvail().x;
    if (ImGui::CalcTextSize(line.c_str()).x <= room) { return line; }
    // A letter's first byte, not one of those that continue it.
    const auto begins = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0) != 0x80; };
    while (!line.empty() && ImGui::CalcTextSize(("..." + line).c_str()).x > room) {
        line.erase(0, 1);
        while (!line.empty() && !begins(line.front())) { line.erase(0, 1); }
    }
    return "..." + line;
}

// One of the names that the table has for an option, in this order.
template <typename Owner>
void choose(PanelWidgets& widgets, const char* label, const OptionRow<Owner>& row, std::span<const std::string_view> names, Owner& owner,
            std::size_t per_row) {
    const auto pressed = widgets.chooseFrom(label, names, textOf(row.field.value(owner)), per_row);
    if (pressed) { row.field.read({label, {std::string(*pressed)}}, owner); }
}
template <typename Owner>
void choose(PanelWidgets& widgets, const char* label, const OptionRow<Owner>& row, Owner& owner, std::size_t per_row) {
    choose(widgets, label, row, row.field.choices, owner, per_row);
}

// What the table says of a number; more than a slider has is for the command line.
struct SliderRange {
    double least, most;
};
template <typename Owner>
SliderRange sliderOf(const OptionRow<Owner>& row) {
    return {*row.field.least, row.field.slider_most.value_or(*row.field.most)};
}

void drawMethod(PanelWidgets& widgets, ViewSettings& settings, Order usual_order) {
    RunOptions options;
    options.stereo = settings.stereo;
    StereoOptions& stereo = options.stereo;
    const OptionRow<RunOptions>& methods = *findRunRow("mode");
    std::vector<std::string_view> names = methods.field.choices;
    std::ranges::rotate(names, names.begin() + 1);  // one eye last
    choose(widgets, "Method", methods, names, options, 3);
    choose(widgets, "Dominant eye", *findRunRow("dominant"), options, 3);
    ImGui::SameLine(ImGui::GetContentRegionAvail().x * 2.0f / 3.0f);  // the row's last third is free
    bool by_distance = stereo.order.value_or(usual_order) == Order::kDistance;
    if (widgets.checkbox("Sort by distance", &by_distance)) { stereo.order = by_distance ? Order::kDistance : Order::kDepth; }
    choose(widgets, "Depth of a pixel", *findRunRow("depth"), options, 3);
    widgets.checkbox("Centre ROI (paper)", &stereo.center_roi);
    ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.55f);
    widgets.checkbox("Show what made it", &settings.tint);
    const SliderRange margins = sliderOf(*findRunRow("margin"));
    const int least_px = static_cast<int>(margins.least), most_px = static_cast<int>(margins.most);
    int margin = static_cast<int>(stereo.margin_px);
    if (ImGui::SliderInt("margin (paper)", &margin, least_px, most_px, "%d px")) {
        stereo.margin_px = static_cast<std::uint32_t>(std::clamp(margin, least_px, most_px));
    }
    widgets.noteSlider("margin (paper)");
    const SliderRange budgets = sliderOf(*findRunRow("budget"));
    auto budget = static_cast<float>(100.0 * stereo.budget);
    if (ImGui::SliderFloat("budget (predicted)", &budget, static_cast<float>(100.0 * budgets.least),
                           static_cast<float>(100.0 * budgets.most), "%.0f %% of an eye")) {
        stereo.budget = std::clamp(static_cast<double>(budget) / 100.0, budgets.least, budgets.most);
    }
    widgets.noteSlider("budget (predicted)");
    settings.stereo = stereo;
}

// The images are made anew for another resolution, so it changes once the slider is let go.
void drawResolution(PanelWidgets& widgets, ViewSettings& settings) {
    const SliderRange scales = sliderOf(*findViewRow("resolution-scale"));
    ImGuiStorage* storage = ImGui::GetStateStorage();
    const ImGuiID id = ImGui::GetID("resolution being chosen");
    auto scale = storage->GetFloat(id, static_cast<float>(settings.resolution_scale));
    ImGui::SliderFloat("resolution", &scale, static_cast<float>(scales.least), static_cast<float>(scales.most), "%.2f");
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

void drawQuality(PanelWidgets& widgets, ViewSettings& settings) {
    choose(widgets, "Hold the frame rate", *findViewRow("quality"), settings, 4);
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
    const FrameCounters& counters = status.frame->counters;
    std::uint64_t tiles = 0, hidden = 0, splats = 0;
    for (const TargetCounters& target : counters.targets) {
        tiles = std::max(tiles, target.tiles);
        hidden += target.tiles_hidden;
        splats = std::max(splats, target.splats_visible);
    }
    const WarpedCounters warped = counters.warped.value_or(WarpedCounters{});
    const WarpedCounters::Classes pixels = warped.pixels.value_or(WarpedCounters::Classes{});
    const auto percent = [](std::uint64_t part, double whole) { return 100.0 * static_cast<double>(part) / std::max(whole, 1.0); };
    text(fmt::format("GPU {:.2f} ms   patched {:.1f} %   holes {:.2f} %   splats {:.0f} k", status.frame->gpu_total_ms,
                     percent(warped.tiles_patched, static_cast<double>(tiles) - 0.5 * static_cast<double>(hidden)),
                     percent(pixels.hole, static_cast<double>(pixels.covered + pixels.gap + pixels.hole)),
                     static_cast<double>(splats) / 1000.0));
}

void drawStages(const FrameResult& frame) {
    const std::vector<TargetCounters>& targets = frame.counters.targets;
    if (targets.size() == 2 && targets[kLeft].tiles_hidden + targets[kRight].tiles_hidden > 0) {
        text(fmt::format("the lenses hide {} and {} of {} tiles", targets[kLeft].tiles_hidden, targets[kRight].tiles_hidden,
                         std::max(targets[kLeft].tiles, targets[kRight].tiles)));
    }
    if (const auto& ahead = frame.counters.ahead; ahead && ahead->frames_cut_short > 0) {
        text(fmt::format("{} frames had no room in their lists, {} were drawn again", ahead->frames_cut_short, ahead->frames_done_again));
    }
    ImGui::BeginChild("stages", ImVec2(0.0f, 0.0f), true);
    ImGui::Columns(2, "stages", false);
    for (const auto& [label, ms] : addUp(frame.gpu_ms)) {
        text(fmt::format("{:>6.2f} {}", ms, label.text()));
        ImGui::NextColumn();
    }
    ImGui::Columns(1);
    ImGui::EndChild();
}

// What came of what was done, and what goes on; it may take several lines, and moves nothing that is pointed at.
void drawSaid(const OverlayStatus& status) {
    writeWrapped(status.message.empty() ? "Trigger clicks, squeeze grabs; both squeezed hold the scene" : status.message);
    if (status.loading) { ImGui::ProgressBar(static_cast<float>(*status.loading), ImVec2(-1.0f, 0.0f)); }
    if (!status.governor.empty()) { writeWrapped(status.governor); }
    if (!status.files.empty()) { text(endOf(asShown(status.files))); }
}

void drawSettings(PanelWidgets& widgets, ViewSettings& settings, const OverlayStatus& status, OverlayActions& actions) {
    drawMethod(widgets, settings, status.usual_order);
    drawResolution(widgets, settings);
    drawQuality(widgets, settings);
    widgets.checkbox("Two hands may tilt the scene", &settings.tilt);
    ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.505f);
    bool foveated = settings.stereo.foveation_deg > 0.0;
    if (foveated) { settings.last_foveation_deg = settings.stereo.foveation_deg; }
    if (widgets.checkbox("Foveation", &foveated)) { settings.stereo.foveation_deg = foveated ? settings.last_foveation_deg : 0.0; }
    ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.75f);
    actions.level_scene = widgets.button("Level");
    actions.recentre = widgets.button("Recentre");
    ImGui::SameLine();
    actions.reset_scene = widgets.button("Scene back to its place");
    actions.save = widgets.button("Save");
    ImGui::SameLine();
    actions.load = widgets.button("Load");
    ImGui::SameLine();
    actions.take_picture = widgets.button("Picture");
    if (status.can_reload_shaders) {
        ImGui::SameLine();
        actions.reload_shaders = widgets.button("Shaders");
    }
    drawComfort(widgets, settings, status.can_pass_through);
    drawRates(widgets, settings, status.refresh_rates);
    drawSaid(status);
    drawTimes(status);
}

void drawChooser(PanelWidgets& widgets, SceneChooser& chooser, OverlayActions& actions) {
    ImGui::BeginDisabled(chooser.list().above.empty());
    if (widgets.button("Up")) { chooser.goUp(); }
    ImGui::EndDisabled();
    ImGui::SameLine();
    const std::string home = environment("HOME");
    ImGui::BeginDisabled(home.empty());
    if (widgets.button("Home")) { chooser.showFolder(home); }
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (widgets.button("Built-in")) { chooser.showFolder(kBuiltinFolder); }
    ImGui::SameLine();
    if (widgets.button("Recent")) { chooser.showRecent(); }
    ImGui::SameLine();
    if (widgets.button("<")) { chooser.turn(-1); }
    ImGui::SameLine();
    if (widgets.button(">")) { chooser.turn(1); }
    ImGui::SameLine();
    text(fmt::format("{} of {}", chooser.page() + 1, chooser.pageCount()));
    // As many lines as there may be entries, so that what is below stays where it is.
    const float rows = static_cast<float>(SceneChooser::kRows) * ImGui::GetFrameHeightWithSpacing() + ImGui::GetTextLineHeightWithSpacing();
    ImGui::BeginChild("scenes", ImVec2(0.0f, rows));
    text(endOf(asShown(chooser.list().title)));
    if (!chooser.list().trouble.empty()) { writeWrapped(chooser.list().trouble); }
    if (chooser.list().trouble.empty() && chooser.list().entries.empty() && !chooser.isReading()) { text("No scenes and no folders"); }
    const SceneEntry* pressed = nullptr;
    for (const SceneEntry& entry : chooser.shown()) {
        if (widgets.entry(entry.is_folder ? entry.name + "/" : entry.name, entry.trouble)) { pressed = &entry; }
    }
    if (pressed != nullptr) { actions.chosen_scene = chooser.open(*pressed); }
    ImGui::EndChild();
}

void drawScenes(PanelWidgets& widgets, SceneChooser& chooser, const OverlayStatus& status, OverlayActions& actions) {
    drawChooser(widgets, chooser, actions);
    if (widgets.button("Scene before")) { actions.scene_step = -1; }
    ImGui::SameLine();
    if (widgets.button("Next scene")) { actions.scene_step = 1; }
    drawSaid(status);
}

void drawFacts(const OverlayStatus& status) {
    for (const auto& [name, value] : status.facts) {
        text(name);
        ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.3f);
        writeWrapped(value);
    }
    drawSaid(status);
    if (status.frame != nullptr) { drawStages(*status.frame); }
}

// Which page is shown; each is drawn anew when it is asked for.
void drawPageButtons(PanelWidgets& widgets, OverlayPages& pages, const OverlayStatus& status) {
    using Page = OverlayPages::Page;
    for (const auto& [name, page] :
         {std::pair("Settings", Page::kSettings), std::pair("Scenes", Page::kScenes), std::pair("Scene info", Page::kFacts)}) {
        const bool shown = pages.shown == page;
        if (shown) { ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive)); }
        if (widgets.button(name)) {
            pages.shown = page;
            if (page == Page::kScenes) { pages.chooser.refresh(status.scene); }
        }
        if (shown) { ImGui::PopStyleColor(); }
        ImGui::SameLine();
    }
}

}  // namespace

std::string namesOn(const OverlayPages& pages, const OverlayStatus& status) {
    std::string names = asShown(status.scene) + asShown(status.message) + asShown(status.files);
    if (pages.shown == OverlayPages::Page::kScenes) {
        names += asShown(pages.chooser.list().title) + asShown(pages.chooser.list().trouble);
        for (const SceneEntry& entry : pages.chooser.shown()) { names += asShown(entry.name) + asShown(entry.trouble); }
    } else if (pages.shown == OverlayPages::Page::kFacts) {
        for (const auto& [name, value] : status.facts) { names += asShown(value); }
    }
    return names;
}

OverlayActions drawOverlay(glm::uvec2 size_px, ViewSettings& settings, OverlayPages& pages, const OverlayStatus& status) {
    OverlayActions actions;
    PanelWidgets widgets;
    ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(static_cast<float>(size_px.x), static_cast<float>(size_px.y)));
    ImGui::Begin("binosplat", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * kLabelShare);
    // Quit stands at the right, away from what is pressed often.
    if (status.has_scene) { drawPageButtons(widgets, pages, status); }
    ImGui::SetCursorPosX(ImGui::GetWindowWidth() * 0.885f);
    actions.quit = widgets.button("Quit");
    text(endOf(asShown(status.state.empty() ? status.scene : fmt::format("{}  {}", status.state, status.scene))));
    if (!status.has_scene) {
        if (status.loading) { ImGui::ProgressBar(static_cast<float>(*status.loading), ImVec2(-1.0f, 0.0f)); }
    } else if (pages.shown == OverlayPages::Page::kSettings) {
        drawSettings(widgets, settings, status, actions);
    } else if (pages.shown == OverlayPages::Page::kScenes) {
        drawScenes(widgets, pages.chooser, status, actions);
    } else {
        drawFacts(status);
    }
    ImGui::PopItemWidth();
    // The ray's end.
    if (ImGui::IsMousePosValid()) {
        ImGui::GetForegroundDrawList()->AddCircleFilled(ImGui::GetIO().MousePos, 6.0f, IM_COL32(255, 220, 80, 255));
    }
    ImGui::End();
    actions.places = widgets.places();
    return actions;
}

}  // namespace binosplat
