// OpenXR's calls with exceptions, a session's states, and the images of an eye.
#pragma once

#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <stdexcept>
#include <string>
#include <vector>

inline void check(XrResult result) {
    if (XR_FAILED(result)) { throw std::runtime_error("OpenXR says " + std::to_string(result)); }
}

template <typename Function>
Function find(XrInstance instance, const char* name) {
    PFN_xrVoidFunction function = nullptr;
    check(xrGetInstanceProcAddr(instance, name, &function));
    return reinterpret_cast<Function>(function);
}

// The images of an eye, one of which OpenXR lends at a time.
struct Swapchain {
    Swapchain(XrSession session, VkFormat format, XrSwapchainUsageFlags usage,
              const XrViewConfigurationView& size) {
        XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
        // binosplat reads what the program drew, and writes the picture with splats in it.
        info.usageFlags = usage | XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
        info.format = format;
        info.width = size.recommendedImageRectWidth;
        info.height = size.recommendedImageRectHeight;
        info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
        check(xrCreateSwapchain(session, &info, &handle));
        std::uint32_t count = 0;
        check(xrEnumerateSwapchainImages(handle, 0, &count, nullptr));
        images.resize(count, {XR_TYPE_SWAPCHAIN_IMAGE_VULKAN_KHR});
        check(xrEnumerateSwapchainImages(handle, count, &count,
                                         reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())));
        sub = {handle, {{0, 0}, {static_cast<int>(info.width), static_cast<int>(info.height)}}, 0};
    }
    VkImage acquire() {
        std::uint32_t index = 0;
        check(xrAcquireSwapchainImage(handle, nullptr, &index));
        XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, XR_INFINITE_DURATION};
        check(xrWaitSwapchainImage(handle, &wait));
        return images[index].image;
    }
    XrSwapchain handle = XR_NULL_HANDLE;
    std::vector<XrSwapchainImageVulkanKHR> images;
    XrSwapchainSubImage sub{};
};

// Begins and ends the session as the runtime asks for it; false once the program is to end.
inline bool followStates(XrInstance xr, XrSession session, bool& runs) {
    XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
    for (; xrPollEvent(xr, &event) == XR_SUCCESS; event = {XR_TYPE_EVENT_DATA_BUFFER}) {
        if (event.type != XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) { continue; }
        const auto& change = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
        if (change.state == XR_SESSION_STATE_EXITING) { return false; }
        if (change.state == XR_SESSION_STATE_READY) {
            const XrSessionBeginInfo begin{XR_TYPE_SESSION_BEGIN_INFO, nullptr,
                                           XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
            check(xrBeginSession(session, &begin));
            runs = true;
        } else if (change.state == XR_SESSION_STATE_STOPPING) {
            check(xrEndSession(session));
            runs = false;
        }
    }
    return true;
}
