// What the eyes see in a headset's frame.
#pragma once

#include "engine/passes/warp_view.h"
#include "xr/session.h"

#include <array>
#include <optional>

namespace binosplat {

// The views of a headset's frame.
struct FrameViews {
    std::array<xr::EyeView, 2> eyes;
    std::array<Pose, 2> room_from_eyes;
    Pose room_from_head;
    std::optional<std::array<xr::EyeView, 2>> insets;  // from the same places, if the headset takes insets
    std::array<std::optional<Gaze>, 2> gazes;          // by Side: where the eyes look, if it matters
    // What the frame's pictures show, in the form that the runtime is told.
    std::array<xr::EyeView, 2> pictures;
};

// The eyes at the time for which the open frame is drawn; empty if the headset cannot tell.
[[nodiscard]] std::optional<FrameViews> locateViews(xr::Session& session);

}  // namespace binosplat
