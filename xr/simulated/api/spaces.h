// Chapter 7: reference spaces and action spaces, all located in the stage.
#pragma once

#include <optional>

#include "xr/simulated/api/handles.h"
#include "xr/simulated/api/poses.h"
#include "xr/simulated/script/script.h"

namespace simulated {

struct Space : SessionChild {
    using Handle = XrSpace;
    using SessionChild::SessionChild;

    Pose origin_from_space;
    // Either a reference space,
    std::optional<XrReferenceSpaceType> reference;
    // or an action's: its number and the user path that it was made for.
    std::uint64_t action = 0;
    XrPath subaction_path = XR_NULL_PATH;
};

// XR_ERROR_HANDLE_INVALID also for a space of another session.
Space& getSpace(const Session& session, XrSpace space);

constexpr XrSpaceLocationFlags kPoseKnown =
    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
constexpr XrSpaceVelocityFlags kVelocityKnown =
    XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT;

// None while the controller behind it is inactive or not tracked.
std::optional<Pose> stageFromSpace(const Space& space, const State& state);
// "VIEW", "LOCAL", "LOCAL_FLOOR", "STAGE", "action".
const char* nameOf(const Space& space);

// XR_ERROR_TIME_INVALID.
void checkTime(XrTime time);

}  // namespace simulated
