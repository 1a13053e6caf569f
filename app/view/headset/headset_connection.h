// A headset's sessions, one after the other: a lost one is followed by the next, once there is a headset.
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

    // Begins the first one; where that is lost before it is there, waits for the next as ever. `instance` and `context` outlive this;
    // `panel_px` is the size of the panel's picture. Throws Interrupted as it waits, and what search() throws.
    HeadsetConnection(xr::Instance& instance, const Context& context, glm::uvec2 panel_px, const Say& say);

    // The present one; null while there is none.
    [[nodiscard]] ConnectedHeadset* headset() const { return headset_.get(); }
    // Of every session's images.
    [[nodiscard]] vk::Format format() const { return format_; }

    void showedFrame() { losses_.forget(); }
    // Waits until the device is done with it. Throws Error (exit code 3) where too many were lost before one showed a frame.
    void lose(const std::string& why);

    enum class Search {
        kLater,  // it is too early to look again
        kNone,   // no headset, or one that is not awake yet
        kFound,  // and a session has begun
    };
    // Throws xr::Lost where that is lost at once, and Error where a headset goes on refusing one.
    Search search(const Say& say);

private:
    xr::Instance& instance_;
    const Context& context_;
    glm::uvec2 panel_px_;
    std::unique_ptr<ConnectedHeadset> headset_;
    vk::Format format_ = vk::Format::eUndefined;
    Losses losses_;     // since a frame was shown
    int failures_ = 0;  // of sessions that were to come after it, in a row
    std::string why_lost_;
    bool is_gone_ = false;  // the headset, since then
    std::chrono::steady_clock::time_point next_search_{};
};

}  // namespace binosplat
