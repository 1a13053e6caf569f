// When somebody begins to wear the headset: at the start it may be lying on a desk.
#pragma once

#include "engine/geometry.h"

#include <optional>

namespace binosplat::xr {

class Wearing {
public:
    // How far a head must be from the room's origin, or turned from its z: farther than a wearer would fail
    // to notice.
    static constexpr double kElsewhereMetres = 0.1, kElsewhereRadians = 0.17;

    // What the runtime says, if it can tell.
    void hear(bool is_present) { is_present_ = is_present; }
    // What it said may have changed unheard.
    void forgetPresence() { is_present_.reset(); }
    // The room's origin has moved.
    void forgetPlace() { first_.reset(); }
    [[nodiscard]] bool hasBegun() const { return has_begun_; }
    // Call once a frame, with the head's pose in the room. True once: when the program has the input and
    // somebody wears the headset. If the runtime cannot tell, movement shows that there is a head: at once,
    // or a while after a headset has been still.
    bool begins(bool is_focused, const Pose& room_from_head, double step_seconds);

    [[nodiscard]] static bool isElsewhere(const Pose& room_from_head);

private:
    std::optional<bool> is_present_;
    std::optional<Pose> first_;
    double rested_seconds_ = 0.0, lifted_seconds_ = 0.0;
    bool has_begun_ = false;
};

}  // namespace binosplat::xr
