// What the wearer's hands do to the scene about them.
#pragma once

#include "app/view/wearer/wearer_tool.h"

#include <memory>

namespace binosplat {

// The tools, and the buttons. Menu: the panel comes before the eyes, or goes.
class WearerControls {
public:
    WearerControls();

    void update(const WearerNow& now, PanelInRoom& panel, ViewState& state);

    // To the next viewpoint where the right stick was pressed in just now, and back where the left one was.
    [[nodiscard]] int viewpointStep() const { return viewpoint_step_; }
    // Whether a hand pressed just now what lets a scene play or rest.
    [[nodiscard]] bool playPressed() const { return play_pressed_; }

    // Of all tools, see WearerTool.
    void letGo();
    [[nodiscard]] bool isMoving() const;
    [[nodiscard]] std::optional<int> aimingHand() const;
    [[nodiscard]] std::vector<Thing> things(const glm::dvec3& eye) const;
    [[nodiscard]] std::vector<ToolChoice> choices() const;

private:
    void pressButtons(const WearerNow& now, PanelInRoom& panel, ViewState& state);

    std::vector<std::unique_ptr<WearerTool>> tools_;
    bool menu_ = false, play_ = false, play_pressed_ = false;
    std::array<bool, 2> stick_presses_{};
    int viewpoint_step_ = 0;
};

}  // namespace binosplat
