// `binosplat view`: a scene in a headset.
#pragma once

#include "app/options/options.h"

namespace binosplat {

// Throws Error.
void runView(const ViewOptions& options);

}  // namespace binosplat
