// Making and checking spaces, and locating them in one another, with velocities.
#include "xr/simulated/api/spaces.h"

#include <algorithm>

#include "xr/simulated/api/actions.h"
#include "xr/simulated/api/api.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

bool hasStage(const Session& session) { return session.instance.simulation->script.has_stage; }

std::vector<XrReferenceSpaceType> referenceSpacesOf(const Session& session) {
    std::vector<XrReferenceSpaceType> types{XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL};
    if (hasStage(session)) { types.push_back(XR_REFERENCE_SPACE_TYPE_STAGE); }
    if (session.instance.has1_1Or(XR_EXT_LOCAL_FLOOR_EXTENSION_NAME)) {
        types.push_back(XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR);
    }
    return types;
}

bool isKnown(const Session& session, XrReferenceSpaceType type) {
    const std::vector<XrReferenceSpaceType> types = referenceSpacesOf(session);
    return std::find(types.begin(), types.end(), type) != types.end();
}

bool isGaze(const Space& space) {
    return !space.reference && isOfGaze(space.session, space.action, space.subaction_path);
}

// Spaces of one pose action are fixed to one thing and never move against each other, even if nobody knows
// where that thing is.
bool areOnOneThing(const Space& space, const Space& base) {
    return !space.reference && !base.reference && space.action == base.action &&
           space.subaction_path == base.subaction_path &&
           isLocatable(space.session, space.action, space.subaction_path);
}

// An untracked head has a pose only relative to itself; if only its orientation is known, its position is not
// valid. A gaze is on the head, and its orientation and position are tracked together or not at all.
XrSpaceLocationFlags locationFlagsOf(const Space& space, const Space& base, const State& state) {
    constexpr XrSpaceLocationFlags kTracked =
        XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
    if (areOnOneThing(space, base)) { return kPoseKnown; }
    const bool gaze = isGaze(space), base_gaze = isGaze(base);
    const bool is_poor = (gaze || base_gaze) && !state.gaze_is_good;
    const bool on_head = gaze || space.reference == XR_REFERENCE_SPACE_TYPE_VIEW;
    const bool base_on_head = base_gaze || base.reference == XR_REFERENCE_SPACE_TYPE_VIEW;
    if (on_head == base_on_head || state.head_place_known) {
        return is_poor ? kPoseKnown & ~kTracked : kPoseKnown;
    }
    if (!state.head_turn_known) { return 0; }
    if (gaze || base_gaze) { return XR_SPACE_LOCATION_ORIENTATION_VALID_BIT; }
    return XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
}

std::optional<Pose> baseFromSpace(const Space& space, const Space& base, XrTime time) {
    if (areOnOneThing(space, base)) {
        return compose(inverse(base.origin_from_space), space.origin_from_space);
    }
    const State state = space.session.at(time);
    const std::optional<Pose> stage_from_space = stageFromSpace(space, state),
                              stage_from_base = stageFromSpace(base, state);
    if (!stage_from_space || !stage_from_base) { return std::nullopt; }
    return compose(inverse(*stage_from_base), *stage_from_space);
}

struct Location {
    XrSpaceLocationFlags flags = 0;
    XrPosef pose = toXr(Pose{});
};

Location locate(const Space& space, const Space& base, XrTime time) {
    const std::optional<Pose> pose = baseFromSpace(space, base, time);
    const XrSpaceLocationFlags flags =
        pose ? locationFlagsOf(space, base, space.session.instance.simulation->at(time)) : 0;
    return flags != 0 ? Location{flags, toXr(*pose)} : Location{};
}

// Motion of the space's origin, in the base's axes.
template <class Velocity>
void differentiate(const Space& space, const Space& base, XrTime time, Velocity& velocity) {
    velocity.velocityFlags = 0;
    velocity.linearVelocity = velocity.angularVelocity = {0, 0, 0};
    const std::optional<Pose> before = baseFromSpace(space, base, time - kMotionStep),
                              after = baseFromSpace(space, base, time + kMotionStep);
    if (!before || !after) { return; }
    const Motion motion = motionOf(*before, *after);
    velocity.velocityFlags = kVelocityKnown;
    velocity.linearVelocity = motion.linear_m_s;
    velocity.angularVelocity = motion.angular_rad_s;
}

}  // namespace

void checkTime(XrTime time) {
    require(time > 0, XR_ERROR_TIME_INVALID, "the time is ", time, ", must be positive");
}

Space& getSpace(const Session& session, XrSpace space) {
    Space& found = get<Space>(space);
    if (&found.session != &session) { refuseHandle(space, " of this session"); }
    return found;
}

std::optional<Pose> stageFromSpace(const Space& space, const State& state) {
    if (space.reference == XR_REFERENCE_SPACE_TYPE_STAGE) { return space.origin_from_space; }
    const Script& script = space.session.instance.simulation->script;
    std::optional<Pose> stage_from_origin = state.stage_from_head;
    if (!space.reference) {
        stage_from_origin = stageFromAction(space.session, space.action, space.subaction_path, state);
    } else if (*space.reference == XR_REFERENCE_SPACE_TYPE_LOCAL) {
        stage_from_origin = script.stageFromLocal(state.time_s);
    } else if (*space.reference == XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR) {
        stage_from_origin = script.stageFromLocalFloor(state.time_s);
    }
    if (!stage_from_origin) { return std::nullopt; }
    return compose(*stage_from_origin, space.origin_from_space);
}

namespace {

// For 1.1's xrLocateSpaces and its predecessor.
void locateAll(const Session& owner, const XrSpacesLocateInfo* locate_info,
               XrSpaceLocations* space_locations) {
    const XrSpacesLocateInfo& info = checkStruct(locate_info, XR_TYPE_SPACES_LOCATE_INFO);
    XrSpaceLocations& output = checkStruct(space_locations, XR_TYPE_SPACE_LOCATIONS);
    require(info.spaceCount > 0 && info.spaces != nullptr, XR_ERROR_VALIDATION_FAILURE, "no spaces");
    require(output.locationCount == info.spaceCount && output.locations != nullptr,
            XR_ERROR_VALIDATION_FAILURE, output.locationCount, " locations, must be one for each of ",
            info.spaceCount, " spaces");
    auto* const velocities = findInChain<XrSpaceVelocities>(output.next, XR_TYPE_SPACE_VELOCITIES);
    require(velocities == nullptr ||
                (velocities->velocityCount == info.spaceCount && velocities->velocities != nullptr),
            XR_ERROR_VALIDATION_FAILURE, "not as many velocities as there are spaces, ", info.spaceCount);
    const Space& base = getSpace(owner, info.baseSpace);
    for (std::uint32_t i = 0; i < info.spaceCount; ++i) { getSpace(owner, info.spaces[i]); }
    checkTime(info.time);
    for (std::uint32_t i = 0; i < info.spaceCount; ++i) {
        const Space& space = getSpace(owner, info.spaces[i]);
        const auto [flags, pose] = locate(space, base, info.time);
        output.locations[i] = {flags, pose};
        if (velocities != nullptr) { differentiate(space, base, info.time, velocities->velocities[i]); }
    }
}

}  // namespace

const char* nameOf(const Space& space) {
    if (!space.reference) { return "action"; }
    if (*space.reference == XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR) { return "LOCAL_FLOOR"; }
    if (*space.reference == XR_REFERENCE_SPACE_TYPE_VIEW) { return "VIEW"; }
    return *space.reference == XR_REFERENCE_SPACE_TYPE_LOCAL ? "LOCAL" : "STAGE";
}

XrResult xrEnumerateReferenceSpaces(XrSession session, uint32_t spaceCapacityInput,
                                    uint32_t* spaceCountOutput, XrReferenceSpaceType* spaces) {
    return answerFor<Session>(__func__, session, [&](const Session& owner) {
        fillArray(spaceCapacityInput, spaceCountOutput, spaces, referenceSpacesOf(owner));
    });
}

XrResult xrCreateReferenceSpace(XrSession session, const XrReferenceSpaceCreateInfo* createInfo,
                                XrSpace* space) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const XrReferenceSpaceCreateInfo& info = checkStruct(createInfo, XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
        XrSpace& output = checkOutput(space);
        require(isKnown(owner, info.referenceSpaceType), XR_ERROR_REFERENCE_SPACE_UNSUPPORTED,
                info.referenceSpaceType, " is not a reference space that this session has");
        checkPose(info.poseInReferenceSpace);
        auto created = std::make_unique<Space>(owner);
        created->origin_from_space = fromXr(info.poseInReferenceSpace);
        created->reference = info.referenceSpaceType;
        output = handleOf(adopt(owner, std::move(created)));
    });
}

XrResult xrCreateActionSpace(XrSession session, const XrActionSpaceCreateInfo* createInfo, XrSpace* space) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const XrActionSpaceCreateInfo& info = checkStruct(createInfo, XR_TYPE_ACTION_SPACE_CREATE_INFO);
        XrSpace& output = checkOutput(space);
        const Action& action = getAction(owner.instance, info.action);
        require(action.type == XR_ACTION_TYPE_POSE_INPUT, XR_ERROR_ACTION_TYPE_MISMATCH, "the action ",
                action.name, " is not a pose");
        checkSubactionPath(owner.instance, action.subaction_paths, info.subactionPath);
        const bool is_left_out = owner.attachment && owner.attachment->find(action.number) == nullptr;
        require(!is_left_out, XR_ERROR_ACTIONSET_NOT_ATTACHED, "the action ", action.name,
                " is not among those attached");
        checkPose(info.poseInActionSpace);
        auto created = std::make_unique<Space>(owner);
        created->origin_from_space = fromXr(info.poseInActionSpace);
        created->action = action.number;
        created->subaction_path = info.subactionPath;
        output = handleOf(adopt(owner, std::move(created)));
    });
}

XrResult xrGetReferenceSpaceBoundsRect(XrSession session, XrReferenceSpaceType referenceSpaceType,
                                       XrExtent2Df* bounds) {
    return answerFor<Session>(__func__, session, [&](const Session& owner) {
        const bool is_stage = referenceSpaceType == XR_REFERENCE_SPACE_TYPE_STAGE;
        require(!is_stage || hasStage(owner), XR_ERROR_REFERENCE_SPACE_UNSUPPORTED, "there is no STAGE");
        // Unlike xrCreateReferenceSpace, whose conformance test wants XR_ERROR_REFERENCE_SPACE_UNSUPPORTED
        // for any unknown type.
        require(isKnown(owner, referenceSpaceType), XR_ERROR_VALIDATION_FAILURE, referenceSpaceType,
                " is not a reference space that this session has");
        checkOutput(bounds) = is_stage ? XrExtent2Df{3, 2} : XrExtent2Df{0, 0};
        return is_stage ? XR_SUCCESS : XR_SPACE_BOUNDS_UNAVAILABLE;
    });
}

XrResult xrLocateSpace(XrSpace space, XrSpace baseSpace, XrTime time, XrSpaceLocation* location) {
    return answerFor<Space>(__func__, space, [&](const Space& located) {
        const Space& base = getSpace(located.session, baseSpace);
        XrSpaceLocation& output = checkStruct(location, XR_TYPE_SPACE_LOCATION);
        checkTime(time);
        const auto [flags, pose] = locate(located, base, time);
        output.locationFlags = flags;
        output.pose = pose;
        if (auto* const velocity = findInChain<XrSpaceVelocity>(output.next, XR_TYPE_SPACE_VELOCITY)) {
            differentiate(located, base, time, *velocity);
        }
        const bool has_samples =
            located.session.instance.extensions.contains(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME);
        auto* const sample =
            findInChain<XrEyeGazeSampleTimeEXT>(output.next, XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT);
        // The script knows the gaze at any time; 0 means no sample.
        if (has_samples && sample != nullptr) {
            const bool is_seen =
                flags != 0 && isGaze(located) && stageFromSpace(located, located.session.at(time));
            sample->time = is_seen ? time : 0;
        }
    });
}

XrResult xrLocateSpaces(XrSession session, const XrSpacesLocateInfo* locateInfo,
                        XrSpaceLocations* spaceLocations) {
    return answerFor<Session>(__func__, session,
                              [&](const Session& owner) { locateAll(owner, locateInfo, spaceLocations); });
}

XrResult xrLocateSpacesKHR(XrSession session, const XrSpacesLocateInfo* locateInfo,
                           XrSpaceLocations* spaceLocations) {
    return answerFor<Session>(__func__, session,
                              [&](const Session& owner) { locateAll(owner, locateInfo, spaceLocations); });
}

XrResult xrDestroySpace(XrSpace space) {
    return answer(__func__, [&] { destroyObject(get<Space>(space)); });
}

}  // namespace simulated
