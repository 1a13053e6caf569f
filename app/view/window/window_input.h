// Mouse and keyboard of the window.
#pragma once

#include "app/view/room/panel_pointer.h"
#include "engine/similarity.h"

#include <string>

namespace binosplat {

// Input from mouse and keyboard since the last poll.
struct WindowInput {
    PanelPointer pointer;     // on the panel
    bool uses_panel = false;  // the mouse was moved, pressed, released or scrolled there
    glm::dvec3 walk{0.0};     // right, down, forward; -1 to 1
    double turn_rad = 0.0;    // to the right
    double turn_rate = 0.0;   // by keys, -1 to 1
    double wheel = 0.0;       // steps upwards, outside the panel: the scene grows
    // How far the scene tilts: to the right about the line of sight, and upwards about the axis to the
    // wearer's right.
    glm::dvec2 tilt_rad{0.0};
    bool toggle_panel = false;
    bool reload_shaders = false;
    bool recentre = false;
    bool play = false;   // play or pause a moving scene
    int frame_step = 0;  // of a moving scene, forward or back
    bool quit = false;
    std::string dropped;  // a file dropped on the window; empty: none
};

// The wearer's place after `step_seconds` of input from keys and mouse.
Similarity movedByWindow(const Similarity& scene_from_room, const WindowInput& input,
                         const Pose& room_from_head, double step_seconds);

}  // namespace binosplat
