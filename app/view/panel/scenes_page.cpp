// A browser of folders, with pictures of scenes seen before, and the viewpoints of the current scene.
#include "app/view/panel/panel_pages.h"
#include "app/view/panel/panel_style.h"
#include "app/view/panel/shown_text.h"
#include "engine/platform.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>

namespace binosplat {

namespace {

constexpr float kScenesShare = 0.68f;  // of a row, to the left of the comparison buttons
constexpr float kRowPx = 66.0f, kStarPx = 60.0f;

void drawPlaces(PanelWidgets& widgets, SceneChooser& chooser) {
    const std::string home = userHomeFolder().string();
    ImGui::BeginDisabled(chooser.list().above.empty());
    if (widgets.button("Up")) { chooser.goUp(); }
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(home.empty());
    if (widgets.button("Home")) { chooser.showFolder(home); }
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (widgets.button("Built-in")) { chooser.showFolder(kBuiltinFolder); }
    ImGui::SameLine();
    if (widgets.button("Recent")) { chooser.showRecent(); }
    ImGui::SameLine(0.0f, 2.0f * ImGui::GetStyle().ItemSpacing.x);
    if (widgets.button("<", false, {kTargetPx, 0.0f})) { chooser.turn(-1); }
    ImGui::SameLine();
    if (widgets.button(">", false, {kTargetPx, 0.0f})) { chooser.turn(1); }
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    writeLine(fmt::format("{} of {}", chooser.page() + 1, chooser.pageCount()));
}

void drawPicture(const SceneEntry& entry, const ImVec2& low, const PicturePlaces* places) {
    if (places == nullptr) { return; }
    const auto found = places->find(entry.picture.key);
    if (found == places->end()) { return; }
    const PictureCorners& corners = found->second;
    const float height = kRowPx - 6.0f, width = height * static_cast<float>(kScenePicturePx.x) /
                                                static_cast<float>(kScenePicturePx.y);
    const ImVec2 at(low.x + 3.0f, low.y + 3.0f);
    ImGui::GetWindowDrawList()->AddImage(ImGui::GetIO().Fonts->TexID, at, ImVec2(at.x + width, at.y + height),
                                         corners.low, corners.high);
}

void drawEntries(PanelWidgets& widgets, SceneChooser& chooser, const PicturePlaces* places,
                 PanelRequests& requests) {
    // There is always space for kRows entries, so that the widgets below stay in place.
    const float rows = static_cast<float>(SceneChooser::kRows) * (kRowPx + ImGui::GetStyle().ItemSpacing.y);
    ImGui::BeginChild("scenes", ImVec2(0.0f, rows + ImGui::GetTextLineHeightWithSpacing()));
    writeLine(endOf(asShown(chooser.list().title)));
    if (!chooser.list().trouble.empty()) { writeWrapped(chooser.list().trouble); }
    if (chooser.list().trouble.empty() && chooser.list().entries.empty() && !chooser.isReading()) {
        writeLine("No scenes and no folders");
    }
    const SceneEntry* pressed = nullptr;
    for (const SceneEntry& entry : chooser.shown()) {
        const ImVec2 low = ImGui::GetCursorScreenPos();
        const float gap = ImGui::GetStyle().ItemSpacing.x,
                    width = ImGui::GetContentRegionAvail().x - (entry.is_folder ? 0.0f : kStarPx + gap);
        const std::string name = entry.is_folder ? entry.name + "/" : entry.name;
        if (widgets.entry(name, entry.about, entry.trouble, {width, kRowPx},
                          entry.is_folder ? 0.0f : 1.4f * kRowPx)) {
            pressed = &entry;
        }
        drawPicture(entry, low, places);
        if (entry.is_folder) { continue; }
        ImGui::SameLine();
        if (widgets.star("favourite " + entry.name, entry.is_favourite, {kStarPx, kRowPx})) {
            requests.favourite = entry.place;
        }
    }
    if (pressed != nullptr) { requests.chosen_scene = chooser.open(*pressed); }
    ImGui::EndChild();
}

// Two buttons at the end of a row; both may be highlighted at once.
void drawComparison(PanelWidgets& widgets, const PanelStatus& status, PanelRequests& requests) {
    const float gap = 0.5f * ImGui::GetStyle().ItemSpacing.x;
    const float width = 0.5f * (ImGui::GetContentRegionAvail().x - gap);
    requests.compare = widgets.button("Compare", status.compares || status.compares_next, {width, kTargetPx});
    ImGui::SameLine(0.0f, gap);
    ImGui::BeginDisabled(!status.compares);
    requests.show_other = widgets.button("Other", status.shows_other, {width, kTargetPx});
    ImGui::EndDisabled();
}

void drawViewpoints(PanelWidgets& widgets, const PanelStatus& status, PanelRequests& requests) {
    static constexpr std::array kSteps{"Previous viewpoint", "Next viewpoint", "Keep this one"};
    if (const auto pressed = widgets.row(kSteps, {}, kTabPx)) {
        requests.viewpoint_step = *pressed == 0 ? -1 : *pressed == 1 ? 1 : 0;
        requests.keep_viewpoint = *pressed == 2;
    }
    static constexpr std::array kWithOwn{"Tour", "Name", "Earlier", "Later", "Forget", "Export", "Import"};
    if (const auto pressed =
            widgets.row(kWithOwn, status.tours ? std::optional<std::size_t>(0) : std::nullopt, kTargetPx)) {
        requests.tour = *pressed == 0;
        requests.rename_viewpoint = *pressed == 1;
        requests.viewpoint_move = *pressed == 2 ? -1 : *pressed == 3 ? 1 : 0;
        requests.forget_viewpoint = *pressed == 4;
        requests.share_viewpoints = *pressed == 5;
        requests.read_viewpoints = *pressed == 6;
    }
    const std::size_t count = status.viewpoint_count;
    std::string words = count == 0 ? "No viewpoints yet: keep one, or put a cameras.json beside the scene"
                                   : fmt::format("{} viewpoints", count);
    if (const auto& at = status.place.view) {
        words = fmt::format("Viewpoint {} of {}: {}", *at + 1, count, status.viewpoint);
    }
    writeLine(endOf(asShown(words)));
}

}  // namespace

void drawScenesPage(PanelWidgets& widgets, SceneChooser& chooser, const PanelStatus& status,
                    PanelRequests& requests) {
    drawPlaces(widgets, chooser);
    drawEntries(widgets, chooser, status.pictures, requests);
    static constexpr std::array kScenes{"Previous scene", "Next scene", "Last shown"};
    if (const auto pressed = widgets.row(kScenes, {}, kTargetPx, kScenesShare)) {
        requests.scene_step = *pressed == 0 ? -1 : *pressed == 1 ? 1 : 0;
        requests.last_scene = *pressed == 2;
    }
    ImGui::SameLine();
    drawComparison(widgets, status, requests);
    drawViewpoints(widgets, status, requests);
    drawSaid(status);
}

}  // namespace binosplat
