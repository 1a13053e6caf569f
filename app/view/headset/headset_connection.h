// A headset's sessions, one after another: a lost one is followed by the next, once there is a headset.
#pragma once

#include "app/view/headset/connected_headset.h"
#include "app/view/headset/losses.h"

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace binosplat {

class HeadsetConnection {
public:
    using Say = std::function<void(const std::string&)>;

    // Begins the first session; if that is lost at once, waits for the next as usual. `instance` and
    // `context` must outlive this; `panel_px` is the size of the panel's picture. Throws Interrupted while
    // waiting, and what search() throws.
    HeadsetConnection(xr::Instance& instance, const Context& context, glm::uvec2 panel_px, const Say& say);

    // Null while there is none.
    [[nodiscard]] ConnectedHeadset* headset() const { return headset_.get(); }
    // The format of every session's images.
    [[nodiscard]] vk::Format format() const { return format_; }

    void showedFrame() { losses_.forget(); }
    // Drops the session once the device is idle. Throws Error (exit code 3) if too many were lost before one
    // showed a frame.
    void lose(const std::string& why);

    enum class Search {
        kLater,  // it is too early to look again
        kNone,   // no headset, or one that is not awake yet
        kFound,  // a session has begun
    };
    // Throws xr::Lost if that session is lost at once, and Error if the headset keeps refusing one.
    Search search(const Say& say);

private:
    xr::Instance& instance_;
    const Context& context_;
    glm::uvec2 panel_px_;
    std::unique_ptr<ConnectedHeadset> headset_;
    vk::Format format_ = vk::Format::eUndefined;
    Losses losses_;     // since a frame was shown
    int failures_ = 0;  // in a row, to begin the next session
    std::string why_lost_;
    bool is_gone_ = false;  // the headset is gone, and this has been reported
    std::chrono::steady_clock::time_point next_search_{};
};

}  // namespace binosplat
