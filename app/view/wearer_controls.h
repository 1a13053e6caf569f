// What the wearer's hands do to the scene about them.
#pragma once

#include "app/view/overlay_panel.h"
#include "app/view/placement.h"
#include "app/view/view_settings.h"
#include "xr/input.h"

#include <array>

namespace binosplat {

class WearerControls {
public:
    // Left stick: walk where the head looks. Right stick: turn by 30 degrees at a time, rise and sink. A hand squeezed: the scene moves
    // with it; both: it turns and grows with them, too. Menu: the panel comes before the eyes, or goes.
    void update(const std::array<xr::Hand, 2>& hands, const Pose& room_from_head, double step_seconds, OverlayPanel& panel,
                ViewSettings& settings, Similarity& scene_from_room);

private:
    bool turned_ = false, menu_ = false;
    std::array<std::optional<glm::dvec3>, 2> held_;  // where the hands were that hold the scene
};

}  // namespace binosplat
