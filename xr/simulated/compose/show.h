// Composes, saves and logs a frame as the wearer sees it, if SIMULATED_OPENXR_OUT names a folder.
#pragma once

#include "xr/simulated/api/session.h"

namespace simulated {

// For a frame that has passed every check.
void showFrame(Session& session, const XrFrameEndInfo& info, const State& state);
// A separate line in the log for a frame that was refused, or for events that no frame will log.
void logBetween(Session& session, const Refusal* refusal = nullptr);

}  // namespace simulated
