// XR_EXT_eye_gaze_interaction: where the wearer looks.
#pragma once

#include "xr/actions.h"

#include <optional>

namespace binosplat::xr {

// True if the current headset tracks the gaze.
[[nodiscard]] bool findsGaze(const Instance& instance);

class EyeGaze {
public:
    // `actions` must outlive this.
    EyeGaze(const Session& session, const Actions& actions) : session_(session), actions_(actions) {}
    // bind() comes before the actions are attached, makeSpace() after. Without eye tracking, or if it was not
    // requested, they do nothing.
    void bind();
    void makeSpace();

    // As of the last sync: a direction in the room (our axes). Empty if the headset does not track it
    // reliably, or this program may not see it.
    [[nodiscard]] std::optional<glm::dvec3> find();

private:
    const Session& session_;
    const Actions& actions_;
    XrAction action_ = XR_NULL_HANDLE;  // null: not requested, or not available
    OwnedSpace space_;
};

}  // namespace binosplat::xr
