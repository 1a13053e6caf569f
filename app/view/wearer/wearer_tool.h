// What a wearer's hands can be used for: walking, teleporting, turning, holding the scene.
#pragma once

#include "app/view/room/panel_in_room.h"
#include "app/view/settings/view_state.h"
#include "xr/input.h"

#include <array>
#include <optional>
#include <vector>

namespace binosplat {

// The wearer in a frame.
struct WearerNow {
    std::array<xr::Hand, 2> hands;
    Pose room_from_head;
    std::optional<double> floor_m;  // its y in the room, where the runtime knows
    double step_seconds = 0.0;
};

// A widget of a tool: one of two after `words`, or a box to tick where there are no names.
struct ToolChoice {
    const char* words;
    std::array<const char*, 2> names;  // of false and true; null: none
    bool ViewSettings::*chosen;
};

class WearerTool {
public:
    virtual ~WearerTool() = default;

    // Once a frame, after the panel has followed the hands.
    virtual void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) = 0;
    // The room begins elsewhere now: what is held is held from there on.
    virtual void letGo() {}

    // Whether it moved the wearer in this frame, step by step.
    [[nodiscard]] virtual bool isMoving() const { return false; }
    // The hand that it draws a ray of its own for.
    [[nodiscard]] virtual std::optional<int> aimingHand() const { return {}; }
    // What hangs in the room because of it, as an eye there sees that.
    [[nodiscard]] virtual std::vector<Thing> things(const glm::dvec3&) const { return {}; }
    // What the panel lets the wearer choose.
    [[nodiscard]] virtual std::vector<ToolChoice> choices() const { return {}; }
};

}  // namespace binosplat
