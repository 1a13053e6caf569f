// The panel as a picture: its content, drawn on a canvas and operated by whatever points at it.
#pragma once

#include "app/view/files/file_worker.h"
#include "app/view/panel/canvas.h"
#include "app/view/panel/panel_content.h"

#include <chrono>

namespace binosplat {

class PanelPicture {
public:
    // `format` is the format of the images that it is copied to.
    PanelPicture(const Context& context, vk::Format format);

    [[nodiscard]] Canvas& canvas() { return canvas_; }
    // The content for the next layout; showTimes() fills in times and the governor's sentence.
    [[nodiscard]] PanelStatus& status() { return status_; }

    // The text that is being typed on it.
    [[nodiscard]] TextEntry& entry() { return entry_; }
    [[nodiscard]] const TextEntry& entry() const { return entry_; }

    // Call when a frame has just been drawn.
    void keepFrameTime();
    // Shows the last frame's times, updated only now and then, since numbers that change with every frame
    // cannot be read.
    void showTimes(const FrameResult& last, const std::string& governor, double step_seconds);
    // Has letters, pictures and the current list of scenes read from files alongside the frames.
    void askFor(FileWorker& files, const ViewSettings& settings);
    // Facts about the listed scenes have changed.
    void listAnew() { chooser_.refresh(status_.scene); }
    // Lays out the widgets.
    PanelRequests layOut(const PanelPointer& pointer, const ViewSettings& settings, double step_seconds);
    // Draws the widgets, if they have changed.
    void record(Commands& commands);

private:
    Canvas canvas_;
    PanelStatus status_;
    SceneChooser chooser_;
    TextEntry entry_;
    FrameResult shown_frame_;      // the frame whose times are shown
    std::vector<float> frame_ms_;  // see PanelStatus
    double times_age_s_ = 0.0;
    std::chrono::steady_clock::time_point last_end_{};
};

}  // namespace binosplat
