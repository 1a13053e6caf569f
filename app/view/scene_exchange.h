// The scenes of a headset's viewer, frame by frame: when another one is taken, seeing the other one of a
// comparison, and what is said of one that loads while it is shown.
#pragma once

#include "app/view/drawn_settings.h"
#include "app/view/files/picture_writer.h"
#include "app/view/kept_picture.h"
#include "app/view/wearer_place.h"

namespace binosplat {

class SceneExchange {
public:
    // All must outlive this; `place` learns of each scene.
    SceneExchange(ViewState& state, ShownScene& scenes, SceneRenderer& renderer, WearerPlace& place,
                  KeptPicture& kept, SceneNotes& notes, const PictureWriter& writer, Say say, Say log)
        : state_(state),
          scenes_(scenes),
          renderer_(renderer),
          place_(place),
          kept_(kept),
          notes_(notes),
          writer_(writer),
          say_(std::move(say)),
          log_(std::move(log)) {}

    enum class Taken { kNone, kFirst, kAnother };
    // Takes what is loaded: between frames only what they can show without a wait, otherwise `at_once`.
    [[nodiscard]] Taken take(bool at_once);
    // Has frames made for the scene that comes next, as it will be seen from where the wearer is.
    void meetComing(ConnectedHeadset& headset, const ViewSettings& drawn, FrameViews& views);

    // In a comparison: whether the other scene stays in sight, without a button being held.
    [[nodiscard]] bool otherStays() const { return other_stays_; }
    void toggleOther() { other_stays_ = !other_stays_; }
    // Shows the other one, or this one again; true if that is a change.
    [[nodiscard]] bool showOther(bool is_held);
    // Once frames can show it; it goes if they cannot.
    void meetOther(const ConnectedHeadset& headset);

    // Says errors of scenes that load while they are shown and, once, that everything in view is loaded.
    void sayLive();

private:
    void takeOther();
    void sayLive(LoadedScene& scene);

    ViewState& state_;
    ShownScene& scenes_;
    SceneRenderer& renderer_;
    WearerPlace& place_;
    KeptPicture& kept_;
    SceneNotes& notes_;
    const PictureWriter& writer_;
    Say say_, log_;
    bool other_stays_ = false;
    bool said_there_ = false;  // everything in the first view of a streamed scene is loaded
};

}  // namespace binosplat
