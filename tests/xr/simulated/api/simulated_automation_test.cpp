// A program's own test moves inputs from inside (XR_EXT_conformance_automation), and where the wearer looks
// (XR_EXT_eye_gaze_interaction).
#include "tests/xr/simulated/api/simulated_fixture.h"

SUITE(simulated_automation) {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr const char* kXbox = "/interaction_profiles/microsoft/xbox_controller";
constexpr const char* kEyes = "/interaction_profiles/ext/eye_gaze_interaction";

struct AutomationFixture : SessionFixture {
    PFN_xrSetInputDeviceActiveEXT setActive = XR(xrSetInputDeviceActiveEXT);
    PFN_xrSetInputDeviceStateBoolEXT setBool = XR(xrSetInputDeviceStateBoolEXT);
    PFN_xrSetInputDeviceStateFloatEXT setFloat = XR(xrSetInputDeviceStateFloatEXT);
    PFN_xrSetInputDeviceStateVector2fEXT setVector = XR(xrSetInputDeviceStateVector2fEXT);
    PFN_xrSetInputDeviceLocationEXT setLocation = XR(xrSetInputDeviceLocationEXT);
    XrPath gamepad = path("/user/gamepad"), right_trigger = path("/user/hand/right/input/trigger/value"),
           left_grip = path("/user/hand/left/input/grip/pose");
    XrActionSet set = makeActionSet("walking");
    XrAction jump = makeAction(set, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT, {left, right, gamepad});
    XrAction pull = makeAction(set, "pull", XR_ACTION_TYPE_FLOAT_INPUT, {left, right});
    XrAction stick = makeAction(set, "stick", XR_ACTION_TYPE_VECTOR2F_INPUT);
    XrAction grip = makeAction(set, "grip", XR_ACTION_TYPE_POSE_INPUT, {left, right});

    explicit AutomationFixture(bool synchronizes = true)
        : SessionFixture(kQuietScript + "axis left trigger 0 0.25\n",
                         {XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME}) {
        const Bindings of_touch{
            {jump, "/user/hand/left/input/x/click"},       {jump, "/user/hand/right/input/a/click"},
            {pull, "/user/hand/left/input/trigger/value"}, {pull, "/user/hand/right/input/trigger/value"},
            {stick, "/user/hand/right/input/thumbstick"},  {grip, "/user/hand/left/input/grip/pose"},
            {grip, "/user/hand/right/input/grip/pose"}};
        const Bindings of_simple{{jump, "/user/hand/left/input/select/click"},
                                 {jump, "/user/hand/right/input/select/click"}};
        const Bindings of_xbox{{jump, "/user/gamepad/input/a/click"}};
        checkEach(XR_SUCCESS,
                  {suggest(kTouch, of_touch), suggest(kSimple, of_simple), suggest(kXbox, of_xbox)});
        attach({set});
        focus();
        if (synchronizes) { synchronize(); }
        states();
    }

    void synchronize(XrPath hand = XR_NULL_PATH) const { REQUIRE(sync(set, hand) == XR_SUCCESS); }
};

struct Gaze {
    bool is_active;
    XrSpaceLocation location;
    XrTime sampled;

    // Degrees from the direction of the head: to the left, and upwards.
    double yaw() const { return std::asin(2 * (q().x * q().z + q().w * q().y)) / kDegree; }
    double pitch() const { return std::asin(-2 * (q().y * q().z - q().w * q().x)) / kDegree; }

private:
    const XrQuaternionf& q() const { return location.pose.orientation; }
};

struct GazeFixture : SessionFixture {
    XrActionSet set = makeActionSet("looking");
    XrAction look = makeAction(set, "look", XR_ACTION_TYPE_POSE_INPUT, {path("/user/eyes_ext")});
    XrSpace gaze_space = XR_NULL_HANDLE;
    XrSpace view = makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW);

    explicit GazeFixture(const std::string& script)
        : SessionFixture(kQuietScript + "rate 100\n" + script, {XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME}) {
        REQUIRE(suggest(kEyes, {{look, "/user/eyes_ext/input/gaze_ext/pose"}}) == XR_SUCCESS);
        attach({set});
        gaze_space = makeActionSpace(look);
        begin();
    }

    Gaze read(XrTime time, XrSpace base) const {
        XrEyeGazeSampleTimeEXT sample{XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT, nullptr, 77};
        const XrSpaceLocation location = locate(gaze_space, base, time, &sample);
        return {pose(look).isActive == XR_TRUE, location, sample.time};
    }
    // After frames up to `until_s` of the script's time.
    Gaze at(double until_s) { return at(until_s, view); }
    Gaze at(double until_s, XrSpace base) {
        XrTime time = 0;
        for (; frames_ <= std::lround(100 * until_s); ++frames_) { time = frame().predictedDisplayTime; }
        REQUIRE(XR_SUCCEEDED(sync(set)));
        return read(time, base);
    }

private:
    long frames_ = 0;
};

// 7: no answer.
XrBool32 supportsGaze(const InstanceFixture& made) {
    XrSystemEyeGazeInteractionPropertiesEXT eyes{XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT, nullptr,
                                                 7};
    made.systemProperties(&eyes);
    return eyes.supportsEyeGazeInteraction;
}

TEST_CASE_FIXTURE(AutomationFixture, "what is set is read after the next sync, the rest is the script's") {
    CHECK(setFloat(session, right, right_trigger, 0.75f) == XR_SUCCESS);
    CHECK(number(pull, right).currentState == 0);
    synchronize();
    CHECK(these(number(pull, right).currentState, number(pull, left).currentState) == these(0.75f, 0.25f));
    // A pose is where it was set, in any space.
    CHECK(setLocation(session, left, left_grip, local, {{0, 0, 0, 1}, {1, 2, 3}}) == XR_SUCCESS);
    synchronize();
    const XrSpace stage = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    checkNear(locate(makeActionSpace(grip, left), stage, waitFrame().predictedDisplayTime).pose.position,
              {1, 3.6f, 3});
}

TEST_CASE_FIXTURE(AutomationFixture, "devices take up profiles, one by one, and are switched off") {
    CHECK(these(profileOf(left), profileOf(gamepad)) == these(kTouch, "none"));
    CHECK(setActive(session, path(kSimple), left, XR_TRUE) == XR_SUCCESS);
    CHECK(profileOf(left) == kTouch);
    synchronize();
    CHECK(isProfileAnnounced());
    CHECK(these(profileOf(left), profileOf(right)) == these(kSimple, kTouch));
    CHECK(setBool(session, left, path("/user/hand/left/input/select/click"), XR_TRUE) == XR_SUCCESS);
    synchronize();
    CHECK_FALSE(isProfileAnnounced());
    CHECK(boolean(jump, left).currentState == XR_TRUE);
    CHECK_MESSAGE(number(pull, left).currentState == 0, "the simple controller has no trigger");
    CHECK(setActive(session, path(kSimple), left, XR_FALSE) == XR_SUCCESS);
    synchronize();
    CHECK(these(boolean(jump, left).isActive, boolean(jump, right).isActive) == these(XR_FALSE, XR_TRUE));
    // A gamepad exists as soon as the program sets it active.
    CHECK(boolean(jump, gamepad).isActive == XR_FALSE);
    checkEach(XR_SUCCESS, {setActive(session, path(kXbox), gamepad, XR_TRUE),
                           setBool(session, gamepad, path("/user/gamepad/input/a/click"), XR_TRUE)});
    synchronize();
    CHECK(profileOf(gamepad) == kXbox);
    CHECK(boolean(jump, gamepad).currentState == XR_TRUE);
    // A profile for which the program has no bindings.
    const XrPath index = path("/interaction_profiles/valve/index_controller");
    CHECK(setActive(session, index, right, XR_TRUE) == XR_SUCCESS);
    synchronize();
    CHECK(profileOf(right) == "none");
    CHECK(boolean(jump, right).isActive == XR_FALSE);
}

TEST_CASE("an action space of both hands follows one until it is gone and another is synchronized") {
    // What happens to the left hand; which hand is synchronized, if not both; and whom the space follows
    // then.
    using Step = std::array<std::string, 3>;
    for (const std::vector<Step>& steps : {std::vector<Step>{{"down", "", "right"}, {"up", "", "right"}},
                                           {{"", "", "left"}, {"down", "", "nobody"}, {"up", "", "left"}},
                                           {{"", "left", "left"},
                                            {"", "right", "right"},
                                            {"", "", "right"},
                                            {"down", "left", "nobody"},
                                            {"", "", "right"}}}) {
        const AutomationFixture made(false);
        const XrSpace space = made.makeActionSpace(made.grip);
        for (const auto& [left, synchronized, followed] : steps) {
            INFO(left, " ", synchronized);
            if (!left.empty()) {
                CHECK(made.setActive(made.session, made.path(kTouch), made.left, left == "up") == XR_SUCCESS);
            }
            made.synchronize(synchronized.empty() ? XR_NULL_PATH : made.path("/user/hand/" + synchronized));
            const XrSpaceLocation found = made.locate(space, made.local, made.frame().predictedDisplayTime);
            CHECK(followed == ((found.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) == 0 ? "nobody"
                               : found.pose.position.x < 0                                       ? "left"
                                                                                                 : "right"));
        }
    }
}

TEST_CASE_FIXTURE(AutomationFixture, "there is no input that the device's profile lacks") {
    const auto pullIt = [&](XrPath of, XrPath source) { return setFloat(session, of, source, 1); };
    checkEach(XR_ERROR_PATH_INVALID, {pullIt(XR_NULL_PATH, right_trigger), pullIt(right, 123456),
                                      setActive(session, XR_NULL_PATH, right, XR_TRUE)});
    CHECK(setFloat(session, right, right_trigger, NAN) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(setLocation(session, left, left_grip, local, {}) == XR_ERROR_POSE_INVALID);
    checkEach(XR_ERROR_HANDLE_INVALID, {setFloat(XR_NULL_HANDLE, right, right_trigger, 1),
                                        setLocation(session, left, left_grip, XR_NULL_HANDLE, kIdentity)});
    CHECK(setActive(session, path(kSimple), right, XR_TRUE) == XR_SUCCESS);
    checkEach(XR_ERROR_PATH_UNSUPPORTED,
              {pullIt(right, right_trigger), setActive(session, path(kXbox), right, XR_TRUE),
               setActive(session, path("/interaction_profiles/nobody/nothing"), right, XR_TRUE)});
    checkEach(XR_SUCCESS, {setActive(session, path(kTouch), right, XR_TRUE), pullIt(right, right_trigger)});
    checkEach(
        XR_ERROR_PATH_UNSUPPORTED,
        {pullIt(right, path("/user/hand/right/input/nose/value")), pullIt(left, right_trigger),
         pullIt(path("/user/treadmill"), right_trigger), setVector(session, right, right_trigger, {0, 0}),
         setLocation(session, left, right_trigger, local, kIdentity),
         setLocation(session, right, right_trigger, local, kIdentity)});
}

TEST_CASE("eye tracking is told to who enabled it; without it, and refused, the gaze is inactive") {
    CHECK(supportsGaze(InstanceFixture()) == 7);
    for (const auto& [script, tracks, is_active] : {std::tuple("", true, true),
                                                    {"eye-tracking on\n", true, true},
                                                    {"eye-tracking refused\n", true, false},
                                                    {"eye-tracking off\n", false, false}}) {
        GazeFixture made(script);
        CHECK((supportsGaze(made) == XR_TRUE) == tracks);
        const Gaze gaze = made.at(0.1);
        CHECK(these(gaze.is_active, (gaze.location.locationFlags != 0), (gaze.sampled != 0)) ==
              these(is_active, is_active, is_active));
        CHECK((made.profileOf(made.path("/user/eyes_ext")) == kEyes) == tracks);
    }
}

TEST_CASE("the gaze goes where the script says, from between the eyes, with the time of its sample") {
    GazeFixture made("head 0 position 0.1 1.5 0.2 turn 30 0\ngaze 0.1 0 0\ngaze 0.3 20 -10\n");
    Gaze gaze = made.at(0.1);
    CHECK(these(gaze.is_active, gaze.location.locationFlags, gaze.yaw()) ==
          these(true, (kValid | kTracked), doctest::Approx(0).epsilon(0.001)));
    gaze = made.at(0.2);
    CHECK(std::asin(std::sin(gaze.yaw() * kDegree) / std::cos(5 * kDegree)) / kDegree ==
          doctest::Approx(10).epsilon(0.001));
    CHECK(gaze.pitch() == doctest::Approx(-5).epsilon(0.001));
    const XrVector3f& place = gaze.location.pose.position;
    CHECK(std::abs(place.x) + std::abs(place.y) + std::abs(place.z) < 1e-6f);
    const XrFrameState frame = made.frame();
    REQUIRE(made.sync(made.set) == XR_SUCCESS);
    CHECK(made.read(frame.predictedDisplayTime, made.view).sampled == frame.predictedDisplayTime);
    // Seen from the room, it turns with the head.
    gaze = made.read(frame.predictedDisplayTime, made.makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE));
    checkNear(gaze.location.pose.position, {0.1f, 1.5f, 0.2f});
    CHECK(gaze.yaw() > 35.0);
    CHECK(made.profileOf(made.path("/user/eyes_ext")) == kEyes);
}

TEST_CASE("a gaze may be lost, found again, and be poor; nothing else that is located has a sample") {
    GazeFixture made(
        "at 0.1 gaze off\nat 0.2 gaze degraded\nat 0.3 gaze on\nat 0.4 head off\nat 0.5 head turn-only\nat "
        "0.6 focused off\n");
    CHECK(made.at(0.05).is_active);
    Gaze gaze = made.at(0.15);
    CHECK(these(gaze.is_active, gaze.location.locationFlags, gaze.sampled) == these(false, 0, 0));
    gaze = made.at(0.25);
    CHECK(these(gaze.is_active, gaze.location.locationFlags) == these(true, kValid));
    CHECK(gaze.sampled > 0);
    CHECK(made.at(0.35).location.locationFlags == (kValid | kTracked));
    // The head is lost, but not the eyes in it.
    CHECK(made.at(0.44).location.locationFlags == (kValid | kTracked));
    CHECK(made.at(0.45, made.local).location.locationFlags == 0);
    // Both parts of a gaze are tracked, or neither is.
    CHECK(made.at(0.55, made.local).location.locationFlags == XR_SPACE_LOCATION_ORIENTATION_VALID_BIT);

    // A lost or poor gaze still has a location in its own space, but only a tracked gaze has a sample.
    for (const double time_s : {0.15, 0.25}) {
        gaze = made.read(kStart + std::lround(time_s * 1e9), made.gaze_space);
        CHECK(these(gaze.location.locationFlags, (gaze.sampled > 0)) ==
              these((kValid | kTracked), (time_s > 0.2)));
    }

    XrEyeGazeSampleTimeEXT sample{XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT, nullptr, 77};
    made.locate(made.view, made.view, kStart, &sample);
    CHECK(sample.time == 0);
    // Out of focus.
    CHECK_FALSE(made.at(0.65).is_active);
}

}  // SUITE(simulated_automation)
