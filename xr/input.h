// The two controllers, of any kind, a gamepad, and the gaze.
#pragma once

#include "xr/actions.h"
#include "xr/bindings.h"
#include "xr/extensions/eye_gaze.h"
#include "xr/gamepad.h"

#include <array>
#include <optional>

namespace binosplat::xr {

class Input {
public:
    // Suggests bindings for every controller of bindings.h that the runtime knows, and attaches them.
    // Controllers that it rejects are among the Troubles.
    explicit Input(const Session& session);
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;

    // Both hands, [kLeft] and [kRight], at the open frame's display time; at rest while another program has
    // the input.
    [[nodiscard]] std::array<Hand, 2> read();
    // The gaze as of the last read(): a direction in the room (our axes). Empty if the headset does not track
    // it reliably, or this program may not see it.
    [[nodiscard]] std::optional<glm::dvec3> gaze() { return gaze_.find(); }
    // The bindings of what each hand holds, by hand; null: nothing that is known.
    [[nodiscard]] std::array<const ProfileBindings*, 2> held();
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
    Gamepad gamepad_;
    EyeGaze gaze_;
    std::array<OwnedSpace, 2> aim_spaces_, grip_spaces_;
    std::array<Hold, 2> clicks_, grabs_, menus_, presses_, plays_;
    bool pulses_ = true;      // until one fails
    bool tells_held_ = true;  // the same
    int times_focused_ = 0;   // of the session, as of the last read()
    int times_held_changed_ = -1;
    std::array<bool, 2> are_bare_{};
    bool is_at_rest_ = false;  // as of the last read()
};

}  // namespace binosplat::xr
