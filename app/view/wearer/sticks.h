// Moving the wearer with the thumbsticks. The stick of the hand that points at the panel scrolls there
// instead.
#pragma once

#include "app/view/wearer/wearer_tool.h"

namespace binosplat {

// A stick acts when it is pushed this far, and again only after it has come back below the second value.
// Movements within the dead zone are a trembling thumb.
inline constexpr double kStickPushed = 0.7, kStickRests = 0.4, kStickDeadZone = 0.15;

inline constexpr double kTurnRadians = 0.5235987755982988;  // 30 degrees

// The left stick walks along the head's direction, unless it teleports; the right one rises and sinks.
class Walk : public WearerTool {
public:
    void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) override;
    [[nodiscard]] bool isMoving() const override { return moves_; }

private:
    bool moves_ = false;
};

// The right stick turns by 30 degrees at a time, or smoothly.
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
