// What the wearer's hands do to the scene about them.
#pragma once

#include "app/view/room/panel_in_room.h"
#include "app/view/settings/view_state.h"
#include "app/view/wearer/teleport.h"
#include "xr/input.h"

#include <array>
#include <optional>

namespace binosplat {

// The wearer in a frame.
struct WearerNow {
    std::array<xr::Hand, 2> hands;
    Pose room_from_head;
    std::optional<double> floor_m;  // its y in the room, where the runtime knows
    double step_seconds = 0.0;
};

class WearerControls {
public:
    // Left stick: walk where the head looks. Right stick: turn by 30 degrees at a time, or smoothly, rise and sink. A hand squeezed: the
    // scene moves with it; both: it turns and grows with them, too. Menu: the panel comes before the eyes, or goes. Where the wearer
    // teleports, the left stick ahead or a trigger away from the panel aims at the floor, and letting go moves there. The stick of the hand
    // that points at the panel scrolls there instead, and moves nobody.
    void update(const WearerNow& now, PanelInRoom& panel, ViewState& state);

    // The room begins elsewhere now: what hands hold they hold from there on.
    void letGo() { held_ = {}; }

    // To the next viewpoint where the right stick was pressed in just now, and back where the left one was.
    [[nodiscard]] int viewpointStep() const { return viewpoint_step_; }
    // Whether a hand pressed just now what lets a scene play or rest.
    [[nodiscard]] bool playPressed() const { return play_pressed_; }

    // Whether sticks moved the wearer in this frame.
    [[nodiscard]] bool isMoving() const { return moves_; }
    // The hand that aims at the floor, and where it would bring the wearer.
    [[nodiscard]] std::optional<int> aimingHand() const { return aiming_; }
    [[nodiscard]] const TeleportAim& teleportAim() const { return teleport_; }

private:
    void walk(const WearerNow& now, const PanelInRoom& panel, ViewState& state);
    void teleport(const WearerNow& now, const PanelInRoom& panel, ViewState& state);
    void turn(const WearerNow& now, const PanelInRoom& panel, ViewState& state);
    void hold(const WearerNow& now, const PanelInRoom& panel, ViewState& state);

    bool turned_ = false, menu_ = false, moves_ = false, play_ = false, play_pressed_ = false;
    std::array<std::optional<glm::dvec3>, 2> held_;  // where the hands were that hold the scene
    std::optional<int> aiming_;
    TeleportAim teleport_;
    std::array<bool, 2> stick_presses_{};
    int viewpoint_step_ = 0;
};

}  // namespace binosplat
