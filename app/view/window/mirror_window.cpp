// What is drawn on the window, and what its mouse and keyboard mean.
#include "app/view/window/mirror_window.h"

#include "app/view/room/sprites.h"
#include "app/view/window/window_drawing.h"
#include "engine/error.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <utility>

namespace binosplat {

namespace {

constexpr int kHeightPx = 720;
constexpr double kRadiansPerPixel = 0.004;

using Layout = vk::ImageLayout;
using Usage = vk::ImageUsageFlagBits;

}  // namespace

glm::ivec2 MirrorWindow::sizeFor(glm::uvec2 canvas_px) {
    return {kHeightPx + kHeightPx * static_cast<int>(canvas_px.x) / static_cast<int>(canvas_px.y), kHeightPx};
}

MirrorWindow::MirrorWindow(const Context& context, const Canvas& canvas, EventWindow& events)
    : context_(context), canvas_(canvas), events_(events) {
    check(context.hasDeviceExtension(VK_KHR_SWAPCHAIN_EXTENSION_NAME), "{} has no window pictures",
          context.deviceName());
    pictures_ = std::make_unique<WindowPictures>(
        context, vk::raii::SurfaceKHR(context.instance(), events.surface(context)),
        [this] { return events_.sizePx(); });
}

MirrorWindow::~MirrorWindow() {
    pictures_.reset();  // before the window
    events_.close();
}

WindowInput MirrorWindow::poll() {
    const WindowEvents events = events_.take();
    const auto pressed = [&](int key) { return events.down.contains(key) ? 1.0 : 0.0; };
    WindowInput input;
    for (const int key : events.pressed) {
        input.toggle_panel ^= key == GLFW_KEY_TAB;
        input.reload_shaders |= key == GLFW_KEY_F5;
        input.recentre |= key == GLFW_KEY_R;
        input.play ^= key == GLFW_KEY_SPACE;
        input.frame_step += (key == GLFW_KEY_PERIOD ? 1 : 0) - (key == GLFW_KEY_COMMA ? 1 : 0);
        input.quit |= key == GLFW_KEY_ESCAPE;
    }
    input.dropped = events.dropped;
    input.quit |= events.quit;
    input.walk = {pressed(GLFW_KEY_D) - pressed(GLFW_KEY_A), pressed(GLFW_KEY_Q) - pressed(GLFW_KEY_E),
                  pressed(GLFW_KEY_W) - pressed(GLFW_KEY_S)};
    input.turn_rate = pressed(GLFW_KEY_RIGHT) - pressed(GLFW_KEY_LEFT);
    const glm::dvec2 cursor = events.cursor * glm::dvec2(sizeFor(canvas_.sizePx()));
    const bool down = events.buttons_down.contains(GLFW_MOUSE_BUTTON_LEFT);
    const double scale = static_cast<double>(canvas_.sizePx().y) / kHeightPx;
    const glm::dvec2 place = scale * (cursor - glm::dvec2(kHeightPx, 0.0));
    const glm::dvec2 size(canvas_.sizePx());
    const bool is_over =
        glm::all(glm::greaterThanEqual(place, glm::dvec2(0.0))) && glm::all(glm::lessThan(place, size));
    // If another window is above this one, the mouse belongs to that one.
    if (is_over && (down || events.is_hovered)) {
        input.pointer = {place, down, events.wheel};
        input.uses_panel = cursor != cursor_ || down || was_down_ || events.wheel != 0.0;
    } else {
        input.wheel = events.wheel;
        // The picture follows the mouse.
        if (down) { input.turn_rad = kRadiansPerPixel * (cursor_.x - cursor.x); }
        if (events.buttons_down.contains(GLFW_MOUSE_BUTTON_RIGHT)) {
            input.tilt_rad = kRadiansPerPixel * glm::dvec2(cursor.x - cursor_.x, cursor_.y - cursor.y);
        }
    }
    cursor_ = cursor;
    was_down_ = down;
    return input;
}

std::optional<OwnImage> MirrorWindow::makeEye(const Context& context, glm::uvec2 most_px, vk::Format format) {
    std::optional<OwnImage> eye;
    const vk::Format raw =
        texelLayoutOf(format).blue_first ? vk::Format::eB8G8R8A8Unorm : vk::Format::eR8G8B8A8Unorm;
    try {
        eye.emplace(context, "the window's eye", most_px, raw,
                    Usage::eTransferDst | Usage::eTransferSrc | Usage::eColorAttachment);
    } catch (const vk::OutOfDeviceMemoryError&) {
    } catch (const vk::OutOfHostMemoryError&) {
        // The window then shows only the panel: the headset matters more.
    }
    return eye;
}

void MirrorWindow::keepEye(Commands& commands, const Buffer& pixels, glm::uvec2 size_px, glm::uvec2 most_px,
                           vk::Format format) {
    eye_px_ = size_px;
    if (eye_most_px_ != most_px) {
        eye_most_px_ = most_px;
        eye_.reset();
        eye_ = makeEye(context_, most_px, format);
    }
    if (!eye_) { return; }
    commands.copyToImage(pixels, *eye_->image, size_px, vk::ImageAspectFlagBits::eColor);
    changeLayout(commands, *eye_->image, Layout::eColorAttachmentOptimal, Layout::eTransferSrcOptimal);
}

void MirrorWindow::record(Commands& commands) {
    const vk::Image target = pictures_->current();
    if (!target) { return; }
    const int width = static_cast<int>(pictures_->sizePx().x),
              height = static_cast<int>(pictures_->sizePx().y);
    clearWindow(commands, target);
    const int split = std::clamp(width * kHeightPx / sizeFor(canvas_.sizePx()).x, 1, std::max(width - 1, 1));
    const auto show = [&](vk::Image image, glm::uvec2 size_px, const WindowPart& part) {
        blitInto(commands, image, size_px, target, fittedInto(size_px, part));
    };
    if (eye_ && eye_px_.x > 0) { show(*eye_->image, eye_px_, {{0, 0}, {split, height}}); }
    if (split < width) { show(canvas_.image(), canvas_.sizePx(), {{split, 0}, {width - split, height}}); }
    changeLayout(commands, target, Layout::eTransferDstOptimal, Layout::ePresentSrcKHR);
}

}  // namespace binosplat
