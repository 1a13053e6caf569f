// Chapter 11 of OpenXR on the simulated runtime, in motion: what actions read from the script's controllers, and haptics.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <fstream>

TEST_SUITE_BEGIN("simulated_input");

namespace simulated_input_test {

using namespace binosplat::test;

namespace {

constexpr const char* kTouch = "/interaction_profiles/oculus/touch_controller";
constexpr const char* kSimple = "/interaction_profiles/khr/simple_controller";

// Ten frames per second, so that frame n is shown at n/10 seconds.
constexpr const char* kScript =
    "size 64 64\nframes none\nrate 10\n"
    "controller left 0 position -1 1 0\ncontroller left 2 position 1 1 0\n"
    "press right a 0.45 0.65\n"
    "axis right trigger 0 0\naxis right trigger 1 1\n"
    "axis left trigger 0 0.2\n"
    "axis right thumbstick 0 0 0\naxis right thumbstick 1 1 -1\n"
    "at 1 controller right off\n";

struct InputFixture : SessionFixture {
    XrPath left = path("/user/hand/left"), right = path("/user/hand/right");
    XrActionSet set = makeActionSet("walking");
    XrAction click = makeAction(set, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT);
    XrAction pull = makeAction(set, "pull", XR_ACTION_TYPE_FLOAT_INPUT, {left, right});
    XrAction stick = makeAction(set, "stick", XR_ACTION_TYPE_VECTOR2F_INPUT);
    XrAction grip = makeAction(set, "grip", XR_ACTION_TYPE_POSE_INPUT, {left, right});
    XrAction shake = makeAction(set, "shake", XR_ACTION_TYPE_VIBRATION_OUTPUT, {left, right});

    InputFixture() : SessionFixture(kScript) {
        const std::vector<XrActionSuggestedBinding> bindings{
            {click, path("/user/hand/right/input/a/click")},      {pull, path("/user/hand/left/input/trigger/value")},
            {pull, path("/user/hand/right/input/trigger/value")}, {stick, path("/user/hand/right/input/thumbstick")},
            {grip, path("/user/hand/left/input/grip/pose")},      {grip, path("/user/hand/right/input/grip/pose")},
            {shake, path("/user/hand/left/output/haptic")},       {shake, path("/user/hand/right/output/haptic")},
        };
        REQUIRE(suggest(kTouch, bindings) == XR_SUCCESS);
    }

    void start() const {
        attach({set});
        focus();
    }
    // Frames up to the one that is shown at n/10 seconds; the first three have brought the session to FOCUSED.
    void runTo(int n) {
        for (; shown < n; ++shown) frame();
    }
    XrActionStateBoolean boolean(XrAction action) const {
        XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
        const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, action, XR_NULL_PATH};
        REQUIRE(xrGetActionStateBoolean(session, &get, &state) == XR_SUCCESS);
        return state;
    }
    XrActionStateFloat scalar(XrAction action, XrPath hand) const {
        XrActionStateFloat state{XR_TYPE_ACTION_STATE_FLOAT};
        const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, action, hand};
        REQUIRE(xrGetActionStateFloat(session, &get, &state) == XR_SUCCESS);
        return state;
    }
    XrSpace spaceOf(XrAction action, XrPath hand) const {
        const XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, action, hand, kIdentity};
        XrSpace space = XR_NULL_HANDLE;
        REQUIRE(xrCreateActionSpace(session, &info, &space) == XR_SUCCESS);
        return space;
    }

private:
    int shown = 2;
};

}  // namespace

TEST_CASE_FIXTURE(InputFixture, "a profile is in use from the first sync in focus on, and announced") {
    attach({set});
    CHECK(sync(set) == XR_SESSION_NOT_FOCUSED);
    XrInteractionProfileState state{XR_TYPE_INTERACTION_PROFILE_STATE};
    CHECK(xrGetCurrentInteractionProfile(session, left, &state) == XR_SUCCESS);
    CHECK(state.interactionProfile == XR_NULL_PATH);
    focus();
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(xrGetCurrentInteractionProfile(session, left, &state) == XR_SUCCESS);
    CHECK(state.interactionProfile == path(kTouch));
    CHECK(xrGetCurrentInteractionProfile(session, path("/user/gamepad"), &state) == XR_SUCCESS);
    CHECK(state.interactionProfile == XR_NULL_PATH);
    XrEventDataBuffer event;
    CHECK(poll(event) == XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED);
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(poll(event) == XR_TYPE_UNKNOWN);
}

TEST_CASE_FIXTURE(InputFixture, "a button is pressed and let go at the script's times, and changes are seen at syncs") {
    start();
    runTo(4);
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(boolean(click).isActive == XR_TRUE);
    CHECK(boolean(click).currentState == XR_FALSE);
    CHECK(boolean(click).changedSinceLastSync == XR_FALSE);
    runTo(5);
    CHECK_MESSAGE(boolean(click).currentState == XR_FALSE, "nothing changes between syncs");
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(boolean(click).currentState == XR_TRUE);
    CHECK(boolean(click).changedSinceLastSync == XR_TRUE);
    CHECK(boolean(click).lastChangeTime == 1'500'000'000);
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(boolean(click).changedSinceLastSync == XR_FALSE);
    CHECK(boolean(click).lastChangeTime == 1'500'000'000);
    runTo(7);
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(boolean(click).currentState == XR_FALSE);
    CHECK(boolean(click).changedSinceLastSync == XR_TRUE);
}

TEST_CASE_FIXTURE(InputFixture, "of two hands the stronger counts, and each can be asked alone") {
    start();
    runTo(5);
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(scalar(pull, left).currentState == doctest::Approx(0.2));
    CHECK(scalar(pull, right).currentState == doctest::Approx(0.5));
    CHECK(scalar(pull, XR_NULL_PATH).currentState == doctest::Approx(0.5));
    XrActionStateVector2f both{XR_TYPE_ACTION_STATE_VECTOR2F};
    const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, stick, XR_NULL_PATH};
    CHECK(xrGetActionStateVector2f(session, &get, &both) == XR_SUCCESS);
    CHECK(both.currentState.x == doctest::Approx(0.5));
    CHECK(both.currentState.y == doctest::Approx(-0.5));
}

TEST_CASE_FIXTURE(InputFixture, "a controller that is off is inactive, and its space is nowhere") {
    start();
    const XrSpace space = spaceOf(grip, right);
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(xrLocateSpace(space, local, 1'500'000'000, &location) == XR_SUCCESS);
    CHECK((location.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) != 0);
    runTo(11);
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(scalar(pull, right).isActive == XR_FALSE);
    CHECK(scalar(pull, right).currentState == 0);
    CHECK(scalar(pull, right).lastChangeTime == 0);
    CHECK(scalar(pull, XR_NULL_PATH).currentState == doctest::Approx(0.2));
    XrActionStatePose state{XR_TYPE_ACTION_STATE_POSE};
    const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, grip, right};
    CHECK(xrGetActionStatePose(session, &get, &state) == XR_SUCCESS);
    CHECK(state.isActive == XR_FALSE);
    CHECK(xrLocateSpace(space, local, 2'100'000'000, &location) == XR_SUCCESS);
    CHECK(location.locationFlags == 0);
}

TEST_CASE_FIXTURE(InputFixture, "spaces of one action are known in one another while its set is active, though the controller is off") {
    start();
    const XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, grip, right, {{0, 0, 0, 1}, {0, 0.5f, 0}}};
    const XrSpace held = spaceOf(grip, right), other = spaceOf(grip, left);
    XrSpace above = XR_NULL_HANDLE;
    REQUIRE(xrCreateActionSpace(session, &info, &above) == XR_SUCCESS);
    XrSpaceVelocity velocity{XR_TYPE_SPACE_VELOCITY};
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, &velocity};
    const auto flagsOf = [&](XrSpace space, XrSpace base, XrTime time) {
        REQUIRE(xrLocateSpace(space, base, time, &location) == XR_SUCCESS);
        return location.locationFlags;
    };
    CHECK_MESSAGE(flagsOf(above, held, 1'500'000'000) == 0, "no set was active yet");
    // The controller is off from 2 s on: once after the set was read, once before.
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(flagsOf(above, held, 2'500'000'000) == 15);
    runTo(11);
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(flagsOf(above, held, 2'100'000'000) == 15);
    CHECK(location.pose.position.y == doctest::Approx(0.5));
    CHECK(velocity.velocityFlags == (XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT));
    CHECK(velocity.linearVelocity.y == 0);
    CHECK(flagsOf(held, above, 2'100'000'000) == 15);
    CHECK(location.pose.position.y == doctest::Approx(-0.5));
    CHECK(flagsOf(above, other, 2'100'000'000) == 0);
    CHECK(flagsOf(above, local, 2'100'000'000) == 0);
    REQUIRE(sync(set, left) == XR_SUCCESS);
    CHECK(flagsOf(above, held, 2'100'000'000) == 0);
}

TEST_CASE_FIXTURE(InputFixture, "an action space moves with its hand, also once its action's handle is gone") {
    start();
    const XrSpace space = spaceOf(grip, left), stage = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    REQUIRE(sync(set) == XR_SUCCESS);
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    CHECK(xrLocateSpace(space, stage, 1'000'000'000, &location) == XR_SUCCESS);
    CHECK(location.pose.position.x == doctest::Approx(-1));
    CHECK(xrDestroyAction(grip) == XR_SUCCESS);
    CHECK(xrLocateSpace(space, stage, 2'500'000'000, &location) == XR_SUCCESS);
    CHECK(location.pose.position.x == doctest::Approx(0.5));
}

TEST_CASE_FIXTURE(InputFixture, "a set that is not synced is inactive, and so is a hand that is left out") {
    start();
    REQUIRE(sync(set, left) == XR_SUCCESS);
    CHECK(scalar(pull, left).isActive == XR_TRUE);
    CHECK(scalar(pull, right).isActive == XR_FALSE);
    const XrActionsSyncInfo none{XR_TYPE_ACTIONS_SYNC_INFO};
    CHECK(xrSyncActions(session, &none) == XR_SUCCESS);
    CHECK(scalar(pull, left).isActive == XR_FALSE);
    CHECK(sync(set, path("/user/head")) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(sync(set, 77'777) == XR_ERROR_PATH_INVALID);
    const XrActionsSyncInfo missing{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, nullptr};
    CHECK(xrSyncActions(session, &missing) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrSyncActions(session, nullptr) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(InputFixture, "a set of higher priority takes the controls that it uses") {
    const XrActionSet menu = makeActionSet("menu", 5);
    const XrAction choose = makeAction(menu, "choose", XR_ACTION_TYPE_BOOLEAN_INPUT);
    REQUIRE(suggest(kTouch, {{choose, path("/user/hand/right/input/trigger/touch")},
                             {pull, path("/user/hand/right/input/trigger/value")},
                             {click, path("/user/hand/right/input/a/click")}}) == XR_SUCCESS);
    attach({set, menu});
    focus();
    const XrActiveActionSet both[2] = {{set, XR_NULL_PATH}, {menu, XR_NULL_PATH}};
    const XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 2, both};
    REQUIRE(xrSyncActions(session, &info) == XR_SUCCESS);
    CHECK(scalar(pull, right).isActive == XR_FALSE);
    CHECK(boolean(choose).isActive == XR_TRUE);
    CHECK(boolean(click).isActive == XR_TRUE);
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(scalar(pull, right).isActive == XR_TRUE);
}

TEST_CASE_FIXTURE(InputFixture, "a state is asked for by its type and by hands that were declared") {
    start();
    XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
    XrActionStateFloat number{XR_TYPE_ACTION_STATE_FLOAT};
    XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, pull, XR_NULL_PATH};
    CHECK(xrGetActionStateBoolean(session, &get, &state) == XR_ERROR_ACTION_TYPE_MISMATCH);
    get.subactionPath = path("/user/head");
    CHECK(xrGetActionStateFloat(session, &get, &number) == XR_ERROR_PATH_UNSUPPORTED);
    get.subactionPath = 88'888;
    CHECK(xrGetActionStateFloat(session, &get, &number) == XR_ERROR_PATH_INVALID);
    get.subactionPath = XR_NULL_PATH;
    number.type = XR_TYPE_ACTION_STATE_BOOLEAN;
    CHECK(xrGetActionStateFloat(session, &get, &number) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrGetActionStateFloat(session, &get, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrGetActionStateFloat(session, nullptr, &number) == XR_ERROR_VALIDATION_FAILURE);
    get.action = XR_NULL_HANDLE;
    CHECK(xrGetActionStateBoolean(session, &get, &state) == XR_ERROR_HANDLE_INVALID);
    get = {XR_TYPE_ACTION_STATE_GET_INFO, nullptr, click, left};
    CHECK(xrGetActionStateBoolean(session, &get, &state) == XR_ERROR_PATH_UNSUPPORTED);
}

TEST_CASE_FIXTURE(InputFixture, "sources are enumerated and have names") {
    start();
    REQUIRE(sync(set) == XR_SUCCESS);
    const XrBoundSourcesForActionEnumerateInfo info{XR_TYPE_BOUND_SOURCES_FOR_ACTION_ENUMERATE_INFO, nullptr, pull};
    std::uint32_t count = 0;
    XrPath sources[2];
    CHECK(xrEnumerateBoundSourcesForAction(session, &info, 0, &count, nullptr) == XR_SUCCESS);
    CHECK(count == 2);
    CHECK(xrEnumerateBoundSourcesForAction(session, &info, 1, &count, sources) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(xrEnumerateBoundSourcesForAction(session, &info, 2, &count, sources) == XR_SUCCESS);
    CHECK(sources[0] == path("/user/hand/left/input/trigger/value"));
    XrInputSourceLocalizedNameGetInfo get{XR_TYPE_INPUT_SOURCE_LOCALIZED_NAME_GET_INFO, nullptr, sources[0], 7};
    char name[64];
    CHECK(xrGetInputSourceLocalizedName(session, &get, 64, &count, name) == XR_SUCCESS);
    CHECK(std::string(name) == "Left hand Touch controller Trigger");
    CHECK(xrGetInputSourceLocalizedName(session, &get, 5, &count, name) == XR_ERROR_SIZE_INSUFFICIENT);
    get.whichComponents = 0;
    CHECK(xrGetInputSourceLocalizedName(session, &get, 64, &count, name) == XR_ERROR_VALIDATION_FAILURE);
    get.whichComponents = XR_INPUT_SOURCE_LOCALIZED_NAME_COMPONENT_BIT;
    CHECK(xrGetInputSourceLocalizedName(session, &get, 64, &count, name) == XR_SUCCESS);
    CHECK(std::string(name) == "Trigger");
    get.sourcePath = left;
    CHECK(xrGetInputSourceLocalizedName(session, &get, 64, &count, name) == XR_ERROR_PATH_UNSUPPORTED);
    get.sourcePath = XR_NULL_PATH;
    CHECK(xrGetInputSourceLocalizedName(session, &get, 64, &count, name) == XR_ERROR_PATH_INVALID);
}

TEST_CASE_FIXTURE(InputFixture, "haptics go to haptic actions, in focus") {
    attach({set});
    XrHapticVibration vibration{XR_TYPE_HAPTIC_VIBRATION, nullptr, XR_MIN_HAPTIC_DURATION, XR_FREQUENCY_UNSPECIFIED, 0.5f};
    const auto* const feedback = reinterpret_cast<const XrHapticBaseHeader*>(&vibration);
    XrHapticActionInfo info{XR_TYPE_HAPTIC_ACTION_INFO, nullptr, shake, left};
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_SESSION_NOT_FOCUSED);
    CHECK(xrStopHapticFeedback(session, &info) == XR_SESSION_NOT_FOCUSED);
    begin();
    frame();
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_SESSION_NOT_FOCUSED);
    CHECK(xrStopHapticFeedback(session, &info) == XR_SESSION_NOT_FOCUSED);
    frame();
    frame();
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_SUCCESS);
    CHECK(xrStopHapticFeedback(session, &info) == XR_SUCCESS);
    info.subactionPath = path("/user/head");
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_ERROR_PATH_UNSUPPORTED);
    info.subactionPath = XR_NULL_PATH;
    vibration.amplitude = 2;
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_ERROR_VALIDATION_FAILURE);
    vibration.amplitude = 1;
    vibration.type = XR_TYPE_UNKNOWN;
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrApplyHapticFeedback(session, &info, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    vibration.type = XR_TYPE_HAPTIC_VIBRATION;
    info.action = pull;
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_ERROR_ACTION_TYPE_MISMATCH);
    CHECK(xrStopHapticFeedback(session, &info) == XR_ERROR_ACTION_TYPE_MISMATCH);
    info.action = XR_NULL_HANDLE;
    CHECK(xrStopHapticFeedback(session, &info) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(InputFixture, "the log tells how strong a vibration is, and one of no strength is none") {
    attach({set});
    focus();
    XrHapticVibration vibration{XR_TYPE_HAPTIC_VIBRATION, nullptr, 20'000'000, XR_FREQUENCY_UNSPECIFIED, 0.25f};
    const auto* const feedback = reinterpret_cast<const XrHapticBaseHeader*>(&vibration);
    XrHapticActionInfo info{XR_TYPE_HAPTIC_ACTION_INFO, nullptr, shake, left};
    sync(set);
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_SUCCESS);
    vibration.amplitude = 0;
    CHECK(xrApplyHapticFeedback(session, &info, feedback) == XR_SUCCESS);
    frame();
    std::ifstream log(written / "frames.jsonl");
    std::string line, last;
    while (std::getline(log, line)) last = line;
    CHECK(last.find("\"haptic left on 20000000 0.25\",\"haptic left off\"]") != std::string::npos);
}

TEST_CASE("a script that moves what the program's controllers lack is refused when they are chosen") {
    struct Fixture : SessionFixture {
        Fixture() : SessionFixture("size 64 64\nframes none\npress left trigger 0 1\n") {}
    };
    const Fixture fixture;
    const XrActionSet set = fixture.makeActionSet("walking");
    const XrAction click = fixture.makeAction(set, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT);
    REQUIRE(fixture.suggest(kSimple, {{click, fixture.path("/user/hand/left/input/select/click")}}) == XR_SUCCESS);
    fixture.attach({set});
    fixture.focus();
    CHECK(fixture.sync(set) == XR_ERROR_RUNTIME_FAILURE);
    CHECK(fixture.sync(set) == XR_ERROR_RUNTIME_FAILURE);
}

TEST_CASE("other controllers taken up are announced and read, those that the program does not know are the first that it does") {
    struct Fixture : SessionFixture {
        Fixture()
            : SessionFixture(
                  "size 64 64\nframes none\nrate 10\npress left trigger 0 2\npress left select 0 2\n"
                  "at 0.5 profile khr/simple_controller\nat 0.7 profile valve/index_controller\n") {}
    } fixture;
    const XrPath left = fixture.path("/user/hand/left");
    const XrActionSet set = fixture.makeActionSet("walking");
    const XrAction by_trigger = fixture.makeAction(set, "pull", XR_ACTION_TYPE_FLOAT_INPUT);
    const XrAction by_select = fixture.makeAction(set, "select", XR_ACTION_TYPE_BOOLEAN_INPUT);
    REQUIRE(fixture.suggest(kTouch, {{by_trigger, fixture.path("/user/hand/left/input/trigger/value")}}) == XR_SUCCESS);
    REQUIRE(fixture.suggest(kSimple, {{by_select, fixture.path("/user/hand/left/input/select/click")}}) == XR_SUCCESS);
    fixture.attach({set});
    fixture.focus();
    XrEventDataBuffer event;
    while (fixture.poll(event) != XR_TYPE_UNKNOWN) {}
    const auto isPressed = [&](XrAction action, bool is_boolean) {
        const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, action, XR_NULL_PATH};
        XrActionStateBoolean boolean{XR_TYPE_ACTION_STATE_BOOLEAN};
        XrActionStateFloat number{XR_TYPE_ACTION_STATE_FLOAT};
        REQUIRE((is_boolean ? xrGetActionStateBoolean(fixture.session, &get, &boolean)
                            : xrGetActionStateFloat(fixture.session, &get, &number)) == XR_SUCCESS);
        return is_boolean ? boolean.currentState == XR_TRUE : number.currentState > 0.5f;
    };
    const char* in_use = nullptr;
    for (int shown = 2; shown < 9; ++shown) {
        CAPTURE(shown);
        const char* const expected = shown == 5 || shown == 6 ? kSimple : kTouch;
        REQUIRE(fixture.sync(set) == XR_SUCCESS);
        XrInteractionProfileState state{XR_TYPE_INTERACTION_PROFILE_STATE};
        REQUIRE(xrGetCurrentInteractionProfile(fixture.session, left, &state) == XR_SUCCESS);
        CHECK(state.interactionProfile == fixture.path(expected));
        CHECK((fixture.poll(event) == XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED) == (expected != in_use));
        CHECK(isPressed(by_trigger, false) == (expected == kTouch));
        CHECK(isPressed(by_select, true) == (expected == kSimple));
        in_use = expected;
        fixture.frame();
    }
}

TEST_CASE_FIXTURE(SessionFixture, "suggested paths are converted to the action's type") {
    const XrActionSet set = makeActionSet("walking");
    const XrAction as_boolean = makeAction(set, "boolean", XR_ACTION_TYPE_BOOLEAN_INPUT);
    const XrAction as_float = makeAction(set, "float", XR_ACTION_TYPE_FLOAT_INPUT);
    const XrAction as_stick = makeAction(set, "stick", XR_ACTION_TYPE_VECTOR2F_INPUT);
    REQUIRE(suggest(kSimple, {{as_float, path("/user/hand/left/input/select")},
                              {as_boolean, path("/user/hand/left/input/select")},
                              {as_stick, path("/user/hand/left/input/select/click")}}) == XR_SUCCESS);
    attach({set});
    focus();
    REQUIRE(sync(set) == XR_SUCCESS);
    const auto countOf = [&](XrAction action) {
        const XrBoundSourcesForActionEnumerateInfo info{XR_TYPE_BOUND_SOURCES_FOR_ACTION_ENUMERATE_INFO, nullptr, action};
        std::uint32_t count = 99;
        REQUIRE(xrEnumerateBoundSourcesForAction(session, &info, 0, &count, nullptr) == XR_SUCCESS);
        return count;
    };
    CHECK(countOf(as_boolean) == 1);
    CHECK(countOf(as_float) == 1);
    CHECK_MESSAGE(countOf(as_stick) == 0, "a button is no stick");
}

}  // namespace simulated_input_test
