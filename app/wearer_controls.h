// What the wearer's hands do to the scene about them.
#pragma once

#include "app/overlay_panel.h"
#include "app/placement.h"
#include "xr/input.h"

#include <array>

namespace binosplat {

class WearerControls {
public:
    // Left stick: walk where the head looks. Right stick: turn by 30 degrees at a time, rise and sink. Both hands squeezed: the scene
    // follows them. Menu: the panel comes before the eyes, or goes.
    void update(const std::array<xr::Hand, 2>& hands, const Pose& room_from_head, double step_seconds, OverlayPanel& panel,
                bool& panel_shown, Similarity& scene_from_room);

private:
    bool turned_ = false, menu_ = false;
    std::optional<std::array<glm::dvec3, 2>> held_;  // where both hands were
};

}  // namespace binosplat
