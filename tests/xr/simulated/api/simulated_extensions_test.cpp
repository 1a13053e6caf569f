// Extensions of the simulated runtime that need no graphics, in headless sessions and without a loader.
#include "tests/xr/simulated/api/simulated_direct.h"

#include <cmath>
#include <limits>

TEST_SUITE_BEGIN("simulated_extensions");

namespace simulated_extensions_test {

using namespace binosplat::test;

namespace {

constexpr XrTime kStart = 1'000'000'000;

std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * 1'000'000'000LL + time.tv_nsec; }

std::vector<bool> presences(const HeadlessSession& made) {
    std::vector<bool> found;
    const auto poll = made.xr<PFN_xrPollEvent>("xrPollEvent");
    for (XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER}; poll(made.instance, &event) == XR_SUCCESS;
         event = {XR_TYPE_EVENT_DATA_BUFFER}) {
        if (event.type != XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT) continue;
        const auto& change = reinterpret_cast<const XrEventDataUserPresenceChangedEXT&>(event);
        CHECK(change.session == made.session);
        found.push_back(change.isUserPresent == XR_TRUE);
    }
    return found;
}

}  // namespace

TEST_CASE("extensions have no functions for instances that did not enable them") {
    const DirectInstance made(k1_1, {});
    for (const char* name : {"xrCreateDebugUtilsMessengerEXT", "xrConvertTimespecTimeToTimeKHR", "xrCreateHandTrackerEXT",
                             "xrGetDisplayRefreshRateFB", "xrSetInputDeviceActiveEXT"}) {
        CHECK_FALSE(made.has(name));
    }
}

TEST_CASE("time is converted to CLOCK_MONOTONIC and back") {
    const HeadlessSession made(k1_0, {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME});
    const auto toTime = made.xr<PFN_xrConvertTimespecTimeToTimeKHR>("xrConvertTimespecTimeToTimeKHR");
    const auto toTimespec = made.xr<PFN_xrConvertTimeToTimespecTimeKHR>("xrConvertTimeToTimespecTimeKHR");
    timespec now{}, back{};
    REQUIRE(clock_gettime(CLOCK_MONOTONIC, &now) == 0);
    XrTime time = 0, later = 0;
    CHECK(toTime(made.instance, &now, &time) == XR_SUCCESS);
    CHECK(toTimespec(made.instance, time, &back) == XR_SUCCESS);
    CHECK(nanoseconds(back) == nanoseconds(now));
    // In lock-step the two meet when they are first asked for: OpenXR's time has not begun to move.
    CHECK(time <= kStart);
    CHECK(time > 0);
    now.tv_sec += 2;
    CHECK(toTime(made.instance, &now, &later) == XR_SUCCESS);
    CHECK(later - time == 2'000'000'000);

    CHECK(toTimespec(made.instance, 0, &back) == XR_ERROR_TIME_INVALID);
    CHECK(toTimespec(made.instance, -1, &back) == XR_ERROR_TIME_INVALID);
    CHECK(toTimespec(made.instance, std::numeric_limits<XrTime>::max(), &back) == XR_ERROR_TIME_INVALID);
    CHECK(toTimespec(made.instance, time, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(toTime(made.instance, nullptr, &time) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(toTime(made.instance, &now, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(toTime(XR_NULL_HANDLE, &now, &time) == XR_ERROR_HANDLE_INVALID);
    CHECK(toTimespec(XR_NULL_HANDLE, time, &back) == XR_ERROR_HANDLE_INVALID);
    for (const timespec bad : {timespec{0, 0}, timespec{-1, 0}, timespec{now.tv_sec, 1'000'000'000}, timespec{now.tv_sec, -1}}) {
        CHECK(toTime(made.instance, &bad, &time) == XR_ERROR_TIME_INVALID);
    }
}

TEST_CASE("with the real clock OpenXR's time and CLOCK_MONOTONIC go alike, also before the first frame") {
    setenv("SIMULATED_OPENXR_CLOCK", "real", 1);
    {
        const HeadlessSession made(k1_0, {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME});
        const auto toTime = made.xr<PFN_xrConvertTimespecTimeToTimeKHR>("xrConvertTimespecTimeToTimeKHR");
        timespec before{}, after{};
        XrTime begun = 0, later = 0;
        REQUIRE(clock_gettime(CLOCK_MONOTONIC, &before) == 0);
        REQUIRE(toTime(made.instance, &before, &begun) == XR_SUCCESS);
        made.begin();
        REQUIRE(made.sync() == XR_SUCCESS);
        REQUIRE(clock_gettime(CLOCK_MONOTONIC, &after) == 0);
        REQUIRE(toTime(made.instance, &after, &later) == XR_SUCCESS);
        CHECK(later - begun == nanoseconds(after) - nanoseconds(before));
        CHECK(later >= kStart);
    }
    unsetenv("SIMULATED_OPENXR_CLOCK");
}

TEST_CASE("the application is told whether somebody wears the headset: when the session begins, and when that changes") {
    const HeadlessSession made(k1_0, {XR_EXT_USER_PRESENCE_EXTENSION_NAME}, "rate 10\nat 0.15 present off\nat 0.35 present on\n");
    XrSystemUserPresencePropertiesEXT presence{XR_TYPE_SYSTEM_USER_PRESENCE_PROPERTIES_EXT, nullptr, XR_FALSE};
    XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES, &presence};
    CHECK(made.xr<PFN_xrGetSystemProperties>("xrGetSystemProperties")(made.instance, made.system, &properties) == XR_SUCCESS);
    CHECK(presence.supportsUserPresence == XR_TRUE);
    CHECK(presences(made).empty());
    made.begin();
    CHECK(presences(made) == std::vector<bool>{true});
    for (int i = 0; i < 3; ++i) made.sync();
    CHECK(presences(made) == std::vector<bool>{false});
    for (int i = 0; i < 3; ++i) made.sync();
    CHECK(presences(made) == std::vector<bool>{true});
}

TEST_CASE("without its extension nobody hears of the wearer") {
    const HeadlessSession made(k1_0, {}, "rate 10\nat 0.15 present off\n");
    made.begin();
    for (int i = 0; i < 3; ++i) made.sync();
    CHECK(presences(made).empty());
}

TEST_CASE("a display whose rate is fixed lists that one") {
    const HeadlessSession made(k1_0, {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME}, "rate 80 fixed\n");
    std::uint32_t count = 0;
    std::vector<float> rates(8);
    CHECK(made.xr<PFN_xrEnumerateDisplayRefreshRatesFB>("xrEnumerateDisplayRefreshRatesFB")(made.session, 8, &count, rates.data()) ==
          XR_SUCCESS);
    rates.resize(count);
    CHECK(rates == std::vector<float>{80});
    const auto request = made.xr<PFN_xrRequestDisplayRefreshRateFB>("xrRequestDisplayRefreshRateFB");
    CHECK(request(made.session, 80) == XR_SUCCESS);
    CHECK(request(made.session, 0) == XR_SUCCESS);
    CHECK(request(made.session, 90) == XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB);
}

TEST_CASE("the display's rate is one of a list, and the frames after it go by it") {
    const HeadlessSession made(k1_0, {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME}, "rate 100\n");
    const auto enumerate = made.xr<PFN_xrEnumerateDisplayRefreshRatesFB>("xrEnumerateDisplayRefreshRatesFB");
    const auto current = made.xr<PFN_xrGetDisplayRefreshRateFB>("xrGetDisplayRefreshRateFB");
    const auto request = made.xr<PFN_xrRequestDisplayRefreshRateFB>("xrRequestDisplayRefreshRateFB");
    std::uint32_t count = 0;
    CHECK(enumerate(made.session, 0, &count, nullptr) == XR_SUCCESS);
    std::vector<float> rates(count);
    CHECK(enumerate(made.session, count, &count, rates.data()) == XR_SUCCESS);
    CHECK(rates == std::vector<float>{72, 80, 90, 100, 120});
    CHECK(enumerate(made.session, 2, &count, rates.data()) == XR_ERROR_SIZE_INSUFFICIENT);
    float rate = 0;
    CHECK(current(made.session, &rate) == XR_SUCCESS);
    CHECK(rate == 100);
    CHECK(request(made.session, 75) == XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB);
    CHECK(request(made.session, NAN) == XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB);
    made.states();
    CHECK(request(made.session, 80) == XR_SUCCESS);
    CHECK(request(made.session, 80) == XR_SUCCESS);
    const auto poll = made.xr<PFN_xrPollEvent>("xrPollEvent");
    XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
    REQUIRE(poll(made.instance, &event) == XR_SUCCESS);
    REQUIRE(event.type == XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB);
    const auto& change = reinterpret_cast<const XrEventDataDisplayRefreshRateChangedFB&>(event);
    CHECK(change.fromDisplayRefreshRate == 100);
    CHECK(change.toDisplayRefreshRate == 80);
    event = {XR_TYPE_EVENT_DATA_BUFFER};
    CHECK(poll(made.instance, &event) == XR_EVENT_UNAVAILABLE);
    CHECK(current(made.session, &rate) == XR_SUCCESS);
    CHECK(rate == 80);
    CHECK(request(made.session, 0) == XR_SUCCESS);
    CHECK(current(made.session, &rate) == XR_SUCCESS);
    CHECK(rate == 100);
    CHECK(current(made.session, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(current(XR_NULL_HANDLE, &rate) == XR_ERROR_HANDLE_INVALID);
    CHECK(request(XR_NULL_HANDLE, 80) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE("hands hold the script's controllers, in focus and while they are tracked") {
    const HeadlessSession made(k1_0, {XR_EXT_HAND_TRACKING_EXTENSION_NAME},
                               "rate 10\ncontroller left 0 position -0.2 1 0\ncontroller left 1 position 0.8 1 0\naxis right trigger 0 1\n"
                               "at 0.25 controller right off\n");
    XrSystemHandTrackingPropertiesEXT hands{XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT};
    XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES, &hands};
    CHECK(made.xr<PFN_xrGetSystemProperties>("xrGetSystemProperties")(made.instance, made.system, &properties) == XR_SUCCESS);
    CHECK(hands.supportsHandTracking == XR_TRUE);

    const auto create = made.xr<PFN_xrCreateHandTrackerEXT>("xrCreateHandTrackerEXT");
    const auto locate = made.xr<PFN_xrLocateHandJointsEXT>("xrLocateHandJointsEXT");
    XrHandTrackerCreateInfoEXT info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT, nullptr, XR_HAND_LEFT_EXT, XR_HAND_JOINT_SET_DEFAULT_EXT};
    XrHandTrackerEXT left = XR_NULL_HANDLE, right = XR_NULL_HANDLE, none = XR_NULL_HANDLE;
    CHECK(create(made.session, &info, &left) == XR_SUCCESS);
    info.hand = XR_HAND_RIGHT_EXT;
    CHECK(create(made.session, &info, &right) == XR_SUCCESS);
    info.hand = static_cast<XrHandEXT>(3);
    CHECK(create(made.session, &info, &none) == XR_ERROR_VALIDATION_FAILURE);
    info.hand = XR_HAND_LEFT_EXT;
    info.handJointSet = static_cast<XrHandJointSetEXT>(1);
    CHECK(create(made.session, &info, &none) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(create(made.session, nullptr, &none) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(create(XR_NULL_HANDLE, &info, &none) == XR_ERROR_HANDLE_INVALID);

    XrHandJointLocationEXT joints[XR_HAND_JOINT_COUNT_EXT];
    XrHandJointVelocityEXT speeds[XR_HAND_JOINT_COUNT_EXT];
    XrHandJointVelocitiesEXT velocities{XR_TYPE_HAND_JOINT_VELOCITIES_EXT, nullptr, XR_HAND_JOINT_COUNT_EXT, speeds};
    XrHandJointLocationsEXT locations{XR_TYPE_HAND_JOINT_LOCATIONS_EXT, &velocities, XR_TRUE, XR_HAND_JOINT_COUNT_EXT, joints};
    XrHandJointsLocateInfoEXT where{XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT, nullptr, made.space(XR_REFERENCE_SPACE_TYPE_STAGE),
                                    kStart + 100'000'000};
    CHECK(locate(left, &where, &locations) == XR_SUCCESS);
    CHECK_MESSAGE(locations.isActive == XR_FALSE, "not in focus yet");
    CHECK(joints[3].locationFlags == 0);
    made.begin();
    CHECK(locate(left, &where, &locations) == XR_SUCCESS);
    CHECK(locations.isActive == XR_TRUE);
    // The palm lies beside the grip pose, at -0.1 1 0, and moves a metre a second.
    CHECK(joints[XR_HAND_JOINT_PALM_EXT].pose.position.x == doctest::Approx(-0.12));
    CHECK(joints[XR_HAND_JOINT_PALM_EXT].pose.position.y == doctest::Approx(1));
    for (const auto& joint : joints) {
        CHECK(joint.locationFlags == 15);
        CHECK(joint.radius > 0);
    }
    for (const auto& speed : speeds) CHECK(speed.linearVelocity.x == doctest::Approx(1));
    const auto reach = [&](XrHandTrackerEXT hand, XrHandJointEXT tip, XrHandJointEXT from) {
        REQUIRE(locate(hand, &where, &locations) == XR_SUCCESS);
        const XrVector3f &a = joints[tip].pose.position, &b = joints[from].pose.position;
        return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    };
    // The right trigger is pulled: its index finger is bent, no other.
    const double straight = reach(left, XR_HAND_JOINT_INDEX_TIP_EXT, XR_HAND_JOINT_INDEX_PROXIMAL_EXT);
    CHECK(straight == doctest::Approx(0.085));
    CHECK(reach(right, XR_HAND_JOINT_INDEX_TIP_EXT, XR_HAND_JOINT_INDEX_PROXIMAL_EXT) < 0.6 * straight);
    CHECK(reach(right, XR_HAND_JOINT_LITTLE_TIP_EXT, XR_HAND_JOINT_LITTLE_PROXIMAL_EXT) == doctest::Approx(0.07));
    where.time = kStart + 300'000'000;
    CHECK(locate(right, &where, &locations) == XR_SUCCESS);
    CHECK(locations.isActive == XR_FALSE);

    locations.jointCount = 25;
    CHECK(locate(left, &where, &locations) == XR_ERROR_VALIDATION_FAILURE);
    locations.jointCount = 26;
    velocities.jointCount = 25;
    CHECK(locate(left, &where, &locations) == XR_ERROR_VALIDATION_FAILURE);
    velocities.jointCount = 26;
    where.time = 0;
    CHECK(locate(left, &where, &locations) == XR_ERROR_TIME_INVALID);
    where.time = kStart;
    where.baseSpace = XR_NULL_HANDLE;
    CHECK(locate(left, &where, &locations) == XR_ERROR_HANDLE_INVALID);
    const auto destroy = made.xr<PFN_xrDestroyHandTrackerEXT>("xrDestroyHandTrackerEXT");
    CHECK(destroy(left) == XR_SUCCESS);
    CHECK(destroy(left) == XR_ERROR_HANDLE_INVALID);
    CHECK(locate(left, &where, &locations) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE("the joints of a hand turn with its controller, and those of a finger that bends with that, too") {
    const HeadlessSession made(k1_0, {XR_EXT_HAND_TRACKING_EXTENSION_NAME},
                               "rate 10\ncontroller left 0 position 0 1 0 turn 0 0\ncontroller left 1 position 0 1 0 turn 45 0\n"
                               "axis right trigger 0 0\naxis right trigger 1 1\n");
    made.begin();
    XrHandJointLocationEXT joints[XR_HAND_JOINT_COUNT_EXT];
    XrHandJointVelocityEXT speeds[XR_HAND_JOINT_COUNT_EXT];
    const auto locate = [&](XrHandEXT side) {
        const XrHandTrackerCreateInfoEXT info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT, nullptr, side, XR_HAND_JOINT_SET_DEFAULT_EXT};
        XrHandTrackerEXT hand = XR_NULL_HANDLE;
        REQUIRE(made.xr<PFN_xrCreateHandTrackerEXT>("xrCreateHandTrackerEXT")(made.session, &info, &hand) == XR_SUCCESS);
        XrHandJointVelocitiesEXT velocities{XR_TYPE_HAND_JOINT_VELOCITIES_EXT, nullptr, XR_HAND_JOINT_COUNT_EXT, speeds};
        XrHandJointLocationsEXT locations{XR_TYPE_HAND_JOINT_LOCATIONS_EXT, &velocities, XR_FALSE, XR_HAND_JOINT_COUNT_EXT, joints};
        const XrHandJointsLocateInfoEXT where{XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT, nullptr, made.space(XR_REFERENCE_SPACE_TYPE_STAGE),
                                              kStart + 500'000'000};
        REQUIRE(made.xr<PFN_xrLocateHandJointsEXT>("xrLocateHandJointsEXT")(hand, &where, &locations) == XR_SUCCESS);
        REQUIRE(locations.isActive == XR_TRUE);
        for (const auto& speed : speeds)
            CHECK(speed.velocityFlags == (XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT));
    };
    const auto turning = [&](XrHandJointEXT joint) {
        const XrVector3f& speed = speeds[joint].angularVelocity;
        return std::hypot(speed.x, speed.y, speed.z);
    };
    // A quarter of pi in a second, to the left, which is about +y.
    locate(XR_HAND_LEFT_EXT);
    for (const auto& speed : speeds) {
        CHECK(speed.angularVelocity.x == doctest::Approx(0));
        CHECK(speed.angularVelocity.y == doctest::Approx(0.25 * 3.14159265).epsilon(1e-3));
        CHECK(speed.angularVelocity.z == doctest::Approx(0));
    }
    locate(XR_HAND_RIGHT_EXT);
    CHECK(turning(XR_HAND_JOINT_INDEX_TIP_EXT) > 1);
    CHECK(turning(XR_HAND_JOINT_LITTLE_TIP_EXT) == doctest::Approx(0));
}

}  // namespace simulated_extensions_test
