// The main thread's part of the window: GLFW and its events, which may hold that thread up for as long as
// somebody drags the window.
#pragma once

#include <vulkan/vulkan.h>

#include <glm/glm.hpp>

#include <atomic>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

struct GLFWwindow;

namespace binosplat {

class Context;

// GLFW, if there is a display. Must come before the Vulkan instance, which needs its extensions.
class WindowSystem {
public:
    // Null if there is no display, or none that Vulkan can show on.
    static std::unique_ptr<WindowSystem> find();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;
    ~WindowSystem();

    [[nodiscard]] static std::vector<const char*> instanceExtensions();
    // Why find() found none, in a line for the user.
    [[nodiscard]] static std::string whyNone();

private:
    WindowSystem() = default;
};

// The state of the window, and what has happened to it since the last call. Keys and buttons are GLFW's.
struct WindowEvents {
    std::vector<int> pressed;    // keys, in their order
    std::set<int> down;          // keys, even if released since
    std::set<int> buttons_down;  // of the mouse, likewise
    glm::dvec2 cursor{0.0};      // as a share of the window
    bool is_hovered = false;     // the mouse is over it, and no other window between
    double wheel = 0.0;          // steps upwards
    std::string dropped;         // the last file dropped on it
    glm::uvec2 size_px{0, 0};    // of its pictures
    bool quit = false;           // its close button was pressed
};

class EventWindow {
public:
    // Throws Error if it does not open.
    explicit EventWindow(glm::ivec2 size);
    EventWindow(const EventWindow&) = delete;
    EventWindow& operator=(const EventWindow&) = delete;
    ~EventWindow();

    // For the main thread, like the constructor and the destructor: handles what happens, until end().
    void run();
    // Once, waiting at most this long.
    void handle(double most_seconds);

    // For any thread: what has happened since the last call.
    [[nodiscard]] WindowEvents take();
    [[nodiscard]] glm::uvec2 sizePx() const;
    // Destroy it before close(). Throws Error if drawing in the window is impossible.
    [[nodiscard]] VkSurfaceKHR surface(const Context& context) const;
    // The window goes away soon afterwards.
    void close();
    // run() returns soon afterwards.
    void end();

private:
    void look();

    std::unique_ptr<GLFWwindow, void (*)(GLFWwindow*)> window_;
    std::atomic<bool> closes_ = false, ends_ = false;
    mutable std::mutex mutex_;
    WindowEvents events_;
    std::set<int> held_, buttons_held_;
};

}  // namespace binosplat
