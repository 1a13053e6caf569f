// What is alive on a device: objects, device memory and the host's heap, counted by the layer while a program
// runs.
// BINOSPLAT_FAULT_LIVE=FILE: a line for every tenth submission: "submissions objects device-bytes heap-bytes
// resident-bytes kernels-made". The objects and the device's bytes are given as the minimum and maximum since
// the line before: "10 120-140 5242880-6291456 1048576 3145728 24".
// BINOSPLAT_FAULT_READ=FILE: how many bytes the program has read from files when it unloads the layer.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdio>
#include <cstdlib>

namespace binosplat::faults {

// The file that an environment variable names; null if it is not set.
inline std::FILE* openNamedBy(const char* variable) {
    const char* const name = std::getenv(variable);
    return name != nullptr ? std::fopen(name, "w") : nullptr;
}

// The only device of a process, and where to find the next layer's functions for it.
inline VkDevice the_device = VK_NULL_HANDLE;
inline PFN_vkGetDeviceProcAddr device_next = nullptr;
#define BINOSPLAT_NEXT(function)           \
    reinterpret_cast<decltype(&function)>( \
        binosplat::faults::device_next(binosplat::faults::the_device, #function))

template <typename Function>
PFN_vkVoidFunction asVoid(Function* function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

// Whether the counts are requested.
bool countsLive();
// A device function that creates or destroys something; null if it does neither.
PFN_vkVoidFunction countingFunction(const char* name);
// Objects and allocations at present.
long long liveObjects();
// For a call that the layer makes itself.
void countMemory(VkDeviceMemory memory, VkDeviceSize bytes);
void noteSubmission();

}  // namespace binosplat::faults
