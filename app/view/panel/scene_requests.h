// Which scene is shown, for the panel, and what is requested there about scenes.
#pragma once

#include "app/view/panel/panel_picture.h"
#include "app/view/scenes/scene_notes.h"
#include "app/view/scenes/shown_scene.h"
#include "app/view/scenes/viewpoint_list.h"
#include "app/view/settings/view_state.h"

namespace binosplat {

class SceneRequests {
public:
    // All must outlive this.
    SceneRequests(ViewState& state, ShownScene& scenes, SceneNotes& notes, FileWorker& files,
                  PanelPicture& panel, Say say)
        : state_(state), scenes_(scenes), notes_(notes), files_(files), panel_(panel), say_(std::move(say)) {}

    // In each frame. `other_stays`: the other scene of a comparison is shown without a button being held.
    void fillStatus(bool other_stays, const ViewpointList& viewpoints);
    // All that is requested about scenes, apart from where one stands in them and seeing the other one.
    void follow(const PanelRequests& requests);

private:
    void loadSettings();

    ViewState& state_;
    ShownScene& scenes_;
    SceneNotes& notes_;
    FileWorker& files_;
    PanelPicture& panel_;
    Say say_;
};

}  // namespace binosplat
