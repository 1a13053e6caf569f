// XR_EXT_eye_gaze_interaction on the simulated runtime: where the wearer looks, as the script says it.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <cmath>
#include <utility>

TEST_SUITE_BEGIN("simulated_gaze");

namespace simulated_gaze_test {

using namespace binosplat::test;

namespace {

constexpr const char* kEyes = "/interaction_profiles/ext/eye_gaze_interaction";
constexpr const char* kGazePath = "/user/eyes_ext/input/gaze_ext/pose";
constexpr const char* kSimple = "/interaction_profiles/khr/simple_controller";
constexpr XrSpaceLocationFlags kValid = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
constexpr XrSpaceLocationFlags kTracked = XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
const std::string kRate = "rate 100\n";

struct Gaze {
    bool is_active;
    XrSpaceLocation location;
    XrTime sampled;

    // Degrees from where the head looks: to the left, and upwards.
    double yaw() const { return angle(-forward().x); }
    double pitch() const { return angle(forward().y); }

private:
    static double angle(float sine) { return 180.0 / std::acos(-1.0) * std::asin(static_cast<double>(sine)); }
    XrVector3f forward() const {
        const XrQuaternionf& q = location.pose.orientation;
        return {-2 * (q.x * q.z + q.w * q.y), -2 * (q.y * q.z - q.w * q.x), -1 + 2 * (q.x * q.x + q.y * q.y)};
    }
};

std::vector<const char*> withGaze(std::vector<const char*> extensions) {
    extensions.push_back(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME);
    return extensions;
}

struct GazeFixture : SessionFixture {
    XrActionSet set = makeActionSet("looking");
    XrAction look = makeAction(set, "look", XR_ACTION_TYPE_POSE_INPUT);
    XrSpace gaze_space = XR_NULL_HANDLE;
    XrSpace view = XR_NULL_HANDLE;

    explicit GazeFixture(const std::string& script, std::vector<const char*> extensions = {})
        : SessionFixture(kQuietScript + kRate + script, withGaze(std::move(extensions))) {
        REQUIRE(suggest(kEyes, {{look, path(kGazePath)}}) == XR_SUCCESS);
        attach({set});
        XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO};
        info.action = look;
        info.poseInActionSpace = kIdentity;
        REQUIRE(xrCreateActionSpace(session, &info, &gaze_space) == XR_SUCCESS);
        view = makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW);
        begin();
    }

    Gaze read(XrTime time, XrSpace base) const {
        const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, look, XR_NULL_PATH};
        XrActionStatePose state{XR_TYPE_ACTION_STATE_POSE};
        REQUIRE(xrGetActionStatePose(session, &get, &state) == XR_SUCCESS);
        XrEyeGazeSampleTimeEXT sample{XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT, nullptr, 77};
        XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, &sample};
        REQUIRE(xrLocateSpace(gaze_space, base, time, &location) == XR_SUCCESS);
        return {state.isActive == XR_TRUE, location, sample.time};
    }
    // After frames up to `until_s` of the script's time.
    Gaze at(double until_s, XrSpace base = XR_NULL_HANDLE) {
        XrTime time = 0;
        for (; frames_ <= std::lround(100 * until_s); ++frames_) { time = frame().predictedDisplayTime; }
        const XrResult synced = sync(set);
        REQUIRE(XR_SUCCEEDED(synced));
        return read(time, base == XR_NULL_HANDLE ? view : base);
    }
    XrInteractionProfileState profile() const {
        XrInteractionProfileState state{XR_TYPE_INTERACTION_PROFILE_STATE};
        REQUIRE(xrGetCurrentInteractionProfile(session, path("/user/eyes_ext"), &state) == XR_SUCCESS);
        return state;
    }

private:
    long frames_ = 0;
};

bool supportsGaze(const InstanceFixture& made) {
    XrSystemEyeGazeInteractionPropertiesEXT eyes{XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT, nullptr, 7};
    XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES, &eyes};
    REQUIRE(xrGetSystemProperties(made.instance, made.system, &properties) == XR_SUCCESS);
    REQUIRE(eyes.supportsEyeGazeInteraction <= XR_TRUE);
    return eyes.supportsEyeGazeInteraction == XR_TRUE;
}

}  // namespace

TEST_CASE("the headset says whether it tracks eyes, to whoever enabled the extension") {
    const std::vector<const char*> enabled{XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME};
    CHECK(supportsGaze(InstanceFixture(kQuietScript, enabled)));
    CHECK(supportsGaze(InstanceFixture(std::string(kQuietScript) + "eye-tracking on\n", enabled)));
    CHECK(supportsGaze(InstanceFixture(std::string(kQuietScript) + "eye-tracking refused\n", enabled)));
    CHECK_FALSE(supportsGaze(InstanceFixture(std::string(kQuietScript) + "eye-tracking off\n", enabled)));
    const InstanceFixture plain;
    XrSystemEyeGazeInteractionPropertiesEXT eyes{XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT, nullptr, 7};
    XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES, &eyes};
    REQUIRE(xrGetSystemProperties(plain.instance, plain.system, &properties) == XR_SUCCESS);
    CHECK(eyes.supportsEyeGazeInteraction == 7);
}

TEST_CASE("the eyes' profile has a gaze, and nothing else") {
    const InstanceFixture made(kQuietScript, {XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME});
    const XrActionSet set = made.makeActionSet("looking");
    const XrAction look = made.makeAction(set, "look", XR_ACTION_TYPE_POSE_INPUT, {made.path("/user/eyes_ext")});
    CHECK(made.suggest(kEyes, {{look, made.path(kGazePath)}}) == XR_SUCCESS);
    CHECK(made.suggest(kEyes, {{look, made.path("/user/eyes_ext/input/gaze_ext")}}) == XR_SUCCESS);
    CHECK(made.suggest(kEyes, {{look, made.path("/user/eyes_ext/input/aim/pose")}}) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(made.suggest(kEyes, {{look, made.path("/user/hand/left/input/gaze_ext/pose")}}) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(made.suggest(kSimple, {{look, made.path(kGazePath)}}) == XR_ERROR_PATH_UNSUPPORTED);
}

TEST_CASE_FIXTURE(InstanceFixture, "without the extension there are no eyes to bind anything to") {
    const XrActionSet set = makeActionSet("looking");
    const XrAction look = makeAction(set, "look", XR_ACTION_TYPE_POSE_INPUT);
    CHECK(suggest(kEyes, {{look, path(kGazePath)}}) == XR_ERROR_PATH_UNSUPPORTED);
    XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
    std::strcpy(info.actionName, "stare");
    std::strcpy(info.localizedActionName, "Stare");
    info.actionType = XR_ACTION_TYPE_POSE_INPUT;
    const XrPath eyes = path("/user/eyes_ext");
    info.countSubactionPaths = 1;
    info.subactionPaths = &eyes;
    XrAction stare = XR_NULL_HANDLE;
    CHECK(xrCreateAction(set, &info, &stare) == XR_ERROR_PATH_UNSUPPORTED);
}

TEST_CASE_FIXTURE(SessionFixture, "without the extension there is no profile of the eyes to ask for") {
    attach({makeActionSet("walking")});
    XrInteractionProfileState state{XR_TYPE_INTERACTION_PROFILE_STATE};
    CHECK(xrGetCurrentInteractionProfile(session, path("/user/eyes_ext"), &state) == XR_ERROR_PATH_UNSUPPORTED);
}

TEST_CASE("the gaze goes where the script says, from between the eyes, with the time of its sample") {
    GazeFixture made("head 0 position 0.1 1.5 0.2 turn 30 0\ngaze 0.1 0 0\ngaze 0.3 20 -10\n");
    Gaze gaze = made.at(0.1);
    CHECK(gaze.is_active);
    CHECK(gaze.location.locationFlags == (kValid | kTracked));
    CHECK(gaze.yaw() == doctest::Approx(0).epsilon(0.001));
    gaze = made.at(0.2);
    CHECK(std::asin(std::sin(gaze.yaw() / 57.29578) / std::cos(-5 / 57.29578)) * 57.29578 == doctest::Approx(10).epsilon(0.001));
    CHECK(gaze.pitch() == doctest::Approx(-5).epsilon(0.001));
    CHECK(std::abs(gaze.location.pose.position.x) + std::abs(gaze.location.pose.position.y) + std::abs(gaze.location.pose.position.z) <
          1e-6f);
    const XrFrameState frame = made.frame();
    REQUIRE(made.sync(made.set) == XR_SUCCESS);
    CHECK(made.read(frame.predictedDisplayTime, made.view).sampled == frame.predictedDisplayTime);
    // In the room it turns with the head.
    gaze = made.read(frame.predictedDisplayTime, made.makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE));
    CHECK(gaze.location.pose.position.x == doctest::Approx(0.1f));
    CHECK(gaze.location.pose.position.y == doctest::Approx(1.5f));
    CHECK(gaze.yaw() > 35.0);
    char text[XR_MAX_PATH_LENGTH];
    std::uint32_t count = 0;
    REQUIRE(xrPathToString(made.instance, made.profile().interactionProfile, sizeof text, &count, text) == XR_SUCCESS);
    CHECK(std::string(text) == kEyes);
}

TEST_CASE("a gaze may be lost, found again, and be too poor to rely on; whatever else is located has no sample") {
    GazeFixture made("at 0.1 gaze off\nat 0.2 gaze degraded\nat 0.3 gaze on\nat 0.4 head off\nat 0.5 head turn-only\n");
    CHECK(made.at(0.05).is_active);
    Gaze gaze = made.at(0.15);
    CHECK_FALSE(gaze.is_active);
    CHECK(gaze.location.locationFlags == 0);
    CHECK(gaze.sampled == 0);
    gaze = made.at(0.25);
    CHECK(gaze.is_active);
    CHECK(gaze.location.locationFlags == kValid);
    CHECK(gaze.sampled > 0);
    CHECK(made.at(0.35).location.locationFlags == (kValid | kTracked));
    // The head is lost, not the eyes in it.
    CHECK(made.at(0.44).location.locationFlags == (kValid | kTracked));
    CHECK(made.at(0.45, made.local).location.locationFlags == 0);
    // Both parts of a gaze are tracked, or neither.
    CHECK(made.at(0.55, made.local).location.locationFlags == XR_SPACE_LOCATION_ORIENTATION_VALID_BIT);

    // A gaze is known in itself, lost or poor, though only a gaze that is seen has a sample.
    for (const double time_s : {0.15, 0.25}) {
        gaze = made.read(1'000'000'000 + std::lround(time_s * 1e9), made.gaze_space);
        CHECK(gaze.location.locationFlags == (kValid | kTracked));
        CHECK((gaze.sampled > 0) == (time_s > 0.2));
    }

    XrEyeGazeSampleTimeEXT sample{XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT, nullptr, 77};
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, &sample};
    REQUIRE(xrLocateSpace(made.view, made.view, 1'000'000'000, &location) == XR_SUCCESS);
    CHECK(sample.time == 0);
}

TEST_CASE("a wearer who refuses, and a headset without a tracker, leave the gaze inactive") {
    for (const char* script : {"eye-tracking refused\n", "eye-tracking off\n"}) {
        CAPTURE(script);
        GazeFixture made(script);
        const Gaze gaze = made.at(0.1);
        CHECK_FALSE(gaze.is_active);
        CHECK(gaze.location.locationFlags == 0);
        CHECK(gaze.sampled == 0);
        CHECK((made.profile().interactionProfile != XR_NULL_PATH) == (std::string(script) == "eye-tracking refused\n"));
    }
}

TEST_CASE("a program's own test moves the gaze from inside") {
    GazeFixture made("", {XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME});
    REQUIRE(made.at(0.1).is_active);
    const XrPath eyes = made.path("/user/eyes_ext"), gaze = made.path(kGazePath);
    const auto setLocation = made.function<PFN_xrSetInputDeviceLocationEXT>("xrSetInputDeviceLocationEXT");
    const auto setActive = made.function<PFN_xrSetInputDeviceActiveEXT>("xrSetInputDeviceActiveEXT");
    // Half a right angle to the left.
    const XrPosef left{{0, std::sin(0.3926991f), 0, std::cos(0.3926991f)}, {0, 0, 0}};
    CHECK(setLocation(made.session, eyes, gaze, made.view, left) == XR_SUCCESS);
    CHECK(setLocation(made.session, eyes, made.path("/user/eyes_ext/input/aim/pose"), made.view, left) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(made.at(0.2).yaw() == doctest::Approx(45).epsilon(0.001));
    CHECK(setActive(made.session, made.path(kEyes), eyes, XR_FALSE) == XR_SUCCESS);
    CHECK_FALSE(made.at(0.3).is_active);
    CHECK(setActive(made.session, made.path(kSimple), eyes, XR_TRUE) == XR_ERROR_PATH_UNSUPPORTED);
}

TEST_CASE("a gaze out of focus is inactive") {
    GazeFixture made("at 0.1 focused off\n");
    CHECK(made.at(0.05).is_active);
    CHECK_FALSE(made.at(0.2).is_active);
}

}  // namespace simulated_gaze_test
