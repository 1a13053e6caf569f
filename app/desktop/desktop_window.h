// A window with its mouse, keys, gamepad and pictures.
#pragma once

#include "app/desktop/camera_mover.h"
#include "app/desktop/pinch.h"
#include "app/view/window/window_pictures.h"

#include <glm/glm.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;
struct GLFWcursor;
struct GLFWgamepadstate;

namespace binosplat {

// User input, in order. Places are in the window's pixels, from its top left corner.
struct DesktopEvent {
    enum class Kind { kMove, kPress, kRelease, kWheel, kKey, kText, kDrop, kLeave } kind;
    glm::dvec2 place_px{0.0};
    int code = 0;          // GLFW's number of a key or a button; a letter that was typed
    double steps = 0.0;    // of the wheel, away from the user; a pinch turns it, too
    std::string path{};    // that was dropped
    std::string second{};  // that was dropped with it, if these were two
    [[nodiscard]] bool isLeft() const { return code == 0; }  // of a button
};

// What held keys (GLFW's) do.
HeldMotion motionOfKeys(const std::function<bool(int key)>& is_held);
// What a gamepad's sticks, triggers and left bumper do.
HeldMotion motionOfGamepad(const GLFWgamepadstate& pad);

class DesktopWindow {
public:
    // Throws Error (exit code 3) if the device cannot show on the display.
    explicit DesktopWindow(const Context& context);
    DesktopWindow(const DesktopWindow&) = delete;
    DesktopWindow& operator=(const DesktopWindow&) = delete;

    // Returns after this time, or once something happens.
    void wait(double most_seconds);
    // Since the last call.
    [[nodiscard]] std::vector<DesktopEvent> takeEvents();
    [[nodiscard]] HeldMotion heldMotion() const;
    [[nodiscard]] bool isHeld(int key) const;
    [[nodiscard]] bool isClosed() const;
    // Nobody sees it.
    [[nodiscard]] bool isMinimized() const;
    // True once after the window was uncovered or has changed its size.
    [[nodiscard]] bool takeDamage();
    [[nodiscard]] glm::uvec2 sizePx() const;
    // Ratio of its pixels to those in which desktops count.
    [[nodiscard]] double scale() const;
    // Pictures that its monitor shows in a second.
    [[nodiscard]] double refreshHz();
    void setTitle(const std::string& title);
    // True if it fills the screen from now on.
    bool toggleFullScreen();
    // The pointer is the one for what can be dragged to both sides.
    void pointSideways(bool sideways);

    // Shows what `draw` records, with the image to draw on, once a picture is free; false if none is, or if
    // the window is minimized. A lost surface is remade, once. Throws Error (exit code 3) if the display is
    // gone.
    bool show(const std::function<void(vk::Image window, vk::Semaphore drawn)>& draw);

private:
    void listen();
    void takePinch();
    void makePictures();
    void add(DesktopEvent event);
    // A place in GLFW's units, in the window's pixels.
    [[nodiscard]] glm::dvec2 inPixels(const glm::dvec2& place) const;

    const Context& context_;
    std::unique_ptr<GLFWwindow, void (*)(GLFWwindow*)> window_;  // outlives everything drawn on it
    std::unique_ptr<GLFWcursor, void (*)(GLFWcursor*)> sideways_;
    bool points_sideways_ = false;
    std::string title_;
    std::unique_ptr<WindowPictures> pictures_;
    std::unique_ptr<Pinch> pinch_;
    std::vector<DesktopEvent> events_;
    glm::dvec2 cursor_{0.0};  // in GLFW's units
    bool is_damaged_ = true;
    int refresh_hz_ = 0;                // 0: to be asked for
    glm::ivec4 before_full_screen_{0};  // place and size
};

}  // namespace binosplat
