// XR_FB_passthrough: the room that the headset's cameras see, as a layer behind the scene.
#pragma once

#include "xr/instance.h"

namespace binosplat::xr {

// The extension is enabled, and this headset passes the room through.
bool findsPassthrough(const Instance& instance);

class Passthrough {
public:
    Passthrough(const Instance& instance, XrSession session) : instance_(instance), session_(session) {}
    Passthrough(const Passthrough&) = delete;
    Passthrough& operator=(const Passthrough&) = delete;

    // Whether the room is to be seen from the next frame on. The cameras are paused while it is not.
    void show(bool shown);
    // For a frame's layers, below all others; null: the room is not seen. It stays as it is until the next
    // call of show().
    [[nodiscard]] const XrCompositionLayerBaseHeader* layer() const;

private:
    void make();
    void run(bool runs) const;

    const Instance& instance_;
    XrSession session_;  // destroying it ends what is made below
    XrPassthroughFB passthrough_ = XR_NULL_HANDLE;
    XrCompositionLayerPassthroughFB layer_{};
    bool is_shown_ = false, fails_ = false;
};

}  // namespace binosplat::xr
