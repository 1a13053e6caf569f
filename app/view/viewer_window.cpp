// What happens where the display or the device refuses.
#include "app/view/viewer_window.h"

#include "engine/error.h"

#include <fmt/format.h>

namespace binosplat {

std::string ViewerWindow::open(const Context& context, const Canvas& canvas, EventWindow& events) {
    std::string why;
    try {
        window_ = std::make_unique<MirrorWindow>(context, canvas, events);
        return {};
    } catch (const Error& error) { why = error.what(); } catch (const vk::SystemError& error) {
        why = error.what();
    }
    events.close();
    return why;
}

const WindowInput& ViewerWindow::poll() { return input_ = window_ ? window_->poll() : WindowInput(); }

void ViewerWindow::act(void (MirrorWindow::*what)()) {
    const auto goOnWithout = [&](const char* why) {
        say_(fmt::format("the window is gone: {}", why));
        window_.reset();
        input_ = {};
    };
    try {
        if (window_) { (*window_.*what)(); }
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError& error) {
        goOnWithout(error.what());
    } catch (const Error& error) { goOnWithout(error.what()); }
}

}  // namespace binosplat
