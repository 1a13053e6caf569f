// XR_KHR_vulkan_enable2: the runtime makes the Vulkan instance and the device that it shares with the
// program.
#pragma once

#include "engine/gpu/context.h"
#include "xr/instance.h"
#include "xr/platform.h"

namespace binosplat::xr {

// Lets Context open instance and device through this runtime. Valid as long as `instance`.
[[nodiscard]] DeviceMaker deviceMaker(const Instance& instance);

// Throws Error (exit code 3) if the current headset is not on the device of `context`.
void requireSameDevice(const Instance& instance, const Context& context);

// For a session.
[[nodiscard]] XrGraphicsBindingVulkan2KHR graphicsBinding(const Context& context);

}  // namespace binosplat::xr
