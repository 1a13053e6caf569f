// The panel, frame by frame: what it says, who points at it, and where it is drawn: in the headset, in the window, or in both.
#pragma once

#include "app/view/files/file_worker.h"
#include "app/view/headset/connected_headset.h"
#include "app/view/panel/canvas.h"
#include "app/view/panel/panel_content.h"
#include "app/view/room/panel_in_room.h"

#include <chrono>

namespace binosplat {

class Panel {
public:
    // `format` is that of every session's images.
    Panel(const Context& context, vk::Format format);

    // As a thing in the room.
    [[nodiscard]] PanelInRoom& inRoom() { return in_room_; }
    [[nodiscard]] const Canvas& canvas() const { return canvas_; }
    // What it says when it is laid out next; times and the governor's sentence are showTimes()'s to fill in.
    [[nodiscard]] PanelStatus& status() { return status_; }

    // A frame was drawn just now.
    void keepFrameTime();
    // Shows what the last frame took, renewed only now and then, since nobody can read what changes with every frame.
    void showTimes(const FrameResult& last, const std::string& governor, double step_seconds);
    // What it needs of files is read beside the frames: letters and pictures, and the list that is looked through.
    void askFor(FileWorker& files, const ViewSettings& settings);
    // What is known of the scenes that are listed changed.
    void listAnew() { chooser_.refresh(status_.scene); }
    // The widgets, for the hand that points or for `mouse`, of which `uses_mouse` says whether it did anything there. Where they have
    // changed it takes an image of the panel in `hung`, the headset in whose room it hangs; null where it does not hang.
    PanelRequests layOut(ConnectedHeadset* hung, const PanelPointer& mouse, bool uses_mouse, const ViewSettings& settings,
                         double step_seconds);
    // Draws them on that image. The canvas is drawn for a window, too, where it is to be `copied`.
    void record(Commands& commands, ConnectedHeadset* headset, bool copied);
    // After submission: the runtime may show that image.
    void release(ConnectedHeadset& headset);
    // Nothing comes of what was laid out last.
    void giveUp();

private:
    Canvas canvas_;
    PanelInRoom in_room_;
    PanelStatus status_;
    SceneChooser chooser_;
    FrameResult shown_frame_;      // whose times it shows
    std::vector<float> frame_ms_;  // see PanelStatus
    double times_age_s_ = 0.0;
    bool mouse_points_ = false;  // and not a hand
    vk::Image image_;            // to be drawn anew; null: none
    std::chrono::steady_clock::time_point last_end_{};
};

}  // namespace binosplat
