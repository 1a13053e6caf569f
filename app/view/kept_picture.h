// The small picture of a scene, as it was last seen, that is kept for the list of scenes. It is made either
// from what a frame has copied, for which the next scene is held back by some frames, or from the last frame,
// which is then waited for.
#pragma once

#include "app/view/scene_renderer.h"
#include "app/view/scenes/picture_copy.h"
#include "app/view/scenes/scene_notes.h"

namespace binosplat {

class KeptPicture {
public:
    // All must outlive this.
    KeptPicture(const Context& context, const ShownScene& scenes, const SceneRenderer& renderer,
                SceneNotes& notes)
        : context_(context), scenes_(scenes), renderer_(renderer), notes_(notes), copy_(context) {}

    void beginScene() { frames_ = 0; }
    void countFrame() { ++frames_; }
    // Before each frame while the next scene waits: true once the picture is kept, or not worth it.
    [[nodiscard]] bool isKept();
    // Within a frame's commands, after its pictures; may be repeated.
    void record(Commands& commands);
    // Waits for the device.
    void keepAtOnce();

private:
    [[nodiscard]] bool isWorthIt() const;

    const Context& context_;
    const ShownScene& scenes_;
    const SceneRenderer& renderer_;
    SceneNotes& notes_;
    PictureCopy copy_;
    std::uint64_t frames_ = 0;  // of the scene since it was shown, or since its picture was kept
};

}  // namespace binosplat
