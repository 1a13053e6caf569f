// XR_EXT_hand_tracking: bare hands, joint by joint.
#pragma once

#include "engine/geometry.h"
#include "xr/session.h"

#include <array>
#include <memory>
#include <optional>

namespace binosplat::xr {

// True if the current headset tracks hands.
[[nodiscard]] bool findsHands(const Instance& instance);

// A hand's joints in room axes (ours), in the order of XrHandJointEXT.
struct HandJoint {
    glm::dvec3 place;
    double radius_m;
};
using HandJoints = std::array<HandJoint, XR_HAND_JOINT_COUNT_EXT>;

// Both hands of a session; never found if the runtime does not track hands or fails to do so; see Troubles.
class HandTracking {
public:
    explicit HandTracking(const Session& session);

    // At the open frame's display time; empty unless all joints are known.
    [[nodiscard]] std::optional<HandJoints> locate(int hand);

private:
    const Session& session_;
    using Tracker = Owned<XrHandTrackerEXT, PFN_xrDestroyHandTrackerEXT>;
    std::array<Tracker, 2> trackers_{Tracker(nullptr, nullptr), Tracker(nullptr, nullptr)};
    PFN_xrLocateHandJointsEXT locate_ = nullptr;
};

}  // namespace binosplat::xr
