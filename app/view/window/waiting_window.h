// A window while there is no headset, so that Escape or its close button can end the wait.
#pragma once

#include <chrono>

struct GLFWwindow;

namespace binosplat {

class WaitingWindow {
public:
    // Without a display there is no window.
    WaitingWindow();
    WaitingWindow(const WaitingWindow&) = delete;
    WaitingWindow& operator=(const WaitingWindow&) = delete;
    ~WaitingWindow();

    // Returns after that time at the latest; true if the user ended the wait.
    [[nodiscard]] bool wait(std::chrono::milliseconds most);

private:
    bool has_glfw_ = false, escaped_ = false;
    GLFWwindow* window_ = nullptr;
};

}  // namespace binosplat
