// XR_EXT_hand_tracking: hands that hold the script's controllers; trigger and squeeze close the fingers.
#include <algorithm>
#include <initializer_list>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/poses.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/spaces.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/script/hand_model.h"

namespace simulated {
namespace {

struct HandTracker : SessionChild {
    using Handle = XrHandTrackerEXT;

    Side side;

    HandTracker(Session& owner, Side of_side) : SessionChild(owner), side(of_side) {}
};

// Joints in the base space; empty while the hand is not seen.
std::optional<std::array<HandJoint, kHandJoints>> findJoints(const HandTracker& tracker, const Space& base,
                                                             XrTime time) {
    const State state = tracker.session.at(time);
    const ControllerState& controller = state.controllers[tracker.side];
    const std::optional<Pose> stage_from_base = stageFromSpace(base, state);
    if (!controller.tracked || !stage_from_base) { return std::nullopt; }
    const auto mostOf = [&](std::initializer_list<const char*> inputs) {
        double most = 0;
        for (const char* input : inputs) { most = std::max(most, controller.input(input)); }
        return most;
    };
    auto joints = makeHandJoints(tracker.side, controller.stage_from_grip,
                                 mostOf({"trigger/value", "select/value", "pinch_ext/value",
                                         "aim_activate_ext/value", "grasp_ext/value"}),
                                 mostOf({"squeeze/value", "grasp_ext/value"}));
    for (HandJoint& joint : joints) {
        joint.stage_from_joint = compose(inverse(*stage_from_base), joint.stage_from_joint);
    }
    return joints;
}

void locateJoints(const HandTracker& tracker, const Space& base, XrTime time,
                  XrHandJointLocationsEXT& locations, XrHandJointVelocitiesEXT* velocities) {
    // Hands are seen only while the session has the focus.
    const bool is_seen = tracker.session.is_running && tracker.session.state == XR_SESSION_STATE_FOCUSED;
    const auto now = is_seen ? findJoints(tracker, base, time) : std::nullopt;
    locations.isActive = now ? XR_TRUE : XR_FALSE;
    for (std::size_t i = 0; i < kHandJoints; ++i) {
        XrHandJointLocationEXT& joint = locations.jointLocations[i];
        joint = now ? XrHandJointLocationEXT{kPoseKnown, toXr((*now)[i].stage_from_joint),
                                             static_cast<float>((*now)[i].radius_m)}
                    : XrHandJointLocationEXT{0, toXr(Pose{}), 0};
    }
    if (velocities == nullptr) { return; }
    const auto before = now ? findJoints(tracker, base, time - kMotionStep) : std::nullopt;
    const auto after = now ? findJoints(tracker, base, time + kMotionStep) : std::nullopt;
    for (std::size_t i = 0; i < kHandJoints; ++i) {
        XrHandJointVelocityEXT& joint = velocities->jointVelocities[i];
        joint = {0, {0, 0, 0}, {0, 0, 0}};
        if (!before || !after) { continue; }
        const Motion motion = motionOf((*before)[i].stage_from_joint, (*after)[i].stage_from_joint);
        joint = {kVelocityKnown, motion.linear_m_s, motion.angular_rad_s};
    }
}

}  // namespace

XrResult xrCreateHandTrackerEXT(XrSession session, const XrHandTrackerCreateInfoEXT* createInfo,
                                XrHandTrackerEXT* handTracker) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const auto& info = checkStruct(createInfo, XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT);
        XrHandTrackerEXT& output = checkOutput(handTracker);
        require(info.hand == XR_HAND_LEFT_EXT || info.hand == XR_HAND_RIGHT_EXT, XR_ERROR_VALIDATION_FAILURE,
                "the hand is ", info.hand, ", must be left or right");
        require(info.handJointSet == XR_HAND_JOINT_SET_DEFAULT_EXT, XR_ERROR_VALIDATION_FAILURE,
                "the set of joints is ", info.handJointSet, ", must be the default");
        output = handleOf(adopt(
            owner, std::make_unique<HandTracker>(owner, info.hand == XR_HAND_LEFT_EXT ? kLeft : kRight)));
    });
}

XrResult xrDestroyHandTrackerEXT(XrHandTrackerEXT handTracker) {
    return answer(__func__, [&] { destroyObject(get<HandTracker>(handTracker)); });
}

XrResult xrLocateHandJointsEXT(XrHandTrackerEXT handTracker, const XrHandJointsLocateInfoEXT* locateInfo,
                               XrHandJointLocationsEXT* locations) {
    return answerFor<HandTracker>(__func__, handTracker, [&](const HandTracker& tracker) {
        const auto& info = checkStruct(locateInfo, XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT);
        auto& output = checkStruct(locations, XR_TYPE_HAND_JOINT_LOCATIONS_EXT);
        require(output.jointCount == kHandJoints && output.jointLocations != nullptr,
                XR_ERROR_VALIDATION_FAILURE, output.jointCount, " locations, a hand has ", kHandJoints,
                " joints");
        auto* const velocities =
            findInChain<XrHandJointVelocitiesEXT>(output.next, XR_TYPE_HAND_JOINT_VELOCITIES_EXT);
        require(velocities == nullptr ||
                    (velocities->jointCount == kHandJoints && velocities->jointVelocities != nullptr),
                XR_ERROR_VALIDATION_FAILURE, "not as many velocities as a hand has joints, ", kHandJoints);
        const Space& base = getSpace(tracker.session, info.baseSpace);
        checkTime(info.time);
        locateJoints(tracker, base, info.time, output, velocities);
    });
}

}  // namespace simulated
