// Which stereo modes this build can render, and the frame's settings out of the options.
#pragma once

#include "app/options.h"
#include "engine/frame.h"

#include <string>

namespace binosplat {

// Throws Error (bad input) for a mode that is known but not built in.
Mode frameMode(const std::string& name);

// The settings of a frame in the named mode; everything else as the options say.
FrameSettings frameSettings(const RunOptions& options, const std::string& mode);

}  // namespace binosplat
