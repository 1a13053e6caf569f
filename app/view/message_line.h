// A line of text in front of the wearer's eyes: a message for some seconds while the panel is hidden,
// otherwise the first steps. It is a little below where the wearer looks, or farther below or above if the
// panel hangs there.
#pragma once

#include "app/view/panel/first_steps.h"
#include "app/view/room/panel_in_room.h"
#include "app/view/room/room_things.h"

#include <array>
#include <string>

namespace binosplat {

class MessageLine {
public:
    // See FirstSteps.
    MessageLine(FileWorker& files, FirstStepsShown shown) : first_steps_(files, shown) {}

    // In the next frame.
    void say(const std::string& message) { message_ = message; }
    // Adds to what is drawn in this frame, in `layout`. `panel`: null if it is hidden.
    void show(RoomSight& sight, const TexelLayout& layout, const PanelInRoom* panel,
              const Pose& room_from_head, double step_seconds);

private:
    FirstSteps first_steps_;
    std::string message_;        // to be shown
    double seconds_left_ = 0.0;  // for the one that is shown
    // In the order of preference: below the direction of the head, a metre away.
    static constexpr std::array kPlacesMetres{0.28, -0.28, -0.42, 0.42};
    double down_m_ = kPlacesMetres[0];
};

}  // namespace binosplat
