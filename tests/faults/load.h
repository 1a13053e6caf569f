// Frames that take as long as a test says, whatever the device makes of them.
// BINOSPLAT_FAULT_LOAD=FRAME:MS[,FRAME:MS...], by FRAME from 0: from that frame on, a frame of as many pixels as the first one takes this
// time; fewer pixels take their share of it. Frames are what has a pass "present".
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>

namespace binosplat::faults {

// Whether a test says so.
bool hasLoad();
// On a device whose timestamps tick every `tick_ns`.
void beginLoad(double tick_ns);
// A function of the device that records something of interest; null: it does not.
PFN_vkVoidFunction loadFunction(const char* name);
// How many ticks the frame with these timestamps took; empty if it is not a frame, or the test says nothing
// about it.
std::optional<std::uint64_t> ticksOf(VkQueryPool pool);

}  // namespace binosplat::faults
