// A window while there is no headset, so that Escape and its cross can end the wait.
#pragma once

#include <chrono>

struct GLFWwindow;

namespace binosplat {

class WaitingWindow {
public:
    // No window, and nothing else, where there is no display.
    WaitingWindow();
    WaitingWindow(const WaitingWindow&) = delete;
    WaitingWindow& operator=(const WaitingWindow&) = delete;
    ~WaitingWindow();

    // Returns after that time at the latest; whether whoever waits has had enough.
    [[nodiscard]] bool wait(std::chrono::milliseconds most);

private:
    bool has_glfw_ = false, escaped_ = false;
    GLFWwindow* window_ = nullptr;
};

}  // namespace binosplat
