// Section 10.1: swapchains on the application's device, with as many images as the script says. Images are
// acquired in the script's order, and waited for and released oldest first.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <vector>

#include "xr/simulated/api/device.h"
#include "xr/simulated/api/handles.h"

namespace simulated {

struct Swapchain : SessionChild {
    using Handle = XrSwapchain;
    using SessionChild::SessionChild;

    ImageInfo info;
    bool is_static = false;
    std::vector<std::unique_ptr<DeviceImage>> images;
    std::vector<bool> is_prepared;
    // Acquired and not released, oldest first; and whether the oldest was waited for.
    std::deque<std::uint32_t> acquired;
    bool is_oldest_waited = false;
    std::uint64_t acquisitions = 0;
    // The index of the image to acquire next, in the script's order: one that the application does not hold.
    [[nodiscard]] std::uint32_t nextImage() const;
    // The compositor's input: the image that was released last, and its texels once they were requested.
    bool has_released = false;
    std::uint32_t released_index = 0;
    bool has_texels = false;
    std::vector<std::byte> released_texels;
};

// XR_ERROR_HANDLE_INVALID also for a swapchain of another session.
Swapchain& getSwapchain(const Session& session, XrSwapchain swapchain);

// Reads the last released image back, if that was not done yet. Only in calls that may use the application's
// queue.
void fetchTexels(Swapchain& swapchain);

}  // namespace simulated
