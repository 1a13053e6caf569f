// Frames that take as long as a test says, whatever the device makes of them.
// BINOSPLAT_FAULT_LOAD=FRAME:MS/MS[,FRAME:MS/MS...], by FRAME from 0: from that frame on, a frame of as many pixels as the first one takes
// the first time if both eyes are rendered and the second if one is made from the other; fewer pixels take their share of it. Frames are
// what has a pass "present". Where one eye is made from the other, the dominant eye takes half of what rendering both does.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>

namespace binosplat::faults {

// Whether a test says so.
bool hasLoad();
// From now on of this device, whose timestamps tick every `tick_ns`.
void beginLoad(PFN_vkGetDeviceProcAddr next, VkDevice device, double tick_ns);
// A function of the device that records something of interest; null: it does not.
PFN_vkVoidFunction loadFunction(const char* name);
// When each timestamp of a frame comes, in ticks. Two belong to a pass, and nothing lies between two passes; those for both eyes take
// nothing.
struct FrameTicks {
    std::uint64_t both_passes = 0, dominant_passes = 0, dominant_ticks = 0, ticks = 0;
    [[nodiscard]] std::uint64_t at(std::uint64_t stamp, std::uint64_t stamps) const;
};

// Of the frame whose timestamps these are; none if it is no frame, or nobody says.
std::optional<FrameTicks> ticksOf(VkQueryPool pool);

}  // namespace binosplat::faults
