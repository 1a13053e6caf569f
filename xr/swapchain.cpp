// Making, lending and giving back swapchain images.
#include "xr/swapchain.h"

#include "xr/images.h"
#include "xr/platform.h"

#include <algorithm>
#include <bit>

namespace binosplat::xr {
namespace {

constexpr XrDuration kWaitNs = 100'000'000;
constexpr int kMostWaits = 100;

XrSwapchainUsageFlags flagsOf(ImageUse use) {
    switch (use) {
        case ImageUse::kCopy:
            return XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT | XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
        case ImageUse::kDraw:
            return XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
        case ImageUse::kFar:
            return flagsOf(ImageUse::kDraw) | XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT |
                   XR_SWAPCHAIN_USAGE_SAMPLED_BIT;
        case ImageUse::kDepth:
            break;
    }
    return XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT | XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
}

}  // namespace

vk::Format chooseFormat(const Session& session, std::span<const vk::Format> wanted) {
    const auto formats = listAll<std::int64_t>(
        [&](auto... step) { BINOSPLAT_XR(xrEnumerateSwapchainFormats(session.handle(), step...)); });
    for (const vk::Format format : wanted) {
        if (std::ranges::find(formats, static_cast<std::int64_t>(format)) != formats.end()) { return format; }
    }
    return vk::Format::eUndefined;
}

Swapchain::Swapchain(const Session& session, const std::string& name, glm::uvec2 size_px, vk::Format format,
                     ImageUse use)
    : session_(&session), size_px_(size_px), format_(format) {
    const std::lock_guard lock(session.context().queueMutex());
    auto info = structure<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
    info.usageFlags = flagsOf(use);
    info.format = static_cast<std::int64_t>(format);
    info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
    info.width = size_px.x;
    info.height = size_px.y;
    XrSwapchain made = XR_NULL_HANDLE;
    if (use == ImageUse::kFar && canMakeMips(session.context(), format)) {
        info.mipCount = levels_ = static_cast<std::uint32_t>(std::bit_width(std::max(size_px.x, size_px.y)));
        // Not every runtime has images with mips.
        if (XR_FAILED(xrCreateSwapchain(session.handle(), &info, &made))) { info.mipCount = levels_ = 1; }
    }
    if (levels_ == 1) { BINOSPLAT_XR(xrCreateSwapchain(session.handle(), &info, &made)); }
    swapchain_ = {made, {&session.context(), true}};
    std::uint32_t count = 0;
    BINOSPLAT_XR(xrEnumerateSwapchainImages(handle(), 0, &count, nullptr));
    std::vector<XrSwapchainImageVulkan2KHR> images(
        count, {XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR, nullptr, VK_NULL_HANDLE});
    BINOSPLAT_XR(xrEnumerateSwapchainImages(handle(), count, &count,
                                            reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())));
    for (const XrSwapchainImageVulkan2KHR& image : images) { images_.emplace_back(image.image); }
    check(!images_.empty(), "OpenXR: the swapchain of {} has no images", name);
}

void Swapchain::DestroyIdle::operator()(XrSwapchain swapchain) const {
    const std::lock_guard lock(context->queueMutex());
    try {
        if (waits) { context->queue().waitIdle(); }
    } catch (const vk::SystemError&) {}  // a lost device has no work in flight
    xrDestroySwapchain(swapchain);
}

vk::Image Swapchain::acquire() {
    std::uint32_t index = 0;
    {
        const std::lock_guard lock(session_->context().queueMutex());
        BINOSPLAT_XR(xrAcquireSwapchainImage(handle(), nullptr, &index));
    }
    auto info = structure<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
    info.timeout = kWaitNs;
    int waits = 0;
    while (BINOSPLAT_XR(xrWaitSwapchainImage(handle(), &info)) == XR_TIMEOUT_EXPIRED) {
        if (++waits == kMostWaits) {
            throw Error(ExitCode::kNoDevice, "OpenXR: no swapchain image became free for ten seconds");
        }
    }
    return images_.at(index);
}

void Swapchain::release() {
    const std::lock_guard lock(session_->context().queueMutex());
    BINOSPLAT_XR(xrReleaseSwapchainImage(handle(), nullptr));
}

XrSwapchainSubImage Swapchain::subImage(glm::uvec2 part_px) const {
    return {
        handle(), {{0, 0}, {static_cast<std::int32_t>(part_px.x), static_cast<std::int32_t>(part_px.y)}}, 0};
}

}  // namespace binosplat::xr
