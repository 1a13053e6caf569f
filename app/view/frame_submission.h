// What the runtime is told to show: the eyes' pictures, what is in the room, and the panel; without what it
// refuses.
#pragma once

#include "app/view/headset/taken_layers.h"
#include "app/view/room/panel_in_room.h"
#include "app/view/scene_renderer.h"
#include "app/view/scenes/scene_notes.h"
#include "app/view/settings/view_state.h"

namespace binosplat {

class FrameSubmission {
public:
    // All must outlive this. `near_m`: of the eyes' pictures.
    FrameSubmission(xr::Troubles& troubles, ViewState& state, SceneRenderer& renderer, double near_m, Say log)
        : troubles_(troubles), state_(state), renderer_(renderer), near_m_(near_m), log_(std::move(log)) {}

    // Ends the frame, whose images are released. `panel`: null if it is not shown. If both eyes share the
    // picture of `only_eye`, both use its pose and angles. What the runtime refuses is said, and is not shown
    // any more; throws Error if that is the eyes' pictures.
    void end(ConnectedHeadset& headset, const FrameViews& views, const PanelInRoom* panel,
             std::optional<int> only_eye);

private:
    void goOnWith(ConnectedHeadset& headset, const LayersWanted& taken, bool has_panel, bool has_room,
                  const std::vector<const char*>& things, const std::string& refusal);
    void addEyes(xr::Layers& layers, const ConnectedHeadset& headset, const FrameViews& views,
                 std::optional<int> only_eye, bool see_through) const;

    xr::Troubles& troubles_;
    ViewState& state_;
    SceneRenderer& renderer_;
    double near_m_;
    Say log_;
};

}  // namespace binosplat
