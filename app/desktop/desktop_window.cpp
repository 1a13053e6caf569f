// GLFW's window.
#include "app/desktop/desktop_window.h"

#include "engine/error.h"

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

constexpr int kWindowWidthPx = 1280, kWindowHeightPx = 720;
constexpr int kUsualRefreshHz = 60;
constexpr double kGamepadSeconds = 1.0 / 60.0;  // how often to look at its sticks

DesktopWindow& self(GLFWwindow* window) {
    return *static_cast<DesktopWindow*>(glfwGetWindowUserPointer(window));
}

bool gamepadState(GLFWgamepadstate& state) {
    for (int pad = GLFW_JOYSTICK_1; pad <= GLFW_JOYSTICK_LAST; ++pad) {
        if (glfwGetGamepadState(pad, &state) == GLFW_TRUE) { return true; }
    }
    return false;
}

// The one that shows the middle of the window; the first one if none does, or where windows do not know their
// place (Wayland). Null: there is none.
GLFWmonitor* monitorOf(GLFWwindow* window) {
    glm::ivec2 at(0), size_px(0), low(0);
    glfwGetWindowPos(window, &at.x, &at.y);
    glfwGetWindowSize(window, &size_px.x, &size_px.y);
    const glm::ivec2 middle = at + size_px / 2;
    int count = 0;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        glfwGetMonitorPos(monitors[i], &low.x, &low.y);
        const GLFWvidmode* const mode = glfwGetVideoMode(monitors[i]);
        if (mode == nullptr) { continue; }
        const glm::ivec2 high = low + glm::ivec2(mode->width, mode->height);
        if (glm::all(glm::greaterThanEqual(middle, low)) && glm::all(glm::lessThan(middle, high))) {
            return monitors[i];
        }
    }
    return glfwGetPrimaryMonitor();
}

}  // namespace

HeldMotion motionOfKeys(const std::function<bool(int key)>& is_held) {
    const auto held = [&](int key) { return is_held(key) ? 1.0 : 0.0; };
    return {{held(GLFW_KEY_D) - held(GLFW_KEY_A), held(GLFW_KEY_Q) - held(GLFW_KEY_E),
             held(GLFW_KEY_W) - held(GLFW_KEY_S)},
            {held(GLFW_KEY_RIGHT) - held(GLFW_KEY_LEFT), held(GLFW_KEY_UP) - held(GLFW_KEY_DOWN)},
            is_held(GLFW_KEY_LEFT_SHIFT) || is_held(GLFW_KEY_RIGHT_SHIFT)};
}

HeldMotion motionOfGamepad(const GLFWgamepadstate& pad) {
    const float* const axes = pad.axes;
    return motionOf({{axes[GLFW_GAMEPAD_AXIS_LEFT_X], axes[GLFW_GAMEPAD_AXIS_LEFT_Y]},
                     {axes[GLFW_GAMEPAD_AXIS_RIGHT_X], axes[GLFW_GAMEPAD_AXIS_RIGHT_Y]},
                     axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER],
                     axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER],
                     pad.buttons[GLFW_GAMEPAD_BUTTON_LEFT_BUMPER] == GLFW_PRESS});
}

DesktopWindow::DesktopWindow(const Context& context)
    : context_(context), window_(nullptr, glfwDestroyWindow), sideways_(nullptr, glfwDestroyCursor) {
    const auto require = [](bool condition, const std::string& trouble) {
        if (!condition) { throw Error(ExitCode::kNoDevice, trouble); }
    };
    require(context.hasDeviceExtension(VK_KHR_SWAPCHAIN_EXTENSION_NAME),
            fmt::format("{} cannot show pictures in a window, must be a device with VK_KHR_swapchain",
                        context.deviceName()));
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_.reset(glfwCreateWindow(kWindowWidthPx, kWindowHeightPx, "binosplat", nullptr, nullptr));
    require(window_ != nullptr, "the window does not open");
    glfwSetWindowSizeLimits(window_.get(), 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window_.get(), this);
    sideways_.reset(glfwCreateStandardCursor(GLFW_HRESIZE_CURSOR));
    makePictures();
    listen();
    pinch_ = std::make_unique<Pinch>(window_.get(), glfwPostEmptyEvent);
}

void DesktopWindow::makePictures() {
    pictures_.reset();
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(*context_.instance(), window_.get(), nullptr, &surface);
    if (result != VK_SUCCESS) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("cannot draw in the window: {}", vk::to_string(vk::Result(result))));
    }
    vk::raii::SurfaceKHR owned(context_.instance(), surface);
    if (context_.physicalDevice().getSurfaceSupportKHR(context_.queueFamily(), *owned) != VK_TRUE) {
        throw Error(
            ExitCode::kNoDevice,
            fmt::format("{} cannot show on this display, must be a device that can", context_.deviceName()));
    }
    constexpr bool kPaced = true;
    pictures_ = std::make_unique<WindowPictures>(
        context_, std::move(owned), [this] { return sizePx(); }, kPaced);
}

void DesktopWindow::add(DesktopEvent event) {
    event.place_px = inPixels(cursor_);
    events_.push_back(std::move(event));
}

void DesktopWindow::listen() {
    using Kind = DesktopEvent::Kind;
    GLFWwindow* const window = window_.get();
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
        const bool repeats = action == GLFW_REPEAT && key == GLFW_KEY_BACKSPACE;
        if (action == GLFW_PRESS || repeats) { self(w).add({.kind = Kind::kKey, .code = key}); }
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned letter) {
        self(w).add({.kind = Kind::kText, .code = static_cast<int>(letter)});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
        self(w).add({.kind = action == GLFW_PRESS ? Kind::kPress : Kind::kRelease, .code = button});
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        self(w).cursor_ = {x, y};
        self(w).add({.kind = Kind::kMove});
    });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
        glfwGetCursorPos(w, &self(w).cursor_.x, &self(w).cursor_.y);
        self(w).add({.kind = entered == GLFW_TRUE ? Kind::kMove : Kind::kLeave});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double steps) {
        self(w).add({.kind = Kind::kWheel, .steps = steps});
    });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        if (count == 2) { self(w).add({.kind = Kind::kDrop, .path = paths[0], .second = paths[1]}); }
        if (count == 1 || count > 2) { self(w).add({.kind = Kind::kDrop, .path = paths[count - 1]}); }
    });
    glfwSetWindowPosCallback(window, [](GLFWwindow* w, int, int) { self(w).refresh_hz_ = 0; });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { self(w).is_damaged_ = true; });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { self(w).is_damaged_ = true; });
}

void DesktopWindow::wait(double most_seconds) {
    const double end = glfwGetTime() + most_seconds;
    for (double left = most_seconds; left > 0.0 && events_.empty(); left = end - glfwGetTime()) {
        // A gamepad wakes nobody.
        GLFWgamepadstate pad{};
        const bool looks = gamepadState(pad);
        glfwWaitEventsTimeout(looks ? std::min(left, kGamepadSeconds) : left);
        takePinch();
        if (!looks || heldMotion().isAny() || is_damaged_ || isClosed()) { break; }
    }
    glfwPollEvents();
    takePinch();
}

void DesktopWindow::takePinch() {
    if (const double apart = pinch_->take(); apart != 1.0) {
        add({.kind = DesktopEvent::Kind::kWheel, .steps = wheelStepsOf(apart)});
    }
}

std::vector<DesktopEvent> DesktopWindow::takeEvents() { return std::exchange(events_, {}); }

HeldMotion DesktopWindow::heldMotion() const {
    HeldMotion motion = motionOfKeys([&](int key) { return isHeld(key); });
    if (GLFWgamepadstate pad{}; gamepadState(pad)) {
        const HeldMotion held_there = motionOfGamepad(pad);
        motion.fly += held_there.fly;
        motion.turn += held_there.turn;
        motion.fast = motion.fast || held_there.fast;
    }
    return motion;
}

bool DesktopWindow::isHeld(int key) const { return glfwGetKey(window_.get(), key) == GLFW_PRESS; }

void DesktopWindow::pointSideways(bool sideways) {
    if (std::exchange(points_sideways_, sideways) == sideways) { return; }
    glfwSetCursor(window_.get(), sideways ? sideways_.get() : nullptr);
}

bool DesktopWindow::isClosed() const { return glfwWindowShouldClose(window_.get()) == GLFW_TRUE; }

bool DesktopWindow::isMinimized() const {
    const glm::uvec2 size_px = sizePx();
    return size_px.x == 0 || size_px.y == 0 ||
           glfwGetWindowAttrib(window_.get(), GLFW_ICONIFIED) == GLFW_TRUE;
}

bool DesktopWindow::takeDamage() { return std::exchange(is_damaged_, false); }

glm::uvec2 DesktopWindow::sizePx() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_.get(), &width, &height);
    return {width, height};
}

double DesktopWindow::scale() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_.get(), &x, &y);
    return std::max(static_cast<double>(y), 0.1);
}

glm::dvec2 DesktopWindow::inPixels(const glm::dvec2& place) const {
    glm::ivec2 size(0);
    glfwGetWindowSize(window_.get(), &size.x, &size.y);
    return place * glm::dvec2(sizePx()) / glm::dvec2(glm::max(size, glm::ivec2(1)));
}

double DesktopWindow::refreshHz() {
    if (refresh_hz_ == 0) {
        GLFWmonitor* const monitor = monitorOf(window_.get());
        const GLFWvidmode* const mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
        refresh_hz_ = mode != nullptr && mode->refreshRate > 0 ? mode->refreshRate : kUsualRefreshHz;
    }
    return refresh_hz_;
}

void DesktopWindow::setTitle(const std::string& title) {
    if (std::exchange(title_, title) != title) { glfwSetWindowTitle(window_.get(), title.c_str()); }
}

bool DesktopWindow::toggleFullScreen() {
    GLFWwindow* const window = window_.get();
    glm::ivec4& before = before_full_screen_;
    if (glfwGetWindowMonitor(window) != nullptr) {
        glfwSetWindowMonitor(window, nullptr, before.x, before.y, before.z, before.w, GLFW_DONT_CARE);
        return false;
    }
    GLFWmonitor* const monitor = monitorOf(window);
    if (monitor == nullptr) { return false; }
    glfwGetWindowPos(window, &before.x, &before.y);
    glfwGetWindowSize(window, &before.z, &before.w);
    const GLFWvidmode& mode = *glfwGetVideoMode(monitor);
    glfwSetWindowMonitor(window, monitor, 0, 0, mode.width, mode.height, mode.refreshRate);
    return true;
}

bool DesktopWindow::show(const std::function<void(vk::Image window, vk::Semaphore drawn)>& draw) {
    for (int attempt = 0;; ++attempt) {
        try {
            pictures_->acquire();
            if (!pictures_->current()) { return false; }
            draw(pictures_->current(), pictures_->drawn());
            pictures_->show();
            return true;
        } catch (const vk::SurfaceLostKHRError& error) {
            if (attempt > 0) {
                throw Error(ExitCode::kNoDevice, fmt::format("the display is gone: {}", error.what()));
            }
            makePictures();
        }
    }
}

}  // namespace binosplat
