// Thumbsticks as what moves the wearer. The stick of the hand that points at the panel scrolls there instead, and moves nobody.
#pragma once

#include "app/view/wearer/wearer_tool.h"

namespace binosplat {

// A stick that is pushed this far does something, and has come back below that. Thumbs shiver within the dead zone.
inline constexpr double kStickPushed = 0.7, kStickRests = 0.4, kStickDeadZone = 0.15;

// The left one goes where the head looks, unless it teleports; the right one rises and sinks.
class Walk : public WearerTool {
public:
    void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) override;
    [[nodiscard]] bool isMoving() const override { return moves_; }

private:
    bool moves_ = false;
};

// The right one turns by 30 degrees at a time, or smoothly.
class Turn : public WearerTool {
public:
    void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) override;
    [[nodiscard]] bool isMoving() const override { return moves_; }
    [[nodiscard]] std::vector<ToolChoice> choices() const override {
        return {{"Right stick", {"Turn by 30\xc2\xb0", "Turn smoothly"}, &ViewSettings::smooth_turn}};
    }

private:
    bool turned_ = false, moves_ = false;
};

}  // namespace binosplat
