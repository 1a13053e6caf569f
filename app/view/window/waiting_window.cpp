// Only GLFW: drawing needs a device, which the missing headset must choose first.
#include "app/view/window/waiting_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <thread>

namespace binosplat {

WaitingWindow::WaitingWindow() : has_glfw_(glfwInit() == GLFW_TRUE) {
    if (!has_glfw_) { return; }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ =
        glfwCreateWindow(480, 120, "binosplat is waiting for a headset (Escape to stop)", nullptr, nullptr);
    if (window_ == nullptr) { return; }
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
        if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) {
            static_cast<WaitingWindow*>(glfwGetWindowUserPointer(window))->escaped_ = true;
        }
    });
}

WaitingWindow::~WaitingWindow() {
    if (window_ != nullptr) { glfwDestroyWindow(window_); }
    if (has_glfw_) { glfwTerminate(); }
}

bool WaitingWindow::wait(std::chrono::milliseconds most) {
    if (window_ == nullptr) {
        std::this_thread::sleep_for(most);
        return false;
    }
    glfwWaitEventsTimeout(std::chrono::duration<double>(most).count());
    return escaped_ || glfwWindowShouldClose(window_) == GLFW_TRUE;
}

}  // namespace binosplat
