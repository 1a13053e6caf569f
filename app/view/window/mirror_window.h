// A window on the desktop: the dominant eye's picture, and the panel beside it for the mouse.
#pragma once

#include "app/view/panel/canvas.h"
#include "app/view/window/event_window.h"
#include "app/view/window/window_input.h"
#include "app/view/window/window_pictures.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <utility>

namespace binosplat {

class MirrorWindow {
public:
    // The initial size of a window for such a canvas.
    [[nodiscard]] static glm::ivec2 sizeFor(glm::uvec2 canvas_px);
    // `events` must outlive this, and its window closes with this. Throws Error if the device cannot show on
    // the display.
    MirrorWindow(const Context& context, const Canvas& canvas, EventWindow& events);
    MirrorWindow(const MirrorWindow&) = delete;
    MirrorWindow& operator=(const MirrorWindow&) = delete;
    ~MirrorWindow();

    // What mouse and keyboard did since the last call.
    [[nodiscard]] WindowInput poll();
    // Before anything is recorded: a picture to draw on, if one is free; the headset does not wait for it.
    void acquire() { pictures_->acquire(); }
    // What keepEye keeps pixels in; absent if the device lacks the memory. On any thread. `format`: of the
    // headset's images.
    [[nodiscard]] static std::optional<OwnImage> makeEye(const Context& context, glm::uvec2 most_px,
                                                         vk::Format format);
    // From now on that one is used. Frames in flight may still use the one before, which is returned.
    [[nodiscard]] std::optional<OwnImage> exchange(std::optional<OwnImage> eye, glm::uvec2 most_px) {
        eye_px_ = {0, 0};  // nothing is kept in it yet
        eye_most_px_ = most_px;
        return std::exchange(eye_, std::move(eye));
    }
    // Between begin and submit: keeps an eye's presented pixels, of an image of `format`. The size may be any
    // up to `most_px`; while that changes, unless by exchange(), no frame is in flight.
    void keepEye(Commands& commands, const Buffer& pixels, glm::uvec2 size_px, glm::uvec2 most_px,
                 vk::Format format);
    // Between begin and submit, once the canvas is drawn; may be repeated.
    void record(Commands& commands);
    // The semaphore that the submission signals for show(); null if no picture was acquired.
    [[nodiscard]] vk::Semaphore drawn() const { return pictures_->drawn(); }
    // After submit: shows the picture once it is drawn.
    void show() { pictures_->show(); }

private:
    const Context& context_;
    const Canvas& canvas_;
    EventWindow& events_;
    std::unique_ptr<WindowPictures> pictures_;
    std::optional<OwnImage> eye_;
    glm::uvec2 eye_px_{0, 0}, eye_most_px_{0, 0};
    glm::dvec2 cursor_{0.0};  // at the last poll, and whether its left button was down
    bool was_down_ = false;
};

}  // namespace binosplat
