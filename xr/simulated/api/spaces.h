// Chapter 7: reference spaces and action spaces, all located in the stage.
#pragma once

#include <optional>

#include "xr/simulated/api/handles.h"
#include "xr/simulated/api/poses.h"
#include "xr/simulated/script/script.h"

namespace simulated {

struct Session;

struct Space : Object {
    using Handle = XrSpace;

    Session& session;
    Pose origin_from_space;
    // Either a reference space,
    std::optional<XrReferenceSpaceType> reference;
    // or an action's: its number and the user path that it was made for.
    std::uint64_t action = 0;
    XrPath subaction_path = XR_NULL_PATH;

    explicit Space(Session& owner) : session(owner) {}
};

// XR_ERROR_HANDLE_INVALID also for a space of another session.
Space& getSpace(const Session& session, XrSpace space);

// None while the controller behind it is inactive or not tracked.
std::optional<Pose> stageFromSpace(const Space& space, const State& state);
// "VIEW", "LOCAL", "LOCAL_FLOOR", "STAGE", "action".
const char* nameOf(const Space& space);

// XR_ERROR_TIME_INVALID.
void checkTime(XrTime time);

}  // namespace simulated
