// What the wearer's hands and eyes do in a frame: tools and buttons, pointing at the scene, gaze.
#pragma once

#include "app/view/scene_exchange.h"
#include "app/view/seen_in_room.h"
#include "app/view/wearer/gaze_follower.h"

namespace binosplat {

class WearerActions {
public:
    // All must outlive this.
    WearerActions(ViewState& state, ShownScene& scenes, WearerPlace& place, SceneExchange& exchange,
                  ScenePointing& pointing, Panel& panel, SeenInRoom& seen)
        : state_(state),
          scenes_(scenes),
          place_(place),
          exchange_(exchange),
          pointing_(pointing),
          panel_(panel),
          seen_(seen) {}

    // Does what the input asks for, sets the gazes of `views`, and chooses what is seen in the room.
    void take(ConnectedHeadset& headset, FrameViews& views);
    // The wearer has jumped: whatever is held is held from its new place.
    void letGo() { controls_.letGo(); }
    // Another scene is shown.
    void beginScene() { pointing_.forget(), letGo(); }
    // Shows the panel in front of the head, or hides it.
    void togglePanel();
    [[nodiscard]] std::vector<ToolChoice> choices() const { return controls_.choices(); }

private:
    [[nodiscard]] WearerNow wearerNow(ConnectedHeadset& headset, const FrameViews& views);
    void play(ConnectedHeadset& headset);

    ViewState& state_;
    ShownScene& scenes_;
    WearerPlace& place_;
    SceneExchange& exchange_;
    ScenePointing& pointing_;
    Panel& panel_;
    SeenInRoom& seen_;
    WearerControls controls_;
    GazeFollower gaze_;
};

}  // namespace binosplat
