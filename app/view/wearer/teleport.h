// Where a wearer who points at the floor will stand. Room axes: x right, y down, z forward; metres.
#pragma once

#include "app/view/wearer/wearer_tool.h"

namespace binosplat {

struct TeleportAim {
    Arc arc;                           // from the hand to the floor
    std::optional<glm::dvec3> target;  // on the floor; empty: the hand is below it, so there is no arc
};

// The arc of something thrown from the hand along its aim: the higher it points, the farther, up to about six
// metres. The floor's y is `floor_m`.
TeleportAim aimTeleport(const Pose& room_from_aim, double floor_m);

// If chosen: pushing the left stick forwards, or pulling a trigger away from the panel, aims at the floor;
// letting go moves the wearer there, unless the scene is in the way. Bare hands, which have no stick, always
// do so by pinching; a pinch that is pulled aside turns the wearer instead, so that the scene follows the
// hand.
class Teleport : public WearerTool {
public:
    void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) override;
    void letGo() override {
        aiming_.reset();
        aim_ = {};
    }
    [[nodiscard]] std::optional<int> aimingHand() const override { return aiming_; }
    [[nodiscard]] const Arc* arc() const override { return aim_.target ? &aim_.arc : nullptr; }
    // The arc's end, which is red where the wearer cannot stand.
    [[nodiscard]] std::vector<Thing> things(const glm::dvec3& eye) const override;
    [[nodiscard]] std::vector<ToolChoice> choices() const override {
        return {{"Left stick", {"Walk", "Teleport"}, &ViewSettings::teleport}};
    }

private:
    [[nodiscard]] bool aims(int h, const WearerNow& now, const PanelInRoom& panel, bool is_chosen) const;
    // True if the pinch has turned the wearer.
    [[nodiscard]] bool pullsAside(const WearerNow& now, ViewState& state);

    std::optional<int> aiming_;
    TeleportAim aim_;
    glm::dvec3 pinched_at_{0.0};
    std::array<bool, 2> is_spent_{};  // this click has turned the wearer, or measured
};

}  // namespace binosplat
