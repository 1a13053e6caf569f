// The buttons, and then the tools in turn.
#include "app/view/wearer/wearer_controls.h"

#include "app/view/wearer/follow_ground.h"
#include "app/view/wearer/grab.h"
#include "app/view/wearer/sticks.h"
#include "app/view/wearer/teleport.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

constexpr double kPalmCosine = 0.75;

// A hand whose palm is turned to the eyes does not point; its pinch serves as the menu button, which bare
// hands lack.
bool showsPalm(const xr::Hand& hand, int h, const glm::dvec3& eye) {
    if (!hand.joints) { return false; }
    const auto place = [&](XrHandJointEXT joint) {
        return (*hand.joints)[static_cast<std::size_t>(joint)].place;
    };
    const glm::dvec3 wrist = place(XR_HAND_JOINT_WRIST_EXT);
    const glm::dvec3 across = glm::cross(place(XR_HAND_JOINT_INDEX_PROXIMAL_EXT) - wrist,
                                         place(XR_HAND_JOINT_LITTLE_PROXIMAL_EXT) - wrist);
    const glm::dvec3 to_eye = eye - place(XR_HAND_JOINT_PALM_EXT);
    const double facing = (h == kRight ? 1.0 : -1.0) * glm::dot(across, to_eye);
    return facing > kPalmCosine * glm::length(across) * glm::length(to_eye);
}

}  // namespace

WearerControls::WearerControls() {
    tools_.push_back(std::make_unique<Walk>());
    tools_.push_back(std::make_unique<Teleport>());
    tools_.push_back(std::make_unique<Turn>());
    tools_.push_back(std::make_unique<Grab>());
    tools_.push_back(std::make_unique<FollowGround>());
}

void WearerControls::update(const WearerNow& seen, PanelInRoom& panel, ViewState& state) {
    WearerNow now = seen;
    for (const int h : {kLeft, kRight}) {
        xr::Hand& hand = now.hands[static_cast<std::size_t>(h)];
        if (!showsPalm(hand, h, now.room_from_head.position)) { continue; }
        hand.menu = hand.menu || hand.clicks;
        hand.clicks = false;
        hand.aim.reset();
    }
    pressButtons(now, panel, state);
    panel.update(now.hands, state.settings().panel);
    if (state.settings().panel) { panel.comeBefore(now.room_from_head, now.step_seconds); }
    for (const auto& tool : tools_) { tool->update(now, panel, state); }
}

void WearerControls::pressButtons(const WearerNow& now, PanelInRoom& panel, ViewState& state) {
    const bool menu = now.hands[kLeft].menu || now.hands[kRight].menu;
    if (!std::exchange(menu_, menu) && menu) {
        state.togglePanel();
        if (state.settings().panel) { panel.hangBefore(now.room_from_head); }
    }
    play_held_ = {now.hands[kLeft].play, now.hands[kRight].play};
    const bool play = play_held_[kLeft] || play_held_[kRight];
    play_pressed_ = !std::exchange(play_, play) && play;
    viewpoint_step_ = 0;
    for (const int h : {kLeft, kRight}) {
        const bool pressed = now.hands[static_cast<std::size_t>(h)].stick_presses;
        if (!std::exchange(stick_presses_[static_cast<std::size_t>(h)], pressed) && pressed) {
            viewpoint_step_ += h == kRight ? 1 : -1;
        }
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

const Arc* WearerControls::arc() const {
    for (const auto& tool : tools_) {
        if (const Arc* const arc = tool->arc(); arc != nullptr) { return arc; }
    }
    return nullptr;
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
