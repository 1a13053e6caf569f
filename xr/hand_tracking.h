// Bare hands, joint by joint, where the runtime has XR_EXT_hand_tracking.
#pragma once

#include "engine/geometry.h"
#include "xr/session.h"

#include <array>
#include <optional>

namespace binosplat::xr {

// A hand's joints in room axes (ours), in the order of XrHandJointEXT.
struct HandJoint {
    glm::dvec3 place;
    double radius_m;
};
using HandJoints = std::array<HandJoint, XR_HAND_JOINT_COUNT_EXT>;

// Both hands of a session; empty ones where the runtime has none, or fails to find them: see Troubles.
class HandTracking {
public:
    explicit HandTracking(const Session& session);
    HandTracking(const HandTracking&) = delete;
    HandTracking& operator=(const HandTracking&) = delete;
    ~HandTracking();

    // At the open frame's display time; empty while the hand is not seen whole.
    [[nodiscard]] std::optional<HandJoints> locate(int hand);

private:
    const Session& session_;
    std::array<XrHandTrackerEXT, 2> trackers_{};
    PFN_xrDestroyHandTrackerEXT destroy_ = nullptr;
    PFN_xrLocateHandJointsEXT locate_ = nullptr;
};

}  // namespace binosplat::xr
