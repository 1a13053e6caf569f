// Clicks and letters.
#include "app/desktop/desktop_panel.h"

#include "app/desktop/eye_parts.h"
#include "app/view/panel/panel_style.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include <algorithm>

namespace binosplat {

namespace {

constexpr std::array<std::pair<int, bool PanelRequests::*>, 8> kRequestKeys{
    {{GLFW_KEY_H, &PanelRequests::help},
     {GLFW_KEY_F, &PanelRequests::show_whole},
     {GLFW_KEY_R, &PanelRequests::reset_scene},
     {GLFW_KEY_O, &PanelRequests::open_file},
     {GLFW_KEY_C, &PanelRequests::compare},
     {GLFW_KEY_P, &PanelRequests::take_picture},
     {GLFW_KEY_F11, &PanelRequests::fill_screen},
     {GLFW_KEY_SPACE, &PanelRequests::play}}};

}  // namespace

DesktopPanel::DesktopPanel(const Context& context, const FrameLog& log)
    : log_(log), picture_(context, vk::Format::eR8G8B8A8Srgb) {
    picture_.status().window.emplace();
    if (const std::string& complaint = picture_.canvas().font().complaint(); !complaint.empty()) {
        log_.print(complaint);
    }
}

void DesktopPanel::say(const std::string& message) {
    picture_.status().message = message;
    layouts_due_ = std::max(layouts_due_, 1);
    log_.say(message);
}

void DesktopPanel::toggleHelp(ViewState& state) {
    bool& helps = picture_.status().window->helps;
    helps = !helps || !state.settings().panel;
    ViewSettings settings = state.settings();
    settings.panel = true;
    settings.page = PanelPage::kView;
    state.set(settings);
    log_.say(helps ? "help" : "no help");
}

PanelRequests requestsOf(int key, const ViewSettings& settings, const PanelStatus& now) {
    PanelRequests requests;
    requests.settings = settings;
    const auto at = std::ranges::find(kRequestKeys, key, [](const auto& of) { return of.first; });
    if (at != kRequestKeys.end()) {
        requests.*at->second = true;
        requests.compare = requests.compare && !now.compares;  // while held, it shows the other scene
    } else if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
        requests.viewpoint = static_cast<std::size_t>(key - GLFW_KEY_1);
    } else if (key == GLFW_KEY_TAB) {
        requests.settings.panel = !settings.panel;
    } else if (key == GLFW_KEY_PERIOD || key == GLFW_KEY_COMMA) {
        requests.frame_step = key == GLFW_KEY_PERIOD ? 1 : -1;
    } else if (key == GLFW_KEY_ESCAPE) {
        (now.window->fills_screen ? requests.fill_screen : requests.quit) = true;
    }
    return requests;
}

bool DesktopPanel::takesText(const DesktopEvent& event) {
    using Kind = DesktopEvent::Kind;
    TextEntry& entry = picture_.entry();
    layouts_due_ = 2;
    if (event.kind == Kind::kText && entry.isOpen()) {
        std::array<char, 5> letter{};
        entry.type(ImTextCharToUtf8(letter.data(), static_cast<unsigned>(event.code)));
    }
    if (event.kind != Kind::kKey || !entry.isOpen()) { return event.kind == Kind::kText; }
    if (event.code == GLFW_KEY_BACKSPACE) { entry.eraseLast(); }
    if (event.code == GLFW_KEY_ESCAPE) { entry.close(); }
    if (event.code == GLFW_KEY_ENTER || event.code == GLFW_KEY_KP_ENTER) { entry.confirm(); }
    return true;
}

bool DesktopPanel::takesMouse(const DesktopEvent& event, const WindowPart& part, bool is_free) {
    using Kind = DesktopEvent::Kind;
    if (event.kind == Kind::kKey || event.kind == Kind::kDrop) { return false; }
    if (event.kind == Kind::kLeave || !is_free || !(pointer_.pressed || isIn(part, event.place_px))) {
        if (event.kind == Kind::kMove || event.kind == Kind::kLeave) { pointer_.place_px.reset(); }
        return false;
    }
    pointer_.place_px =
        (event.place_px - glm::dvec2(part.at_px)) * glm::dvec2(kPanelPx) / glm::dvec2(part.size_px);
    if (event.kind == Kind::kPress && event.isLeft()) { pointer_.pressed = true; }
    if (event.kind == Kind::kRelease && event.isLeft()) { pointer_.pressed = false; }
    pointer_.wheel = event.kind == Kind::kWheel ? event.steps : 0.0;
    return true;
}

PanelRequests DesktopPanel::layOut(const ViewSettings& settings, double seconds) {
    layouts_due_ = std::max(layouts_due_ - 1, 0);
    PanelRequests requests = picture_.layOut(pointer_, settings, seconds);
    pointer_.wheel = 0.0;
    return requests;
}

void DesktopPanel::keepFrameTime() {
    layouts_due_ = std::max(layouts_due_, 1);  // the times are new
    picture_.keepFrameTime();
}

}  // namespace binosplat
