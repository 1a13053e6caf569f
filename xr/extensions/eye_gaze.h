// XR_EXT_eye_gaze_interaction: where the wearer looks.
#pragma once

#include "xr/actions.h"

#include <optional>

namespace binosplat::xr {

// Whether the present headset tracks it.
[[nodiscard]] bool findsGaze(const Instance& instance);

class EyeGaze {
public:
    // `actions` outlives this.
    EyeGaze(const Session& session, const Actions& actions) : session_(session), actions_(actions) {}
    // Before the actions are attached, and after it; where the headset does not track the gaze, or that was not requested, nothing.
    void bind();
    void makeSpace();

    // As of the last sync: a direction in the room (our axes). Empty if the headset does not track it reliably, or this program may not
    // see it.
    [[nodiscard]] std::optional<glm::dvec3> find();

private:
    const Session& session_;
    const Actions& actions_;
    XrAction action_ = XR_NULL_HANDLE;  // null: not requested, or not available
    OwnedSpace space_;
};

}  // namespace binosplat::xr
