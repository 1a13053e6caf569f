// The two controllers, of any kind, and the gaze.
#pragma once

#include "xr/actions.h"
#include "xr/extensions/eye_gaze.h"
#include "xr/extensions/hand_tracking.h"

#include <array>
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
};

// Tells if a trigger or a grip is pressed, with hysteresis, since values jitter. A button that was not read for a while may have been
// pressed for something else: it counts once it has been seen released.
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

class Input {
public:
    // Suggests bindings for every controller of bindings.h that the runtime knows, and attaches them. Controllers that it rejects
    // are among the Troubles.
    explicit Input(const Session& session);
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;

    // Both hands, [kLeft] and [kRight], at the open frame's display time; at rest while another program has the input.
    [[nodiscard]] std::array<Hand, 2> read();
    // The gaze as of the last read(): a direction in the room (our axes). Empty if the headset does not track it reliably, or this
    // program may not see it.
    [[nodiscard]] std::optional<glm::dvec3> gaze() { return gaze_.find(); }
    // A short buzz in a hand, if its controller can.
    void pulse(int hand);

private:
    void suggestBindings() const;
    void readHand(std::size_t h, Hand& hand);

    const Session& session_;
    HandTracking tracking_;
    Actions actions_;
    std::array<XrPath, 2> hands_;
    XrAction aim_, grip_, trigger_, squeeze_, stick_, stick_click_, stick_press_, menu_, play_, haptic_;
    EyeGaze gaze_;
    std::array<OwnedSpace, 2> aim_spaces_, grip_spaces_;
    std::array<Hold, 2> clicks_, grabs_, menus_, presses_, plays_;
    bool pulses_ = true;       // until one fails
    int times_focused_ = 0;    // of the session, as of the last read()
    bool is_at_rest_ = false;  // as of the last read()
};

}  // namespace binosplat::xr
