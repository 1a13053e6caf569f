// The panel, top to bottom.
#include "app/view/panel/panel_content.h"

#include "app/view/panel/panel_pages.h"
#include "app/view/panel/panel_style.h"
#include "app/view/panel/shown_text.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <vector>

namespace binosplat {

namespace {

// Shares of the width; Quit is on the right, away from buttons that are pressed often.
constexpr float kTabsShare = 0.64f, kMoreTabsShare = 0.78f;
// Transparent around it, and the radius of its corners.
constexpr float kRimPx = 2.0f, kCornerPx = 14.0f;

// Chooses the page; the list of scenes is refreshed when its page is opened.
void drawTabs(PanelWidgets& widgets, ViewSettings& settings, SceneChooser& chooser,
              const PanelStatus& status) {
    static constexpr std::array kNames{"View", "Scenes", "Method", "Time", "Help"};  // by PanelPage
    std::vector<PanelPage> pages{PanelPage::kView, PanelPage::kScenes, PanelPage::kMethod};
    if (status.time) { pages.push_back(PanelPage::kTime); }
    if (!status.window) { pages.push_back(PanelPage::kHelp); }  // there H lists the keys
    if (std::ranges::find(pages, settings.page) == pages.end()) { settings.page = PanelPage::kView; }
    std::vector<const char*> tabs;
    for (const PanelPage page : pages) { tabs.push_back(kNames[static_cast<std::size_t>(page)]); }
    const auto chosen = static_cast<std::size_t>(std::ranges::find(pages, settings.page) - pages.begin());
    const auto pressed = widgets.row(tabs, chosen, kTabPx, tabs.size() > 3 ? kMoreTabsShare : kTabsShare);
    if (pressed) { settings.page = pages[*pressed]; }
    if (settings.page == PanelPage::kScenes && (pressed || chooser.isNew())) {
        chooser.refresh(status.scene);
    }
    ImGui::SameLine();
}

}  // namespace

void drawSaid(const PanelStatus& status) {
    static constexpr const char* kHands =
        "Trigger: click. Grip: move the scene. Both grips: turn it and make it larger or smaller.";
    static constexpr const char* kMouse =
        "Left button: orbit. Right button: move. Wheel: nearer and farther. H: all keys.";
    writeWrapped(!status.message.empty() ? status.message : status.window ? kMouse : kHands);
    if (status.loading) { ImGui::ProgressBar(static_cast<float>(*status.loading), ImVec2(-1.0f, 0.0f)); }
    if (!status.files.empty()) { writeLine(endOf(asShown(status.files))); }
}

std::string namesOn(const ViewSettings& settings, const SceneChooser& chooser, const PanelStatus& status) {
    std::string names;
    const auto add = [&](const std::string& name) { names += name + '\n'; };
    for (const std::string& name : {status.scene, status.message, status.files}) { add(name); }
    if (status.entry != nullptr) { add(status.entry->title()), add(status.entry->text()); }
    if (settings.page == PanelPage::kScenes) {
        add(chooser.list().title);
        add(chooser.list().trouble);
        for (const SceneEntry& entry : chooser.shown()) {
            for (const std::string& name : {entry.name, entry.about, entry.trouble}) { add(name); }
        }
        add(status.viewpoint);
    } else if (settings.page == PanelPage::kMethod) {
        for (const auto& [name, value] : status.facts) { add(value); }
    }
    return names;
}

std::vector<ScenePicture> picturesOn(const ViewSettings& settings, const SceneChooser& chooser) {
    std::vector<ScenePicture> pictures;
    if (settings.page != PanelPage::kScenes) { return pictures; }
    for (const SceneEntry& entry : chooser.shown()) {
        if (!entry.picture.key.empty()) { pictures.push_back(entry.picture); }
    }
    return pictures;
}

void followViewpoints(const PanelRequests& requests, TextEntry& entry, ViewpointList& viewpoints) {
    if (requests.tour) { viewpoints.toggleTour(); }
    if (requests.viewpoint_move != 0) { viewpoints.moveBy(requests.viewpoint_move); }
    if (requests.forget_viewpoint) { viewpoints.forget(); }
    if (requests.share_viewpoints) { viewpoints.writeShared(); }
    if (requests.read_viewpoints) { viewpoints.read(""); }
    if (requests.rename_viewpoint && viewpoints.requireOwn()) {
        entry.open(TextEntry::What::kViewpointName, "The viewpoint's name", viewpoints.current()->name);
    }
    if (requests.entered && requests.entered->first == TextEntry::What::kViewpointName) {
        viewpoints.rename(requests.entered->second);
    }
}

PanelRequests drawPanel(glm::uvec2 size_px, const ViewSettings& current, SceneChooser& chooser,
                        const PanelStatus& status) {
    PanelRequests requests;
    ViewSettings& settings = requests.settings = current;
    PanelWidgets widgets;
    ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(static_cast<float>(size_px.x), static_cast<float>(size_px.y)));
    ImGuiWindowFlags flags =
        ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
    if (!status.window) {
        // In the room its edges would be staircases: compositors smooth what lies within a picture alone.
        flags |= ImGuiWindowFlags_NoBackground;
        const auto width = static_cast<float>(size_px.x), height = static_cast<float>(size_px.y);
        ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(kRimPx, kRimPx),
                                                      ImVec2(width - kRimPx, height - kRimPx),
                                                      ImGui::GetColorU32(ImGuiCol_WindowBg), kCornerPx);
    }
    ImGui::Begin("binosplat", nullptr, flags);
    if (status.has_scene) { drawTabs(widgets, settings, chooser, status); }
    ImGui::SetCursorPosX(ImGui::GetWindowWidth() * 0.84f);
    static constexpr std::array kQuit{"Quit"};
    requests.quit = widgets.row(kQuit, {}, kTabPx).has_value();
    writeLine(endOf(
        asShown(status.state.empty() ? status.scene : fmt::format("{}  {}", status.state, status.scene))));
    if (status.entry != nullptr && status.entry->isOpen()) {
        drawTextEntry(widgets, *status.entry, requests);
    } else if (!status.has_scene) {
        if (status.loading) { ImGui::ProgressBar(static_cast<float>(*status.loading), ImVec2(-1.0f, 0.0f)); }
    } else if (settings.page == PanelPage::kView && status.window) {
        drawWindowPage(widgets, settings, status, requests);
    } else if (settings.page == PanelPage::kView) {
        drawViewPage(widgets, settings, status, requests);
    } else if (settings.page == PanelPage::kScenes) {
        drawScenesPage(widgets, chooser, status, requests);
    } else if (settings.page == PanelPage::kHelp) {
        drawHelpPage(widgets, status, requests);
    } else if (settings.page == PanelPage::kTime) {
        drawTimePage(widgets, status, requests);
    } else {
        drawMethodPage(widgets, settings, status, requests);
    }
    // The end of the ray.
    if (ImGui::IsMousePosValid() && !status.window) {
        ImGui::GetForegroundDrawList()->AddCircleFilled(ImGui::GetIO().MousePos, 6.0f,
                                                        IM_COL32(255, 220, 80, 255));
    }
    ImGui::End();
    requests.places = widgets.places();
    return requests;
}

}  // namespace binosplat
