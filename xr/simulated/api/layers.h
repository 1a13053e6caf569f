// Section 10.6: the layers of an xrEndFrame, checked, and then as the compositor and the log want them.
#pragma once

#include <vector>

#include "xr/simulated/api/session.h"
#include "xr/simulated/compose/compose.h"
#include "xr/simulated/log/frame_log.h"

namespace simulated {

// XR_ERROR_LAYER_LIMIT_EXCEEDED, XR_ERROR_LAYER_INVALID, XR_ERROR_SWAPCHAIN_RECT_INVALID, XR_ERROR_POSE_INVALID ...
void checkLayers(const Session& session, const XrFrameEndInfo& info);

// Of layers that passed the check. A layer whose space is not located at that state is not shown, but logged.
std::vector<Layer> makeLayers(const Session& session, const XrFrameEndInfo& info, const State& state);
std::vector<LoggedLayer> loggedLayers(const Session& session, const XrFrameEndInfo& info, const State& state);

}  // namespace simulated
