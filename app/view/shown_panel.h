// The panel, frame by frame: what it says, who points at it, and where it is drawn: in the headset, in the window, or in both.
#pragma once

#include "app/view/file_worker.h"
#include "app/view/headset/headset_stay.h"
#include "app/view/panel/canvas.h"
#include "app/view/panel/overlay.h"
#include "app/view/panel/overlay_panel.h"
#include "app/view/window/mirror_window.h"

#include <chrono>

namespace binosplat {

class ShownPanel {
public:
    // `format` is that of every session's images.
    ShownPanel(const Context& context, vk::Format format);

    // As a thing in the room.
    [[nodiscard]] OverlayPanel& inRoom() { return in_room_; }
    [[nodiscard]] const Canvas& canvas() const { return canvas_; }
    // What it says when it is laid out next; times and the governor's sentence are showTimes()'s to fill in.
    [[nodiscard]] OverlayStatus& status() { return status_; }

    // A frame was drawn just now.
    void keepFrameTime();
    // Shows what the last frame took, renewed only now and then, since nobody can read what changes with every frame.
    void showTimes(const FrameResult& last, const std::string& governor, double step_seconds);
    // What it needs of files is read beside the frames: letters and pictures, and the list that is looked through.
    void askFor(FileWorker& files, const ViewSettings& settings);
    // What is known of the scenes that are listed changed.
    void listAnew() { pages_.chooser.refresh(status_.scene); }
    // The widgets. Where they have changed it takes an image of the panel in `hung`, the stay in whose room it hangs; null where it does
    // not hang.
    OverlayActions layOut(HeadsetStay* hung, const WindowInput& window, ViewSettings& settings, double step_seconds);
    // Draws them on that image and on the window, if there is one.
    void record(Commands& commands, HeadsetStay* stay, MirrorWindow* window);
    // After submission: the runtime may show that image.
    void release(HeadsetStay& stay);
    // Nothing comes of what was laid out last.
    void giveUp();

private:
    Canvas canvas_;
    OverlayPanel in_room_;
    OverlayStatus status_;
    OverlayPages pages_;
    FrameResult shown_frame_;      // whose times it shows
    std::vector<float> frame_ms_;  // see OverlayStatus
    double times_age_s_ = 0.0;
    bool mouse_points_ = false;  // and not a hand
    vk::Image image_;            // to be drawn anew; null: none
    std::chrono::steady_clock::time_point last_end_{};
};

}  // namespace binosplat
