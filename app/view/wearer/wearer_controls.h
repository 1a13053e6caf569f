// Controlling the scene with the wearer's hands.
#pragma once

#include "app/view/wearer/wearer_tool.h"

#include <memory>

namespace binosplat {

// The tools, and the buttons. The menu button shows the panel in front of the eyes, or hides it.
class WearerControls {
public:
    WearerControls();

    void update(const WearerNow& now, PanelInRoom& panel, ViewState& state);

    // 1 if the right stick was just pressed (next viewpoint), -1 if the left one was (previous), or their
    // sum.
    [[nodiscard]] int viewpointStep() const { return viewpoint_step_; }
    // True if a hand has just pressed the button that plays or pauses a scene.
    [[nodiscard]] bool playPressed() const { return play_pressed_; }

    // Whether the same button is held, for each hand.
    [[nodiscard]] const std::array<bool, 2>& playHeld() const { return play_held_; }

    // For all tools, see WearerTool.
    void letGo();
    [[nodiscard]] bool isMoving() const;
    [[nodiscard]] std::optional<int> aimingHand() const;
    [[nodiscard]] const Arc* arc() const;
    [[nodiscard]] std::vector<Thing> things(const glm::dvec3& eye) const;
    [[nodiscard]] std::vector<ToolChoice> choices() const;

private:
    void pressButtons(const WearerNow& now, PanelInRoom& panel, ViewState& state);

    std::vector<std::unique_ptr<WearerTool>> tools_;
    bool menu_ = false, play_ = false, play_pressed_ = false;
    std::array<bool, 2> play_held_{}, stick_presses_{};
    int viewpoint_step_ = 0;
};

}  // namespace binosplat
