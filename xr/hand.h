// What a hand is doing.
#pragma once

#include "engine/geometry.h"
#include "xr/extensions/hand_tracking.h"

#include <optional>

namespace binosplat::xr {

// One hand at the time of a frame, in room axes (ours: x right, y down, z forward).
struct Hand {
    std::optional<Pose> aim;             // the ray goes along its z
    std::optional<Pose> grip;            // where the hand is
    std::optional<HandJoints> joints;    // if the runtime finds them
    bool clicks = false, grabs = false;  // trigger and squeeze, with hysteresis
    glm::dvec2 stick{0.0};               // right and up are positive; pads count only while pressed
    bool menu = false;
    bool play = false;           // the lower button
    bool stick_presses = false;  // the stick is pressed in; never a pad
    bool is_bare = false;        // nothing is held: a pinch clicks, and there are no buttons
};

// Tells whether a trigger or a grip is pressed, with hysteresis, since values jitter. A button that was not
// read for a while may have been pressed for something else, so it counts only once it has been seen
// released.
class Hold {
public:
    // Empty: unknown.
    bool update(std::optional<double> value) {
        if (!value) { forget(); }
        was_released_ = was_released_ || (value && *value <= kUntil);
        return held_ = was_released_ && *value > (held_ ? kUntil : kFrom);
    }
    void forget() { held_ = was_released_ = false; }

private:
    static constexpr double kFrom = 0.5, kUntil = 0.3;
    bool held_ = false, was_released_ = false;
};

}  // namespace binosplat::xr
