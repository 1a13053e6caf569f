// Choosing the simulated headset before OpenXR is asked for one.
#pragma once

#include "app/options/options.h"

namespace binosplat {

// Points the OpenXR loader at the runtime beside this program, and the runtime at the script. Pictures go to
// options.out or, if there is no display, to out/view; then `options` is set to that, and for a headset
// without a script to a limited number of frames. Throws Error (exit code 3) if the runtime is missing; a
// missing script is bad input.
void simulateHeadset(ViewOptions& options);

}  // namespace binosplat
