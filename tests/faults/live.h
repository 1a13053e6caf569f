// What of a device is alive: objects, device memory and the host's heap, counted by the layer while a program runs.
// BINOSPLAT_FAULT_LIVE=FILE: a line for every tenth submission: "submissions objects device-bytes heap-bytes resident-bytes kernels-made",
// the objects and the device's bytes as the least and the most since the line before: "10 120-140 5242880-6291456 1048576 3145728 24".
// BINOSPLAT_FAULT_READ=FILE: how many bytes the program has read of files when it lets go of the layer.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdio>
#include <cstdlib>

namespace binosplat::faults {

// The file that an environment variable names; null: not set.
inline std::FILE* openNamedBy(const char* variable) {
    const char* const name = std::getenv(variable);
    return name != nullptr ? std::fopen(name, "w") : nullptr;
}

// The one device of a process, and where the next layer's functions of it are found.
inline VkDevice the_device = VK_NULL_HANDLE;
inline PFN_vkGetDeviceProcAddr device_next = nullptr;
#define BINOSPLAT_NEXT(function) \
    reinterpret_cast<decltype(&function)>(binosplat::faults::device_next(binosplat::faults::the_device, #function))

template <typename Function>
PFN_vkVoidFunction asVoid(Function* function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

// Whether the counts are wanted.
bool countsLive();
// A function of the device that makes or destroys something; null: it does neither.
PFN_vkVoidFunction countingFunction(const char* name);
// Objects and allocations at present.
long long liveObjects();
// For a call that the layer makes itself.
void countMemory(VkDeviceMemory memory, VkDeviceSize bytes);
void noteSubmission();

}  // namespace binosplat::faults
