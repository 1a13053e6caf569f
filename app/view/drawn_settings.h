// What a frame is drawn with: the wearer's settings, or the part of them for which kernels, images and memory
// are there.
#pragma once

#include "app/view/scene_renderer.h"
#include "app/view/scenes/scene_notes.h"
#include "app/view/settings/view_state.h"

namespace binosplat {

class DrawnSettings {
public:
    // All must outlive this. `load_first`: what is lacking is made at once.
    DrawnSettings(const Context& context, ViewState& state, ShownScene& scenes, SceneRenderer& renderer,
                  bool load_first, Say say, Say log)
        : context_(context),
          state_(state),
          scenes_(scenes),
          renderer_(renderer),
          load_first_(load_first),
          say_(std::move(say)),
          log_(std::move(log)),
          drawn_(state.settings()) {}

    // Of this frame.
    [[nodiscard]] const ViewSettings& get() const { return drawn_; }
    // Prepares a frame with the wearer's settings or, if memory is short, goes back to the previous ones;
    // false: then the scene is not shown in this frame.
    bool prepare(ConnectedHeadset& headset, FrameViews& views, MirrorWindow* window);

private:
    void choose(ConnectedHeadset& headset, const FrameViews& views, bool has_window);
    void prepareDrawn(ConnectedHeadset& headset, FrameViews& views, MirrorWindow* window);

    const Context& context_;
    ViewState& state_;
    ShownScene& scenes_;
    SceneRenderer& renderer_;
    bool load_first_;
    Say say_, log_;
    ViewSettings drawn_;
    bool waits_for_method_ = false;
};

}  // namespace binosplat
