// `binosplat view`: a scene in a headset.
#pragma once

#include "app/options/options.h"
#include "app/view/settings/device_defaults.h"

namespace binosplat {

// What the options name, and otherwise what suits the device; a software device holds no frame rate.
ViewSettings startSettings(const ViewOptions& options, bool is_software = false,
                           const DeviceDefaults& device = {});

// Throws Error.
void runView(const ViewOptions& options);

}  // namespace binosplat
