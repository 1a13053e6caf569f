// A session's spaces, and where the eyes are in them.
#pragma once

#include "engine/geometry.h"
#include "xr/check.h"
#include "xr/own.h"

#include <array>
#include <optional>

namespace binosplat::xr {

// An eye at a display time.
struct EyeView {
    XrPosef pose;
    XrFovf fov;
};

inline constexpr XrPosef kHere{{0.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}};

[[nodiscard]] OwnedSpace makeSpace(XrSession session, XrReferenceSpaceType type, const XrPosef& pose = kHere);

// The room's origin is at the head, upright and facing its direction: the origins of the runtime's own spaces
// are arbitrary.
class Spaces {
public:
    // `moves_insets`: the insets of such a session follow the gaze.
    Spaces(XrSession session, XrViewConfigurationType views, bool moves_insets);

    // Places the room for `time` and later: the first time that the head's pose is known, again when the
    // runtime has recentred its space, and when `demanded`. Returns true if it did.
    bool settle(XrTime time, bool demanded);
    // The runtime recentres its space at `time`.
    void recentreFrom(XrTime time) { recentred_from_ = time; }
    // The poses of the eyes in room(); empty if the headset's orientation is unknown. While its position is
    // unknown, the last known one is used.
    [[nodiscard]] std::optional<std::array<EyeView, 2>> locateEyes(XrTime time);

    // The midpoint between the eyes, if its whole pose is known.
    [[nodiscard]] std::optional<Pose> locateHead(XrTime time) const;

    // The angles of both insets as of the last locateEyes(), in a session with insets; their poses are the
    // eyes'.
    [[nodiscard]] const std::optional<std::array<XrFovf, 2>>& insets() const { return insets_; }

    // LOCAL until the room is settled.
    [[nodiscard]] XrSpace room() const { return room_.get(); }
    // Moves with the head.
    [[nodiscard]] XrSpace head() const { return head_.get(); }

private:
    // A result of xrLocateViews, and which parts of it are known.
    struct Located {
        std::array<EyeView, 2> eyes;
        std::array<XrFovf, 2> insets;
        bool turn_known = false, place_known = false;
    };
    [[nodiscard]] Located locate(XrSpace space, XrTime time) const;

    XrSession session_;
    XrViewConfigurationType views_;
    bool moves_insets_;
    OwnedSpace local_, room_, head_;
    bool turn_settled_ = false, place_settled_ = false;
    std::optional<XrTime> recentred_from_;
    std::optional<std::array<XrFovf, 2>> insets_;
    XrVector3f last_place_{};  // the head's last known position in the room
};

}  // namespace binosplat::xr
