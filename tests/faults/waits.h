// What frames do that may block: the calls that the thread which shows them makes from one frame to the next.
// BINOSPLAT_FAULT_WAITS=FILE: a line for each frame, its number from 0 and how many calls of which kind it
// made: "7 memory 2 queue 1". A frame lasts from the xrEndFrame before it to its own, the first one from the
// first xrWaitFrame. What a runtime does while one of its functions is called does not count. This takes both
// layers, Vulkan's and OpenXR's. Without OpenXR's, a frame ends when a window is given a picture, and begins
// with the one before. The kinds are those of `watched`, and waits for a fence, signalled or not, with a
// timeout, if its work was submitted last in this frame ("fence-of-this-frame"), in the one before, so that
// the device runs dry ("fence-of-last-frame"), or by another thread or nobody ("fence-of-others"). A frame
// may wait for what its own thread submitted two frames ago.
#pragma once

#include "tests/faults/parts.h"

#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

namespace binosplat::faults {

inline std::recursive_mutex waits_mutex;
inline std::map<std::string_view, unsigned> waits_of_frame;
inline std::map<VkFence, unsigned> fences_in_frames;  // the frame in which their thread submitted them
inline unsigned frame_now = 0;
inline bool has_runtime = false;
inline thread_local bool shows_frames = false, is_in_runtime = false;

inline std::FILE* waitsFile() {
    static std::FILE* const file = openNamedBy("BINOSPLAT_FAULT_WAITS");
    return file;
}

inline void countWait(std::string_view kind) {
    const std::lock_guard lock(waits_mutex);
    if (shows_frames && !is_in_runtime) { ++waits_of_frame[kind]; }
}

inline void noteFenceSubmitted(VkFence fence) {
    const std::lock_guard lock(waits_mutex);
    fences_in_frames.erase(fence);
    if (shows_frames && !is_in_runtime) { fences_in_frames[fence] = frame_now; }
}

inline void noteFenceWait(VkFence fence, std::uint64_t timeout) {
    const std::lock_guard lock(waits_mutex);
    const auto found = fences_in_frames.find(fence);
    if (timeout == 0 || (found != fences_in_frames.end() && frame_now - found->second > 1)) { return; }
    countWait(found == fences_in_frames.end() ? "fence-of-others"
              : found->second == frame_now    ? "fence-of-this-frame"
                                              : "fence-of-last-frame");
}

inline void endFrame() {
    const std::lock_guard lock(waits_mutex);
    std::fprintf(waitsFile(), "%u", frame_now++);
    for (const auto& [kind, count] : std::exchange(waits_of_frame, {})) {
        std::fprintf(waitsFile(), " %s %u", kind.data(), count);
    }
    std::fprintf(waitsFile(), "\n");
    std::fflush(waitsFile());
}

// A window is given a picture.
inline void notePresented() {
    if (waitsFile() == nullptr || has_runtime) { return; }
    if (std::exchange(shows_frames, true)) { endFrame(); }
}

// A call of OpenXR, in which a runtime may use the device.
template <typename Call>
auto runInRuntime(std::string_view name, const Call& call) {
    if (waitsFile() == nullptr) { return call(); }
    has_runtime = true;
    shows_frames = shows_frames || name == "xrWaitFrame";
    if (name == "xrCreateSwapchain") { countWait("swapchain"); }
    is_in_runtime = true;
    const auto result = call();
    is_in_runtime = false;
    if (name == "xrEndFrame" && result >= 0) { endFrame(); }
    return result;
}

struct Watched {
    template <typename Call, typename... Arguments>
    static auto run(const char* kind, const Call& call, Arguments...) {
        countWait(kind);
        return call();
    }
};

// The same function, of which calls are counted if it is watched.
inline PFN_vkVoidFunction watched(std::string_view name, PFN_vkVoidFunction next) {
    if (waitsFile() == nullptr) { return next; }
#define BINOSPLAT_WATCH(function, kind) \
    if (name == #function) { return Wrapped<&function, Watched>::around(kind, next); }
    BINOSPLAT_WATCH(vkQueueWaitIdle, "queue")
    BINOSPLAT_WATCH(vkDeviceWaitIdle, "device")
    BINOSPLAT_WATCH(vkAllocateMemory, "memory")
    BINOSPLAT_WATCH(vkCreateBuffer, "buffer")
    BINOSPLAT_WATCH(vkCreateImage, "image")
    BINOSPLAT_WATCH(vkCreateShaderModule, "shader-module")
    BINOSPLAT_WATCH(vkCreateComputePipelines, "pipeline")
    BINOSPLAT_WATCH(vkCreateGraphicsPipelines, "pipeline")
    BINOSPLAT_WATCH(vkCreateDescriptorPool, "descriptor-pool")
    BINOSPLAT_WATCH(vkAllocateDescriptorSets, "descriptor-set")
    BINOSPLAT_WATCH(vkCreateSwapchainKHR, "swapchain")
    return next;
}

}  // namespace binosplat::faults
