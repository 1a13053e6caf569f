// Asking for joints.
#include "xr/extensions/hand_tracking.h"

#include "xr/convert.h"

#include <algorithm>

namespace binosplat::xr {

bool findsHands(const Instance& instance) {
    if (!instance.hasExtension(XR_EXT_HAND_TRACKING_EXTENSION_NAME)) { return false; }
    auto hands = structure<XrSystemHandTrackingPropertiesEXT>(XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT);
    instance.troubles().tryFor("hand tracking", [&] { instance.readProperties(&hands); });
    return hands.supportsHandTracking == XR_TRUE;
}

HandTracking::HandTracking(const Session& session) : session_(session) {
    const Instance& instance = session.instance();
    if (!instance.tracksHands()) { return; }
    instance.troubles().tryFor("hand tracking", [&] {
        const auto create = instance.function<PFN_xrCreateHandTrackerEXT>("xrCreateHandTrackerEXT");
        const auto destroy = instance.function<PFN_xrDestroyHandTrackerEXT>("xrDestroyHandTrackerEXT");
        locate_ = instance.function<PFN_xrLocateHandJointsEXT>("xrLocateHandJointsEXT");
        for (std::size_t h = 0; h < 2; ++h) {
            auto info = structure<XrHandTrackerCreateInfoEXT>(XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT);
            info.hand = h == kLeft ? XR_HAND_LEFT_EXT : XR_HAND_RIGHT_EXT;
            info.handJointSet = XR_HAND_JOINT_SET_DEFAULT_EXT;
            // A runtime may offer hand tracking that this headset or its wearer does not allow; then
            // controllers are drawn.
            XrHandTrackerEXT made = XR_NULL_HANDLE;
            checkResult(create(session.handle(), &info, &made), "xrCreateHandTrackerEXT");
            trackers_[h] = Tracker(made, destroy);
        }
    });
}

std::optional<HandJoints> HandTracking::locate(int hand) {
    Tracker& tracker = trackers_[static_cast<std::size_t>(hand)];
    if (!tracker) { return std::nullopt; }
    std::array<XrHandJointLocationEXT, XR_HAND_JOINT_COUNT_EXT> found{};
    auto info = structure<XrHandJointsLocateInfoEXT>(XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT);
    info.baseSpace = session_.space();
    info.time = session_.displayTime();
    auto locations = structure<XrHandJointLocationsEXT>(XR_TYPE_HAND_JOINT_LOCATIONS_EXT);
    locations.jointCount = XR_HAND_JOINT_COUNT_EXT;
    locations.jointLocations = found.data();
    const auto ask = [&] { checkResult(locate_(tracker.get(), &info, &locations), "xrLocateHandJointsEXT"); };
    if (!session_.instance().troubles().tryFor("hand tracking", ask)) {
        tracker.reset();
        return std::nullopt;
    }
    const auto isKnown = [](const XrHandJointLocationEXT& joint) {
        return (joint.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) != 0;
    };
    if (locations.isActive != XR_TRUE || !std::ranges::all_of(found, isKnown)) { return std::nullopt; }
    HandJoints joints;
    std::ranges::transform(found, joints.begin(), [](const XrHandJointLocationEXT& joint) {
        return HandJoint{fromXr(joint.pose.position), static_cast<double>(joint.radius)};
    });
    return joints;
}

}  // namespace binosplat::xr
