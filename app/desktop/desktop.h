// `binosplat view` without a headset: a scene in a window.
#pragma once

#include "app/options/options.h"
#include "app/view/settings/view_settings.h"

namespace binosplat {

// Runs until the window is closed, or until Ctrl-C or --frames. Throws Error, with exit code 3 if there is no
// display, or no device that can show on it.
void runDesktop(const ViewOptions& options, const ViewSettings& settings);

}  // namespace binosplat
