// Two fingers that pinch on a touchpad. GLFW does not report that; X servers with XInput 2.4 do (XWayland,
// too).
#pragma once

#include <functional>
#include <memory>

struct GLFWwindow;

namespace binosplat {

class Pinch {
public:
    // `tell` is called on another thread, once there is something to take.
    Pinch(GLFWwindow* window, std::function<void()> tell);
    Pinch(const Pinch&) = delete;
    Pinch& operator=(const Pinch&) = delete;
    ~Pinch();

    // How many times as far apart the fingers are as at the last call; 1 without a pinch.
    [[nodiscard]] double take();

private:
    class Listener;
    std::unique_ptr<Listener> listener_;  // null: there are no such gestures
};

}  // namespace binosplat
