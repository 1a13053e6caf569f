// A line of text in front of the wearer's eyes: a message for some seconds while the panel is hidden,
// otherwise the first steps.
#pragma once

#include "app/view/panel/first_steps.h"
#include "app/view/room/room_things.h"

#include <string>

namespace binosplat {

class MessageLine {
public:
    // See FirstSteps.
    MessageLine(FileWorker& files, FirstStepsShown shown) : first_steps_(files, shown) {}

    // In the next frame.
    void say(const std::string& message) { message_ = message; }
    // Adds to what is drawn in this frame, in `layout`.
    void show(RoomSight& sight, const TexelLayout& layout, bool panel_is_shown, double step_seconds);

private:
    FirstSteps first_steps_;
    std::string message_;        // to be shown
    double seconds_left_ = 0.0;  // for the one that is shown
};

}  // namespace binosplat
