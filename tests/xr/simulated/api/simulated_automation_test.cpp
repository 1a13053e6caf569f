// XR_EXT_conformance_automation on the simulated runtime: a program's own test moves inputs, poses and profiles from inside.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <cmath>

TEST_SUITE_BEGIN("simulated_automation");

namespace simulated_automation_test {

using namespace binosplat::test;

namespace {

constexpr const char* kTouch = "/interaction_profiles/oculus/touch_controller";
constexpr const char* kSimple = "/interaction_profiles/khr/simple_controller";
constexpr const char* kXbox = "/interaction_profiles/microsoft/xbox_controller";

struct AutomationFixture : SessionFixture {
    PFN_xrSetInputDeviceActiveEXT setActive = function<PFN_xrSetInputDeviceActiveEXT>("xrSetInputDeviceActiveEXT");
    PFN_xrSetInputDeviceStateBoolEXT setBool = function<PFN_xrSetInputDeviceStateBoolEXT>("xrSetInputDeviceStateBoolEXT");
    PFN_xrSetInputDeviceStateFloatEXT setFloat = function<PFN_xrSetInputDeviceStateFloatEXT>("xrSetInputDeviceStateFloatEXT");
    PFN_xrSetInputDeviceStateVector2fEXT setVector = function<PFN_xrSetInputDeviceStateVector2fEXT>("xrSetInputDeviceStateVector2fEXT");
    PFN_xrSetInputDeviceLocationEXT setLocation = function<PFN_xrSetInputDeviceLocationEXT>("xrSetInputDeviceLocationEXT");
    XrPath left = path("/user/hand/left"), right = path("/user/hand/right"), gamepad = path("/user/gamepad");
    XrActionSet set = makeActionSet("walking");
    XrAction jump = makeAction(set, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT, {left, right, gamepad});
    XrAction pull = makeAction(set, "pull", XR_ACTION_TYPE_FLOAT_INPUT, {left, right});
    XrAction stick = makeAction(set, "stick", XR_ACTION_TYPE_VECTOR2F_INPUT);
    XrAction grip = makeAction(set, "grip", XR_ACTION_TYPE_POSE_INPUT, {left, right});

    AutomationFixture()
        : SessionFixture("size 64 64\nframes none\naxis left trigger 0 0.25\n", {XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME}) {
        REQUIRE(suggest(kTouch, {{jump, path("/user/hand/left/input/x/click")},
                                 {jump, path("/user/hand/right/input/a/click")},
                                 {pull, path("/user/hand/left/input/trigger/value")},
                                 {pull, path("/user/hand/right/input/trigger/value")},
                                 {stick, path("/user/hand/right/input/thumbstick")},
                                 {grip, path("/user/hand/left/input/grip/pose")}}) == XR_SUCCESS);
        REQUIRE(suggest(kSimple, {{jump, path("/user/hand/left/input/select/click")},
                                  {jump, path("/user/hand/right/input/select/click")}}) == XR_SUCCESS);
        REQUIRE(suggest(kXbox, {{jump, path("/user/gamepad/input/a/click")}}) == XR_SUCCESS);
        attach({set});
        focus();
        REQUIRE(sync(set) == XR_SUCCESS);
        states();
    }

    XrActionStateBoolean jumps(XrPath hand) const {
        XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
        const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, jump, hand};
        REQUIRE(xrGetActionStateBoolean(session, &get, &state) == XR_SUCCESS);
        return state;
    }
    float pulls(XrPath hand) const {
        XrActionStateFloat state{XR_TYPE_ACTION_STATE_FLOAT};
        const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, pull, hand};
        REQUIRE(xrGetActionStateFloat(session, &get, &state) == XR_SUCCESS);
        return state.currentState;
    }
    std::string profile(XrPath user_path) const {
        XrInteractionProfileState state{XR_TYPE_INTERACTION_PROFILE_STATE};
        REQUIRE(xrGetCurrentInteractionProfile(session, user_path, &state) == XR_SUCCESS);
        if (state.interactionProfile == XR_NULL_PATH) return "none";
        char text[XR_MAX_PATH_LENGTH];
        std::uint32_t count = 0;
        REQUIRE(xrPathToString(instance, state.interactionProfile, sizeof text, &count, text) == XR_SUCCESS);
        return text;
    }
    bool isAnnounced() const {
        XrEventDataBuffer event;
        return poll(event) == XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED;
    }
};

// A pose that is bound in both hands, and a space on it that names neither.
struct EitherHandFixture : SessionFixture {
    PFN_xrSetInputDeviceActiveEXT setActive = function<PFN_xrSetInputDeviceActiveEXT>("xrSetInputDeviceActiveEXT");
    XrPath left = path("/user/hand/left"), right = path("/user/hand/right");
    XrActionSet set = makeActionSet("walking");
    XrSpace space = XR_NULL_HANDLE;

    EitherHandFixture() : SessionFixture(kQuietScript, {XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME}) {
        const XrAction grip = makeAction(set, "grip", XR_ACTION_TYPE_POSE_INPUT, {left, right});
        REQUIRE(suggest(kTouch, {{grip, path("/user/hand/left/input/grip/pose")}, {grip, path("/user/hand/right/input/grip/pose")}}) ==
                XR_SUCCESS);
        const XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, grip, XR_NULL_PATH, kIdentity};
        REQUIRE(xrCreateActionSpace(session, &info, &space) == XR_SUCCESS);
        attach({set});
        focus();
    }

    void switchOff(XrPath hand) const { REQUIRE(setActive(session, path(kTouch), hand, XR_FALSE) == XR_SUCCESS); }

    std::string whoIsFollowed() const {
        XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
        REQUIRE(xrLocateSpace(space, local, frame().predictedDisplayTime, &location) == XR_SUCCESS);
        if ((location.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) == 0) return "nobody";
        return location.pose.position.x < 0 ? "left" : "right";
    }
};

}  // namespace

TEST_CASE_FIXTURE(AutomationFixture, "what is set is read after the next xrSyncActions, and the script goes on with the rest") {
    CHECK(setBool(session, right, path("/user/hand/right/input/a/click"), XR_TRUE) == XR_SUCCESS);
    CHECK(setFloat(session, right, path("/user/hand/right/input/trigger/value"), 0.75f) == XR_SUCCESS);
    CHECK(setVector(session, right, path("/user/hand/right/input/thumbstick"), {0.5f, -1}) == XR_SUCCESS);
    CHECK(jumps(right).currentState == XR_FALSE);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(jumps(right).currentState == XR_TRUE);
    CHECK(jumps(right).changedSinceLastSync == XR_TRUE);
    CHECK(jumps(left).currentState == XR_FALSE);
    CHECK(pulls(right) == 0.75f);
    CHECK(pulls(left) == 0.25f);
    XrActionStateVector2f state{XR_TYPE_ACTION_STATE_VECTOR2F};
    const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, stick, XR_NULL_PATH};
    CHECK(xrGetActionStateVector2f(session, &get, &state) == XR_SUCCESS);
    CHECK(state.currentState.x == 0.5f);
    CHECK(state.currentState.y == -1);
    CHECK(setBool(session, right, path("/user/hand/right/input/a/click"), XR_FALSE) == XR_SUCCESS);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(jumps(right).currentState == XR_FALSE);
}

TEST_CASE_FIXTURE(AutomationFixture, "devices take up profiles, one by one, and are switched off") {
    CHECK(profile(left) == kTouch);
    CHECK(profile(gamepad) == "none");
    CHECK(setActive(session, path(kSimple), left, XR_TRUE) == XR_SUCCESS);
    CHECK(profile(left) == kTouch);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(isAnnounced());
    CHECK(profile(left) == kSimple);
    CHECK(profile(right) == kTouch);
    CHECK(setBool(session, left, path("/user/hand/left/input/select/click"), XR_TRUE) == XR_SUCCESS);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK_FALSE(isAnnounced());
    CHECK(jumps(left).currentState == XR_TRUE);
    CHECK_MESSAGE(pulls(left) == 0, "the simple controller has no trigger");
    CHECK(setActive(session, path(kSimple), left, XR_FALSE) == XR_SUCCESS);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(jumps(left).isActive == XR_FALSE);
    CHECK(jumps(right).isActive == XR_TRUE);
    // There is a gamepad as soon as somebody says so.
    CHECK(jumps(gamepad).isActive == XR_FALSE);
    CHECK(setActive(session, path(kXbox), gamepad, XR_TRUE) == XR_SUCCESS);
    CHECK(setBool(session, gamepad, path("/user/gamepad/input/a/click"), XR_TRUE) == XR_SUCCESS);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(profile(gamepad) == kXbox);
    CHECK(jumps(gamepad).currentState == XR_TRUE);
    // A profile that the program has no bindings for.
    CHECK(setActive(session, path("/interaction_profiles/valve/index_controller"), right, XR_TRUE) == XR_SUCCESS);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(profile(right) == "none");
    CHECK(jumps(right).isActive == XR_FALSE);
}

TEST_CASE_FIXTURE(AutomationFixture, "a pose is put where it is said to be, in any space") {
    const XrSpace stage = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    const XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, grip, left, kIdentity};
    XrSpace space = XR_NULL_HANDLE;
    REQUIRE(xrCreateActionSpace(session, &info, &space) == XR_SUCCESS);
    XrPosef pose = kIdentity;
    pose.position = {1, 2, 3};
    CHECK(setLocation(session, left, path("/user/hand/left/input/grip/pose"), local, pose) == XR_SUCCESS);
    CHECK(sync(set) == XR_SUCCESS);
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    CHECK(xrLocateSpace(space, stage, waitFrame().predictedDisplayTime, &location) == XR_SUCCESS);
    CHECK(location.pose.position.x == doctest::Approx(1));
    CHECK(location.pose.position.y == doctest::Approx(3.6));
    CHECK(location.pose.position.z == doctest::Approx(3));
}

TEST_CASE_FIXTURE(EitherHandFixture, "a pose of either hand is that of a hand that is there") {
    switchOff(left);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "right");
    // It stays there when there are both.
    CHECK(setActive(session, path(kTouch), left, XR_TRUE) == XR_SUCCESS);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "right");
}

TEST_CASE_FIXTURE(EitherHandFixture, "a pose of either hand stays with its hand, though that is put down") {
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "left");
    switchOff(left);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "nobody");
    CHECK(setActive(session, path(kTouch), left, XR_TRUE) == XR_SUCCESS);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "left");
}

TEST_CASE_FIXTURE(EitherHandFixture, "a pose of either hand goes to the hand that is synchronized") {
    CHECK(sync(set, left) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "left");
    CHECK(sync(set, right) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "right");
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "right");
    switchOff(left);
    CHECK(sync(set, left) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "nobody");
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(whoIsFollowed() == "right");
}

TEST_CASE_FIXTURE(AutomationFixture, "there is no input that the device's profile lacks") {
    const XrPath trigger = path("/user/hand/right/input/trigger/value");
    CHECK(setFloat(session, right, path("/user/hand/right/input/nose/value"), 1) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setFloat(session, left, trigger, 1) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setFloat(session, path("/user/treadmill"), trigger, 1) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setFloat(session, XR_NULL_PATH, trigger, 1) == XR_ERROR_PATH_INVALID);
    CHECK(setFloat(session, right, 123456, 1) == XR_ERROR_PATH_INVALID);
    CHECK(setFloat(session, right, trigger, NAN) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(setFloat(XR_NULL_HANDLE, right, trigger, 1) == XR_ERROR_HANDLE_INVALID);
    CHECK(setVector(session, right, trigger, {0, 0}) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setActive(session, path(kSimple), right, XR_TRUE) == XR_SUCCESS);
    CHECK(setFloat(session, right, trigger, 1) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setActive(session, path(kXbox), right, XR_TRUE) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setActive(session, path("/interaction_profiles/nobody/nothing"), right, XR_TRUE) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setActive(session, XR_NULL_PATH, right, XR_TRUE) == XR_ERROR_PATH_INVALID);
    XrPosef pose = kIdentity;
    const XrPath grip_path = path("/user/hand/left/input/grip/pose");
    CHECK(setLocation(session, left, trigger, local, pose) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setLocation(session, left, path("/user/hand/left/input/trigger/value"), local, pose) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(setLocation(session, left, grip_path, XR_NULL_HANDLE, pose) == XR_ERROR_HANDLE_INVALID);
    pose.orientation.w = 0;
    CHECK(setLocation(session, left, grip_path, local, pose) == XR_ERROR_POSE_INVALID);
}

}  // namespace simulated_automation_test
