// The buttons, and then the tools in turn.
#include "app/view/wearer/wearer_controls.h"

#include "app/view/wearer/grab.h"
#include "app/view/wearer/sticks.h"
#include "app/view/wearer/teleport.h"

#include <algorithm>
#include <utility>

namespace binosplat {

WearerControls::WearerControls() {
    tools_.push_back(std::make_unique<Walk>());
    tools_.push_back(std::make_unique<Teleport>());
    tools_.push_back(std::make_unique<Turn>());
    tools_.push_back(std::make_unique<Grab>());
}

void WearerControls::update(const WearerNow& now, PanelInRoom& panel, ViewState& state) {
    pressButtons(now, panel, state);
    panel.update(now.hands, state.settings().panel);
    for (const auto& tool : tools_) { tool->update(now, panel, state); }
}

void WearerControls::pressButtons(const WearerNow& now, PanelInRoom& panel, ViewState& state) {
    const bool menu = now.hands[kLeft].menu || now.hands[kRight].menu;
    if (!std::exchange(menu_, menu) && menu) {
        state.togglePanel();
        if (state.settings().panel) { panel.hangBefore(now.room_from_head); }
    }
    const bool play = now.hands[kLeft].play || now.hands[kRight].play;
    play_pressed_ = !std::exchange(play_, play) && play;
    viewpoint_step_ = 0;
    for (const int h : {kLeft, kRight}) {
        const bool pressed = now.hands[static_cast<std::size_t>(h)].stick_presses;
        if (!std::exchange(stick_presses_[static_cast<std::size_t>(h)], pressed) && pressed) { viewpoint_step_ += h == kRight ? 1 : -1; }
    }
}

void WearerControls::letGo() {
    for (const auto& tool : tools_) { tool->letGo(); }
}

bool WearerControls::isMoving() const {
    return std::ranges::any_of(tools_, [](const auto& tool) { return tool->isMoving(); });
}

std::optional<int> WearerControls::aimingHand() const {
    for (const auto& tool : tools_) {
        if (const std::optional<int> hand = tool->aimingHand()) { return hand; }
    }
    return {};
}

std::vector<Thing> WearerControls::things(const glm::dvec3& eye) const {
    std::vector<Thing> things;
    for (const auto& tool : tools_) { std::ranges::copy(tool->things(eye), std::back_inserter(things)); }
    return things;
}

std::vector<ToolChoice> WearerControls::choices() const {
    std::vector<ToolChoice> choices;
    for (const auto& tool : tools_) { std::ranges::copy(tool->choices(), std::back_inserter(choices)); }
    return choices;
}

}  // namespace binosplat
