// The viewer's window on the desktop: optional, and gone with one line if it fails.
#pragma once

#include "app/view/scenes/scene_notes.h"
#include "app/view/window/mirror_window.h"

#include <memory>

namespace binosplat {

class ViewerWindow {
public:
    // Without a window until open(). `say` takes the line.
    explicit ViewerWindow(Say say) : say_(std::move(say)) {}

    // `events` must outlive this. Returns why there is none, or empty.
    [[nodiscard]] std::string open(const Context& context, const Canvas& canvas, EventWindow& events);
    [[nodiscard]] MirrorWindow* get() const { return window_.get(); }  // null: none
    explicit operator bool() const { return window_ != nullptr; }

    // What mouse and keyboard have done since the last call.
    const WindowInput& poll();
    [[nodiscard]] const WindowInput& input() const { return input_; }  // at the last poll
    // Before anything is recorded, and after it is submitted.
    void acquire() { act(&MirrorWindow::acquire); }
    void show() { act(&MirrorWindow::show); }
    // To be signalled by the submission; null: nothing is to be shown.
    [[nodiscard]] vk::Semaphore drawn() const { return window_ ? window_->drawn() : vk::Semaphore(); }

private:
    // Errors of the window only close the window.
    void act(void (MirrorWindow::*what)());

    Say say_;
    std::unique_ptr<MirrorWindow> window_;
    WindowInput input_;
};

}  // namespace binosplat
