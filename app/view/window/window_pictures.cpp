// A Vulkan swapchain without waiting.
#include "app/view/window/window_pictures.h"

#include "app/view/window/window_surface.h"
#include "engine/error.h"
#include "engine/ready.h"

#include <algorithm>
#include <mutex>
#include <utility>

namespace binosplat {

namespace {

constexpr std::uint64_t kLongestWaitNs = 1'000'000'000;  // for a display that has gone away

// Two frames are in flight, and a frame waits for the one before the last: by then everything before that has
// been drawn and shown.
constexpr int kCallsUntilUnused = 4;

}  // namespace

WindowPictures::WindowPictures(const Context& context, vk::raii::SurfaceKHR surface,
                               std::function<glm::uvec2()> window_size_px, bool paced)
    : context_(context),
      surface_(std::move(surface)),
      window_size_px_(std::move(window_size_px)),
      paced_(paced) {
    check(context.physicalDevice().getSurfaceSupportKHR(context.queueFamily(), *surface_) == VK_TRUE,
          "{} cannot show on this display", context.deviceName());
    acquired_fence_ = context.device().createFence({});
    window_px_ = window_size_px_();
    take(make());
}

WindowPictures::~WindowPictures() {
    try {
        context_.waitForQueue();
        if (hold_ != Hold::kPromised) { return; }
        static_cast<void>(context_.device().waitForFences(*acquired_fence_, VK_TRUE, kLongestWaitNs));
    } catch (const vk::SystemError&) {}  // a lost device has no work in flight
}

WindowPictures::Made WindowPictures::make() const {
    const vk::raii::PhysicalDevice& device = context_.physicalDevice();
    const std::optional<vk::SurfaceFormatKHR> format = windowFormat(device.getSurfaceFormatsKHR(*surface_));
    check(format.has_value(), "this display offers no 8-bit UNORM format");
    const auto modes = device.getSurfacePresentModesKHR(*surface_);
    vk::PresentModeKHR mode = vk::PresentModeKHR::eFifo;
    for (const auto better : {vk::PresentModeKHR::eImmediate, vk::PresentModeKHR::eMailbox}) {
        if (!paced_ && std::ranges::find(modes, better) != modes.end()) { mode = better; }
    }
    const auto able = device.getSurfaceCapabilitiesKHR(*surface_);
    check(bool(able.supportedUsageFlags & vk::ImageUsageFlagBits::eTransferDst),
          "this display's images cannot be copied to");
    const auto extent = windowExtent(able, {window_px_.x, window_px_.y});
    if (!extent) { return {}; }
    const std::uint32_t most = able.maxImageCount == 0 ? UINT32_MAX : able.maxImageCount;
    vk::SwapchainCreateInfoKHR info({}, *surface_, std::min(able.minImageCount + 1, most), format->format,
                                    format->colorSpace, *extent, 1, vk::ImageUsageFlagBits::eTransferDst);
    info.preTransform = able.currentTransform;
    info.compositeAlpha = windowAlpha(able.supportedCompositeAlpha);
    info.presentMode = mode;
    info.oldSwapchain = *now_.swapchain;
    Made made{vk::raii::SwapchainKHR(context_.device(), info)};
    made.size_px = {extent->width, extent->height};
    for (const VkImage image : made.swapchain.getImages()) {
        made.images.emplace_back(image);
        made.drawn.push_back(context_.device().createSemaphore({}));
    }
    return made;
}

void WindowPictures::take(Made made) {
    is_stale_ = !*made.swapchain;
    if (is_stale_) { return; }
    old_.emplace_back(std::exchange(now_, std::move(made)), kCallsUntilUnused);
}

bool WindowPictures::isFree() const { return acquired_fence_.getStatus() == vk::Result::eSuccess; }

void WindowPictures::acquire() {
    std::erase_if(old_, [](auto& old) { return --old.second < 0; });
    bool is_new = false;  // then one picture is shown with it, even if the window's size goes on changing
    if (making_.valid()) {
        if (!isReady(making_)) { return; }
        take(making_.get());
        is_new = !is_stale_;
    }
    // A promised image must be free before the next one is acquired, but the headset does not wait for it.
    if (hold_ == Hold::kPromised && isFree()) { takePromised(); }
    if (hold_ == Hold::kPromised) { return; }
    // Not every display reports that its window was resized (Wayland does not).
    is_stale_ = is_stale_ || (!is_new && window_px_ != window_size_px_());
    if (is_stale_) {
        hold_ = Hold::kNone;
        const glm::uvec2 before_px = std::exchange(window_px_, window_size_px_());
        is_remade_ = window_px_ == before_px;
        if (window_px_.x == 0 || window_px_.y == 0) { return; }
        if (!paced_) {
            making_ = std::async(std::launch::async, [this] { return make(); });
            return;
        }
        take(make());
    }
    if (is_stale_ || hold_ == Hold::kOurs) { return; }  // minimized; or still held from a dropped frame
    try {
        const auto [result, index] = now_.swapchain.acquireNextImage(0, {}, *acquired_fence_);
        // No picture is free.
        if (result != vk::Result::eSuccess && result != vk::Result::eSuboptimalKHR) { return; }
        index_ = index;
        hold_ = Hold::kPromised;
    } catch (const vk::OutOfDateKHRError&) {
        is_stale_ = true;
        return;
    }
    if (isFree()) { takePromised(); }
}

void WindowPictures::takePromised() {
    context_.device().resetFences(*acquired_fence_);
    hold_ = Hold::kOurs;
}

void WindowPictures::show() {
    if (hold_ != Hold::kOurs) { return; }
    hold_ = Hold::kNone;
    const vk::SwapchainKHR swapchain = *now_.swapchain;
    const vk::Semaphore drawn = *now_.drawn[index_];
    try {
        const std::lock_guard lock(context_.queueMutex());
        const auto result = context_.queue().presentKHR(vk::PresentInfoKHR(drawn, swapchain, index_));
        is_stale_ = result == vk::Result::eSuboptimalKHR && !is_remade_;
        is_remade_ = is_remade_ && result == vk::Result::eSuboptimalKHR;
    } catch (const vk::OutOfDateKHRError&) { is_stale_ = true; }
}

}  // namespace binosplat
