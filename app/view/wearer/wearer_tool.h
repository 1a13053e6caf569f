// The wearer's tools: walking, teleporting, turning, holding the scene.
#pragma once

#include "app/view/room/arc_picture.h"
#include "app/view/room/panel_in_room.h"
#include "app/view/room/scene_probe.h"
#include "app/view/settings/view_state.h"
#include "xr/input.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace binosplat {

// If the runtime does not know the floor: its distance below the head of a wearer who stands at the start.
inline constexpr double kUsualFloorMetres = 1.6;
// How far wearers step up or down.
inline constexpr double kStepMetres = 0.35;

// The floor of a scene: its height along `up`, in scene units.
struct SceneFloor {
    glm::dvec3 up;
    double height;
};

// The wearer in a frame.
struct WearerNow {
    std::array<xr::Hand, 2> hands;
    Pose room_from_head;
    std::optional<double> floor_m;  // the floor's y in the room, if the runtime knows
    double step_seconds = 0.0;
    std::array<PathSeen, 2> paths{};  // of the hands' arcs a moment ago, and how they hit the scene
    // What was seen a moment ago where the ground may be, in scene coordinates.
    std::vector<glm::dvec3> ground_scene{};
    // If it is known; earlier tools may have moved the room in this frame.
    std::optional<SceneFloor> scene_floor{};
    bool measures = false;  // clicks away from the panel are ends of a distance
};

// A widget of a tool: a choice of two after `words`, or a check box if there are no names.
struct ToolChoice {
    const char* words;
    std::array<const char*, 2> names;  // for false and true; null: none
    bool ViewSettings::*chosen;
};

class WearerTool {
public:
    virtual ~WearerTool() = default;

    // Once per frame, after the panel has followed the hands.
    virtual void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) = 0;
    // The room's origin has moved, so whatever is held is held from its new place.
    virtual void letGo() {}

    // True if it moved the wearer continuously in this frame.
    [[nodiscard]] virtual bool isMoving() const { return false; }
    // The hand for which it draws a ray of its own.
    [[nodiscard]] virtual std::optional<int> aimingHand() const { return {}; }
    // The arc that is drawn for that hand, in the room; null: none.
    [[nodiscard]] virtual const Arc* arc() const { return nullptr; }
    // The tool's things in the room, as an eye at that place sees them.
    [[nodiscard]] virtual std::vector<Thing> things(const glm::dvec3&) const { return {}; }
    // The tool's choices on the panel.
    [[nodiscard]] virtual std::vector<ToolChoice> choices() const { return {}; }
};

}  // namespace binosplat
