// Which stereo modes this build can render.
#pragma once

#include "engine/frame.h"

#include <string>

namespace binosplat {

// Throws Error (bad input) for a mode that is known but not built in.
Mode frameMode(const std::string& name);

}  // namespace binosplat
