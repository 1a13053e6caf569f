// Section 10.6: the layers of an xrEndFrame, checked, and then converted for the compositor and the log.
#pragma once

#include <vector>

#include "xr/simulated/api/session.h"
#include "xr/simulated/compose/compose.h"
#include "xr/simulated/log/frame_log.h"

namespace simulated {

// XR_ERROR_LAYER_LIMIT_EXCEEDED, XR_ERROR_LAYER_INVALID, XR_ERROR_SWAPCHAIN_RECT_INVALID,
// XR_ERROR_POSE_INVALID ...
void checkLayers(const Session& session, const XrFrameEndInfo& info);

// For layers that passed the check. A layer whose space cannot be located in that state is logged but not
// shown.
std::vector<Layer> makeLayers(const Session& session, const XrFrameEndInfo& info, const State& state);
std::vector<LoggedLayer> loggedLayers(const Session& session, const XrFrameEndInfo& info, const State& state);

}  // namespace simulated
