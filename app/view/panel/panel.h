// The panel, frame by frame: its content, who points at it, and where it is drawn: in the headset, in the window, or in both.
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
    // `format` is the format of every session's images.
    Panel(const Context& context, vk::Format format);

    // The panel as a thing in the room.
    [[nodiscard]] PanelInRoom& inRoom() { return in_room_; }
    [[nodiscard]] const Canvas& canvas() const { return canvas_; }
    // Its content for the next layout; times and the governor's sentence are filled in by showTimes().
    [[nodiscard]] PanelStatus& status() { return status_; }

    // A frame was drawn just now.
    void keepFrameTime();
    // Shows the last frame's times, updated only now and then, since nobody can read numbers that change with every frame.
    void showTimes(const FrameResult& last, const std::string& governor, double step_seconds);
    // Has letters, pictures and the current list of scenes read from files beside the frames.
    void askFor(FileWorker& files, const ViewSettings& settings);
    // Facts about the listed scenes have changed.
    void listAnew() { chooser_.refresh(status_.scene); }
    // Lays out the widgets, for the hand that points or for `mouse`; `uses_mouse`: it did something there. If they have changed, acquires
    // an image of `hung`, the headset in whose room the panel hangs; null: it does not hang.
    PanelRequests layOut(ConnectedHeadset* hung, const PanelPointer& mouse, bool uses_mouse, const ViewSettings& settings,
                         double step_seconds);
    // Draws the widgets on that image. The canvas is also drawn if it is to be `copied` to a window.
    void record(Commands& commands, ConnectedHeadset* headset, bool copied);
    // After submission: the runtime may show that image.
    void release(ConnectedHeadset& headset);
    // Discards the last layout.
    void giveUp();

private:
    Canvas canvas_;
    PanelInRoom in_room_;
    PanelStatus status_;
    SceneChooser chooser_;
    FrameResult shown_frame_;      // the frame whose times are shown
    std::vector<float> frame_ms_;  // see PanelStatus
    double times_age_s_ = 0.0;
    bool mouse_points_ = false;  // the mouse, not a hand
    vk::Image image_;            // to be drawn; null: none
    std::chrono::steady_clock::time_point last_end_{};
};

}  // namespace binosplat
