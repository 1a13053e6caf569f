// Choosing the simulated headset before OpenXR is asked for one.
#pragma once

#include "app/options/options.h"

namespace binosplat {

// Points the OpenXR loader at the runtime beside this program and the runtime at the script. Pictures go to options.out or, where there
// is no display to watch, to out/view; `options` then says so, and how many frames a headset without a script is worn.
// Throws Error (exit code 3) if the runtime is not there; a script that is missing is bad input.
void simulateHeadset(ViewOptions& options);

}  // namespace binosplat
