#include "xr/simulated/spaces.h"

#include "xr/simulated/actions.h"
#include "xr/simulated/api.h"
#include "xr/simulated/session.h"
#include "xr/simulated/structures.h"

namespace simulated {
namespace {

constexpr XrSpaceLocationFlags kPoseKnown = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
                                            XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
constexpr XrSpaceVelocityFlags kVelocityKnown = XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT;

// A millisecond to either side: short against any motion, long against rounding.
constexpr XrDuration kDifference = 1'000'000;

bool hasStage(const Session& session) { return session.instance.simulation->script.has_stage; }

void checkReferenceType(const Session& session, XrReferenceSpaceType type) {
    const bool is_known = type == XR_REFERENCE_SPACE_TYPE_VIEW || type == XR_REFERENCE_SPACE_TYPE_LOCAL ||
                          (type == XR_REFERENCE_SPACE_TYPE_STAGE && hasStage(session));
    require(is_known, XR_ERROR_REFERENCE_SPACE_UNSUPPORTED, "no such reference space");
}

// A lost head is nowhere, but for itself; one of which only the turn is known has a place, though not a true one.
XrSpaceLocationFlags locationFlagsOf(const Space& space, const Space& base, const State& state) {
    const auto follows_head = [](const Space& one) { return one.reference == XR_REFERENCE_SPACE_TYPE_VIEW; };
    if (follows_head(space) == follows_head(base) || state.head_place_known) return kPoseKnown;
    if (!state.head_turn_known) return 0;
    return XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
}

std::optional<Pose> baseFromSpace(const Space& space, const Space& base, XrTime time) {
    const State state = space.session.instance.simulation->at(time);
    const std::optional<Pose> stage_from_space = stageFromSpace(space, state), stage_from_base = stageFromSpace(base, state);
    if (!stage_from_space || !stage_from_base) return std::nullopt;
    return compose(inverse(*stage_from_base), *stage_from_space);
}

// Motion of the space's origin, in the base's axes.
void differentiate(const Space& space, const Space& base, XrTime time, XrSpaceVelocity& velocity) {
    velocity = {velocity.type, velocity.next, 0, {}, {}};
    const std::optional<Pose> before = baseFromSpace(space, base, time - kDifference),
                              after = baseFromSpace(space, base, time + kDifference);
    if (!before || !after) return;
    constexpr double kSeconds = 2e-9 * kDifference;
    const glm::dvec3 linear = (after->position - before->position) / kSeconds;
    glm::dquat turn = after->orientation * glm::conjugate(before->orientation);
    if (turn.w < 0) turn = -turn;
    // Small turns: the vector part is half the angle along the axis.
    const glm::dvec3 angular = glm::dvec3(turn.x, turn.y, turn.z) * (2 / kSeconds);
    velocity.velocityFlags = kVelocityKnown;
    velocity.linearVelocity = {static_cast<float>(linear.x), static_cast<float>(linear.y), static_cast<float>(linear.z)};
    velocity.angularVelocity = {static_cast<float>(angular.x), static_cast<float>(angular.y), static_cast<float>(angular.z)};
}

}  // namespace

void checkTime(XrTime time) { require(time > 0, XR_ERROR_TIME_INVALID, "a time is not positive"); }

Space& getSpace(const Session& session, XrSpace space) {
    Space& found = get<Space>(space);
    require(&found.session == &session, XR_ERROR_HANDLE_INVALID, "a space of another session");
    return found;
}

std::optional<Pose> stageFromSpace(const Space& space, const State& state) {
    if (!space.reference) {
        const std::optional<Pose> stage_from_source = stageFromAction(space.session, space.action, space.subaction_path, state);
        if (!stage_from_source) return std::nullopt;
        return compose(*stage_from_source, space.origin_from_space);
    }
    switch (*space.reference) {
        case XR_REFERENCE_SPACE_TYPE_VIEW:
            return compose(state.stage_from_head, space.origin_from_space);
        case XR_REFERENCE_SPACE_TYPE_LOCAL:
            return compose(space.session.instance.simulation->script.stageFromLocal(state.time_s), space.origin_from_space);
        default:
            return space.origin_from_space;
    }
}

const char* nameOf(const Space& space) {
    if (!space.reference) return "action";
    switch (*space.reference) {
        case XR_REFERENCE_SPACE_TYPE_VIEW:
            return "VIEW";
        case XR_REFERENCE_SPACE_TYPE_LOCAL:
            return "LOCAL";
        default:
            return "STAGE";
    }
}

XrResult xrEnumerateReferenceSpaces(XrSession session, uint32_t spaceCapacityInput, uint32_t* spaceCountOutput,
                                    XrReferenceSpaceType* spaces) {
    return answer(__func__, [&] {
        const Session& owner = getSession(session);
        std::vector<XrReferenceSpaceType> offered{XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL};
        if (hasStage(owner)) offered.push_back(XR_REFERENCE_SPACE_TYPE_STAGE);
        fillArray(spaceCapacityInput, spaceCountOutput, spaces, offered);
        return successOf(owner);
    });
}

XrResult xrCreateReferenceSpace(XrSession session, const XrReferenceSpaceCreateInfo* createInfo, XrSpace* space) {
    return answer(__func__, [&] {
        Session& owner = getSession(session);
        const XrReferenceSpaceCreateInfo& info = checked(createInfo, XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
        XrSpace& output = checkedOutput(space);
        checkReferenceType(owner, info.referenceSpaceType);
        checkPose(info.poseInReferenceSpace);
        auto created = std::make_unique<Space>(owner);
        created->origin_from_space = fromXr(info.poseInReferenceSpace);
        created->reference = info.referenceSpaceType;
        output = handleOf(adopt(owner, std::move(created)));
        return successOf(owner);
    });
}

XrResult xrCreateActionSpace(XrSession session, const XrActionSpaceCreateInfo* createInfo, XrSpace* space) {
    return answer(__func__, [&] {
        Session& owner = getSession(session);
        const XrActionSpaceCreateInfo& info = checked(createInfo, XR_TYPE_ACTION_SPACE_CREATE_INFO);
        XrSpace& output = checkedOutput(space);
        const Action& action = getAction(owner.instance, info.action);
        require(action.type == XR_ACTION_TYPE_POSE_INPUT, XR_ERROR_ACTION_TYPE_MISMATCH, "not a pose action");
        checkSubactionPath(owner.instance, action.subaction_paths, info.subactionPath);
        const bool is_left_out = owner.attachment && owner.attachment->find(action.number) == nullptr;
        require(!is_left_out, XR_ERROR_ACTIONSET_NOT_ATTACHED, "the action is not among those attached");
        checkPose(info.poseInActionSpace);
        auto created = std::make_unique<Space>(owner);
        created->origin_from_space = fromXr(info.poseInActionSpace);
        created->action = action.number;
        created->subaction_path = info.subactionPath;
        output = handleOf(adopt(owner, std::move(created)));
        return successOf(owner);
    });
}

XrResult xrGetReferenceSpaceBoundsRect(XrSession session, XrReferenceSpaceType referenceSpaceType, XrExtent2Df* bounds) {
    return answer(__func__, [&] {
        const Session& owner = getSession(session);
        checkReferenceType(owner, referenceSpaceType);
        checkedOutput(bounds) = {0, 0};
        if (referenceSpaceType != XR_REFERENCE_SPACE_TYPE_STAGE) return successOf(owner, XR_SPACE_BOUNDS_UNAVAILABLE);
        *bounds = {3, 2};
        return successOf(owner);
    });
}

XrResult xrLocateSpace(XrSpace space, XrSpace baseSpace, XrTime time, XrSpaceLocation* location) {
    return answer(__func__, [&] {
        const Space& located = get<Space>(space);
        checkNotLost(located.session);
        const Space& base = getSpace(located.session, baseSpace);
        XrSpaceLocation& output = checked(location, XR_TYPE_SPACE_LOCATION);
        checkTime(time);
        output.locationFlags = 0;
        output.pose = toXr(Pose{});
        if (const std::optional<Pose> pose = baseFromSpace(located, base, time)) {
            output.locationFlags = kPoseKnown & locationFlagsOf(located, base, located.session.instance.simulation->at(time));
            if (output.locationFlags != 0) output.pose = toXr(*pose);
        }
        const XrBaseInStructure* const velocity = findInChain(output.next, XR_TYPE_SPACE_VELOCITY);
        if (velocity != nullptr)
            differentiate(located, base, time, *const_cast<XrSpaceVelocity*>(reinterpret_cast<const XrSpaceVelocity*>(velocity)));
        return successOf(located.session);
    });
}

XrResult xrDestroySpace(XrSpace space) {
    return answer(__func__, [&] {
        destroyObject(get<Space>(space));
        return XR_SUCCESS;
    });
}

}  // namespace simulated
