// What the wearer sees in the room apart from the panel: hands, rays and arcs, a line of text, the vignette,
// and the dark from which a view comes after a jump.
#pragma once

#include "app/view/headset/connected_headset.h"
#include "app/view/message_line.h"
#include "app/view/room/fade.h"
#include "app/view/room/panel_in_room.h"
#include "app/view/room/vignette.h"
#include "app/view/scene_pointing.h"
#include "app/view/wearer/wearer_controls.h"

namespace binosplat {

class SeenInRoom {
public:
    // See FirstSteps.
    SeenInRoom(FileWorker& files, FirstStepsShown shown) : message_line_(files, shown) {}

    // In front of the eyes.
    void say(const std::string& message) { message_line_.say(message); }
    // For this frame, whose eyes see `views`; hands that feel the panel pulse.
    void choose(ConnectedHeadset& headset, const WearerNow& wearer, const WearerControls& controls,
                const PanelInRoom& panel, const ScenePointing& pointing, const ViewSettings& settings,
                const std::array<xr::EyeView, 2>& views);
    // What is seen from now on has changed by more than a place.
    void beginView() { is_new_view_ = true; }
    // It is the first that is seen: there was nothing to jump from.
    void beginFirstView() { is_new_view_ = false, fade_ = {}; }
    // After the frame is recorded: `placed` is where the room lies in the scene; `was_cut_short`: then the
    // view fades in, too.
    void darken(ConnectedHeadset& headset, const Similarity& placed, const Pose& room_from_head,
                bool was_cut_short, double step_seconds, const std::array<xr::EyeView, 2>& views);

private:
    MessageLine message_line_;
    Vignette vignette_;
    Fade fade_;
    bool is_new_view_ = false;
};

}  // namespace binosplat
