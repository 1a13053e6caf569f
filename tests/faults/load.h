// Frames that take as long as a test says, whatever they take on the device.
// BINOSPLAT_FAULT_LOAD=FRAME:MS[,FRAME:MS...], with FRAME from 0: from that frame on, a frame with as many
// pixels as the first one takes this long; fewer pixels take a proportional share. Anything with a pass
// "present" is a frame.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>

namespace binosplat::faults {

// Whether a test requests this.
bool hasLoad();
// On a device whose timestamps tick every `tick_ns`.
void beginLoad(double tick_ns);
// A replacement for a device function that records something of interest; null for others.
PFN_vkVoidFunction loadFunction(const char* name);
// How many ticks the frame with these timestamps took; empty if it is not a frame, or if the test says
// nothing about it.
std::optional<std::uint64_t> ticksOf(VkQueryPool pool);

}  // namespace binosplat::faults
