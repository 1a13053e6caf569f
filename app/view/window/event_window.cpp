// GLFW's events, collected.
#include "app/view/window/event_window.h"

#include "engine/error.h"
#include "engine/gpu/context.h"
#include "engine/platform.h"

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

// The mouse may leave without an event.
constexpr double kLookSeconds = 0.02;

// In its shape, as large as the display allows.
glm::ivec2 fittedToDisplay(glm::ivec2 size) {
    GLFWmonitor* const display = glfwGetPrimaryMonitor();
    if (display == nullptr) { return size; }
    glm::ivec2 place, area;
    glm::vec2 scale(1.0f);  // by which the window will be larger than asked for
    glfwGetMonitorWorkarea(display, &place.x, &place.y, &area.x, &area.y);
    glfwGetMonitorContentScale(display, &scale.x, &scale.y);
    if (area.x <= 0 || area.y <= 0) { return size; }
    const glm::dvec2 shares = glm::dvec2(area) / (glm::dvec2(scale) * glm::dvec2(size));
    return glm::max(glm::ivec2(std::min({1.0, shares.x, shares.y}) * glm::dvec2(size)), 1);
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

std::string WindowSystem::whyNone() {
    const auto valueOf = [](const char* name) {
        const std::string value = environment(name);
        return fmt::format("{} is {}", name, value.empty() ? "not set" : value);
    };
    return fmt::format("no window: no display can be opened that Vulkan can show on ({}, {})",
                       valueOf("DISPLAY"), valueOf("WAYLAND_DISPLAY"));
}

EventWindow::EventWindow(glm::ivec2 size) : window_(nullptr, glfwDestroyWindow) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    const glm::ivec2 fitted = fittedToDisplay(size);
    window_.reset(glfwCreateWindow(fitted.x, fitted.y, "binosplat", nullptr, nullptr));
    check(window_ != nullptr, "the window does not open");
    glfwSetWindowAspectRatio(window_.get(), size.x, size.y);
    glfwSetWindowUserPointer(window_.get(), this);
    static constexpr auto of = [](GLFWwindow* window) -> EventWindow& {
        return *static_cast<EventWindow*>(glfwGetWindowUserPointer(window));
    };
    glfwSetKeyCallback(window_.get(), [](GLFWwindow* window, int key, int, int action, int) {
        EventWindow& me = of(window);
        const std::lock_guard lock(me.mutex_);
        if (action == GLFW_PRESS) {
            me.events_.pressed.push_back(key);
            me.events_.down.insert(key);
            me.held_.insert(key);
        } else if (action == GLFW_RELEASE) {
            me.held_.erase(key);
        }
    });
    glfwSetMouseButtonCallback(window_.get(), [](GLFWwindow* window, int button, int action, int) {
        EventWindow& me = of(window);
        const std::lock_guard lock(me.mutex_);
        if (action == GLFW_PRESS) {
            me.events_.buttons_down.insert(button);
            me.buttons_held_.insert(button);
        } else {
            me.buttons_held_.erase(button);
        }
    });
    glfwSetScrollCallback(window_.get(), [](GLFWwindow* window, double, double steps) {
        const std::lock_guard lock(of(window).mutex_);
        of(window).events_.wheel += steps;
    });
    glfwSetDropCallback(window_.get(), [](GLFWwindow* window, int count, const char** paths) {
        const std::lock_guard lock(of(window).mutex_);
        if (count > 0) { of(window).events_.dropped = paths[count - 1]; }
    });
    look();
}

EventWindow::~EventWindow() = default;

void EventWindow::look() {
    glm::dvec2 cursor;
    glfwGetCursorPos(window_.get(), &cursor.x, &cursor.y);
    glm::ivec2 size, pixels;
    // A compositor may give the window another size than requested.
    glfwGetWindowSize(window_.get(), &size.x, &size.y);
    glfwGetFramebufferSize(window_.get(), &pixels.x, &pixels.y);
    const bool is_hovered = glfwGetWindowAttrib(window_.get(), GLFW_HOVERED) == GLFW_TRUE;
    const bool quit = glfwWindowShouldClose(window_.get()) == GLFW_TRUE;
    const std::lock_guard lock(mutex_);
    events_.cursor = cursor / glm::dvec2(glm::max(size, 1));
    events_.size_px = pixels;
    events_.is_hovered = is_hovered;
    events_.quit = quit;
}

void EventWindow::handle(double most_seconds) {
    glfwWaitEventsTimeout(most_seconds);
    if (closes_) { window_.reset(); }
    if (window_) { look(); }
}

void EventWindow::run() {
    while (!ends_) { handle(kLookSeconds); }
}

WindowEvents EventWindow::take() {
    const std::lock_guard lock(mutex_);
    WindowEvents taken = events_;
    events_.pressed.clear();
    events_.down = held_;
    events_.buttons_down = buttons_held_;
    events_.wheel = 0.0;
    events_.dropped.clear();
    return taken;
}

glm::uvec2 EventWindow::sizePx() const {
    const std::lock_guard lock(mutex_);
    return events_.size_px;
}

VkSurfaceKHR EventWindow::surface(const Context& context) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(*context.instance(), window_.get(), nullptr, &surface);
    check(result == VK_SUCCESS, "cannot draw in the window: {}", vk::to_string(vk::Result(result)));
    return surface;
}

void EventWindow::close() {
    closes_ = true;
    glfwPostEmptyEvent();
}

void EventWindow::end() {
    ends_ = true;
    glfwPostEmptyEvent();
}

}  // namespace binosplat
