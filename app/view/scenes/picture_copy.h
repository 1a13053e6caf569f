// A copy of what a frame shows, for the list of scenes: read three frames later, so that no frame waits for
// it.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/frame_buffers.h"
#include "engine/picture/image.h"

#include <functional>

namespace binosplat {

class PictureCopy {
public:
    // Allocates its memory.
    explicit PictureCopy(const Context& context);

    // Call once before each frame, beginning with the first one that is to be copied. True, once, when the
    // copy has arrived or that frame was not drawn: then the next call begins anew.
    [[nodiscard]] bool ask();
    // Within that frame's commands, after its pictures; may be repeated. `picture` is that of `eye`, of which
    // `view` sees a part.
    void record(Commands& commands, const Picture& picture, const Eye& eye, const Eye& view);
    // It is no longer wanted: the next call of ask() begins anew.
    void drop() { frames_ = 0; }
    // What the view saw, to be made from the copy on any thread; null if there is none.
    [[nodiscard]] std::function<Image()> take();

private:
    [[nodiscard]] bool isAsked() const { return frames_ == 1; }

    Buffer rows_;
    Eye eye_, view_;  // the first of what was copied
    bool half_floats_ = false, is_recorded_ = false;
    int frames_ = 0;  // since it was asked for; 0: it was not
};

}  // namespace binosplat
