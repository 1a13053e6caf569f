// GLFW, and what is drawn on its window.
#include "app/view/window/mirror_window.h"

#include "app/view/room/sprites.h"
#include "app/view/window/window_drawing.h"
#include "engine/error.h"

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <utility>

namespace binosplat {

namespace {

constexpr int kHeightPx = 720;
constexpr double kRadiansPerPixel = 0.004;

using Layout = vk::ImageLayout;
using Usage = vk::ImageUsageFlagBits;

// Width of the window: a square for the eye, and the panel beside it.
int widthOf(const Canvas& canvas) {
    return kHeightPx + kHeightPx * static_cast<int>(canvas.sizePx().x) / static_cast<int>(canvas.sizePx().y);
}

}  // namespace

std::unique_ptr<WindowSystem> WindowSystem::find() {
    if (glfwInit() != GLFW_TRUE) { return nullptr; }
    std::unique_ptr<WindowSystem> system(new WindowSystem());
    return glfwVulkanSupported() == GLFW_TRUE && !instanceExtensions().empty() ? std::move(system) : nullptr;
}

WindowSystem::~WindowSystem() { glfwTerminate(); }

std::vector<const char*> WindowSystem::instanceExtensions() {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return names == nullptr ? std::vector<const char*>{} : std::vector<const char*>(names, names + count);
}

MirrorWindow::MirrorWindow(const Context& context, const Canvas& canvas)
    : context_(context), canvas_(canvas), window_(nullptr, glfwDestroyWindow) {
    check(context.hasDeviceExtension(VK_KHR_SWAPCHAIN_EXTENSION_NAME), "{} has no window pictures", context.deviceName());
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_.reset(glfwCreateWindow(widthOf(canvas), kHeightPx, "binosplat", nullptr, nullptr));
    check(window_ != nullptr, "the window does not open");
    glfwSetWindowAspectRatio(window_.get(), widthOf(canvas), kHeightPx);
    // Presses released before the next frame still count once.
    glfwSetInputMode(window_.get(), GLFW_STICKY_KEYS, GLFW_TRUE);
    glfwSetInputMode(window_.get(), GLFW_STICKY_MOUSE_BUTTONS, GLFW_TRUE);
    glfwSetWindowUserPointer(window_.get(), this);
    glfwSetKeyCallback(window_.get(), [](GLFWwindow* window, int key, int, int action, int) {
        if (action == GLFW_PRESS) { static_cast<MirrorWindow*>(glfwGetWindowUserPointer(window))->pressed_.push_back(key); }
    });
    glfwSetScrollCallback(window_.get(), [](GLFWwindow* window, double, double steps) {
        static_cast<MirrorWindow*>(glfwGetWindowUserPointer(window))->wheel_ += steps;
    });
    glfwSetDropCallback(window_.get(), [](GLFWwindow* window, int count, const char** paths) {
        if (count > 0) { static_cast<MirrorWindow*>(glfwGetWindowUserPointer(window))->dropped_ = paths[count - 1]; }
    });
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(*context.instance(), window_.get(), nullptr, &surface);
    check(result == VK_SUCCESS, "the window cannot be drawn on: {}", vk::to_string(vk::Result(result)));
    pictures_ = std::make_unique<WindowPictures>(context, vk::raii::SurfaceKHR(context.instance(), surface), [this] {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_.get(), &width, &height);
        return glm::uvec2(width, height);
    });
}

MirrorWindow::~MirrorWindow() {
    const std::lock_guard lock(context_.queueMutex());
    try {
        context_.device().waitIdle();
    } catch (const vk::SystemError&) {}  // a lost device draws nothing more
}

WindowInput MirrorWindow::poll() {
    glfwPollEvents();
    const auto pressed = [&](int key) { return glfwGetKey(window_.get(), key) == GLFW_PRESS ? 1.0 : 0.0; };
    WindowInput input;
    for (const int key : std::exchange(pressed_, {})) {
        input.toggle_panel ^= key == GLFW_KEY_TAB;
        input.reload_shaders |= key == GLFW_KEY_F5;
        input.recentre |= key == GLFW_KEY_R;
        input.play ^= key == GLFW_KEY_SPACE;
        input.frame_step += (key == GLFW_KEY_PERIOD ? 1 : 0) - (key == GLFW_KEY_COMMA ? 1 : 0);
        input.quit |= key == GLFW_KEY_ESCAPE;
    }
    input.dropped = std::exchange(dropped_, {});
    input.quit |= glfwWindowShouldClose(window_.get()) == GLFW_TRUE;
    input.walk = {pressed(GLFW_KEY_D) - pressed(GLFW_KEY_A), pressed(GLFW_KEY_Q) - pressed(GLFW_KEY_E),
                  pressed(GLFW_KEY_W) - pressed(GLFW_KEY_S)};
    input.turn_rate = pressed(GLFW_KEY_RIGHT) - pressed(GLFW_KEY_LEFT);
    glm::dvec2 cursor;
    glfwGetCursorPos(window_.get(), &cursor.x, &cursor.y);
    // A compositor may give the window another size than requested.
    int width = 0, height = 0;
    glfwGetWindowSize(window_.get(), &width, &height);
    cursor *= glm::dvec2(widthOf(canvas_), kHeightPx) / glm::dvec2(std::max(width, 1), std::max(height, 1));
    const bool down = glfwGetMouseButton(window_.get(), GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    const double scale = static_cast<double>(canvas_.sizePx().y) / kHeightPx;
    const glm::dvec2 place = scale * (cursor - glm::dvec2(kHeightPx, 0.0));
    const glm::dvec2 size(canvas_.sizePx());
    const double wheel = std::exchange(wheel_, 0.0);
    const bool is_over = glm::all(glm::greaterThanEqual(place, glm::dvec2(0.0))) && glm::all(glm::lessThan(place, size));
    // If another window lies above this one, the mouse belongs to that one.
    if (is_over && (down || glfwGetWindowAttrib(window_.get(), GLFW_HOVERED) == GLFW_TRUE)) {
        input.pointer = {place, down, wheel};
        input.uses_panel = cursor != cursor_ || down || was_down_ || wheel != 0.0;
    } else {
        input.wheel = wheel;
        // The picture follows the mouse.
        if (down) { input.turn_rad = kRadiansPerPixel * (cursor_.x - cursor.x); }
        if (glfwGetMouseButton(window_.get(), GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS) {
            input.tilt_rad = kRadiansPerPixel * glm::dvec2(cursor.x - cursor_.x, cursor_.y - cursor.y);
        }
    }
    cursor_ = cursor;
    was_down_ = down;
    return input;
}

void MirrorWindow::keepEye(Commands& commands, const Buffer& pixels, glm::uvec2 size_px, vk::Format format) {
    // Another size than in the previous frame, which is finished by now.
    if (eye_px_ != size_px) {
        eye_px_ = size_px;
        try {
            eye_.reset();
            const vk::Format raw = texelLayoutOf(format).blue_first ? vk::Format::eB8G8R8A8Unorm : vk::Format::eR8G8B8A8Unorm;
            eye_.emplace(context_, "the window's eye", size_px, raw, Usage::eTransferDst | Usage::eTransferSrc | Usage::eColorAttachment);
        } catch (const vk::OutOfDeviceMemoryError&) {
        } catch (const vk::OutOfHostMemoryError&) {
            // The window then shows only the panel: the headset matters more.
        }
    }
    if (!eye_) { return; }
    commands.copyToImage(pixels, *eye_->image, size_px, vk::ImageAspectFlagBits::eColor);
    changeLayout(commands, *eye_->image, Layout::eColorAttachmentOptimal, Layout::eTransferSrcOptimal);
}

void MirrorWindow::record(Commands& commands) {
    const vk::Image target = pictures_->current();
    if (!target) { return; }
    const int width = static_cast<int>(pictures_->sizePx().x), height = static_cast<int>(pictures_->sizePx().y);
    clearWindow(commands, target);
    const int split = std::clamp(width * kHeightPx / widthOf(canvas_), 1, std::max(width - 1, 1));
    const auto show = [&](vk::Image image, glm::uvec2 size_px, const WindowPart& part) {
        blitInto(commands, image, size_px, target, fittedInto(size_px, part));
    };
    if (eye_) { show(*eye_->image, eye_px_, {{0, 0}, {split, height}}); }
    if (split < width) { show(canvas_.image(), canvas_.sizePx(), {{split, 0}, {width - split, height}}); }
    changeLayout(commands, target, Layout::eTransferDstOptimal, Layout::ePresentSrcKHR);
}

}  // namespace binosplat
