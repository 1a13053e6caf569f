// What the parts of the layer share, and what each offers to it.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

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

// A device function in which Around::run(label, call, arguments...) decides what happens before and after
// `call`, the next one.
template <auto kFunction, typename Around>
struct Wrapped;
template <typename Result, typename... Arguments, Result(VKAPI_PTR* kFunction)(Arguments...), typename Around>
struct Wrapped<kFunction, Around> {
    static VKAPI_ATTR Result VKAPI_CALL call(Arguments... arguments) {
        return Around::run(
            label, [&] { return reinterpret_cast<decltype(kFunction)>(next)(arguments...); }, arguments...);
    }
    static PFN_vkVoidFunction around(const char* its_label, PFN_vkVoidFunction its_next) {
        label = its_label;
        next = its_next;
        return asVoid(call);
    }
    static inline const char* label = nullptr;
    static inline PFN_vkVoidFunction next = nullptr;
};

// These put something around a function that is not null, or return it as it is.
PFN_vkVoidFunction fallible(std::string_view name, PFN_vkVoidFunction next);  // any.cpp
PFN_vkVoidFunction counted(std::string_view name, PFN_vkVoidFunction next);   // live.cpp

// live.cpp: a device's allocation, which the layer makes itself, and a submission.
void countMemory(VkDeviceMemory memory, VkDeviceSize bytes);
void noteSubmission();
// Objects and allocations at present.
long long liveObjects();

// load.cpp: a device whose timestamps tick every `tick_ns`; a replacement for a device function that records
// something of interest, or null for others; and how many ticks the frame with these timestamps took, empty
// if it is not a frame, or if the test says nothing about it.
void beginLoad(double tick_ns);
PFN_vkVoidFunction loadFunction(const char* name);
std::optional<std::uint64_t> ticksOf(VkQueryPool pool);

}  // namespace binosplat::faults
