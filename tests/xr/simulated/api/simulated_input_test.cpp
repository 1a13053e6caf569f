// Chapter 11 of OpenXR on the simulated runtime: action sets, actions, bindings, the values of actions, and
// haptics.
#include "tests/xr/simulated/api/simulated_fixture.h"

SUITE(simulated_input) {

constexpr auto kBoolean = XR_ACTION_TYPE_BOOLEAN_INPUT;

// Ten frames per second, so frame n is shown at n/10 seconds.
const std::string kScript = kQuietScript +
                            "rate 10\n"
                            "controller left 0 position -1 1 0\ncontroller left 2 position 1 1 0\n"
                            "press right a 0.45 0.65\n"
                            "axis right trigger 0 0\naxis right trigger 1 1\n"
                            "axis left trigger 0 0.2\n"
                            "axis right thumbstick 0 0 0\naxis right thumbstick 1 1 -1\n"
                            "at 1 controller right off\n";

struct InputFixture : SessionFixture {
    XrActionSet set = makeActionSet("walking");
    XrAction click = makeAction(set, "jump", kBoolean);
    XrAction pull = makeAction(set, "pull", XR_ACTION_TYPE_FLOAT_INPUT, {left, right});
    XrAction stick = makeAction(set, "stick", XR_ACTION_TYPE_VECTOR2F_INPUT);
    XrAction grip = makeAction(set, "grip", XR_ACTION_TYPE_POSE_INPUT, {left, right});
    XrAction shake = makeAction(set, "shake", XR_ACTION_TYPE_VIBRATION_OUTPUT, {left, right});

    InputFixture() : SessionFixture(kScript) {
        REQUIRE(suggest(kTouch, {{click, "/user/hand/right/input/a/click"},
                                 {pull, "/user/hand/left/input/trigger/value"},
                                 {pull, "/user/hand/right/input/trigger/value"},
                                 {stick, "/user/hand/right/input/thumbstick"},
                                 {grip, "/user/hand/left/input/grip/pose"},
                                 {grip, "/user/hand/right/input/grip/pose"},
                                 {shake, "/user/hand/left/output/haptic"},
                                 {shake, "/user/hand/right/output/haptic"}}) == XR_SUCCESS);
    }

    void start() const {
        attach({set});
        focus();
    }
    // Runs frames up to the one shown at n/10 seconds; the first three brought the session to FOCUSED.
    void runTo(int n) {
        for (; shown < n; ++shown) { frame(); }
        REQUIRE(sync(set) == XR_SUCCESS);
    }

private:
    int shown = 2;
};

TEST_CASE_FIXTURE(InstanceFixture, "sets have two names of their own, actions two in their set and a type") {
    XrActionSetCreateInfo set_info = actionSetInfo("walking", "Walking");
    XrActionCreateInfo info = actionInfo("walking", "Walking");
    XrActionSet set = XR_NULL_HANDLE, other_set = XR_NULL_HANDLE;
    XrAction action = XR_NULL_HANDLE, other = XR_NULL_HANDLE;
    checkEach(XR_SUCCESS,
              {xrCreateActionSet(instance, &set_info, &set), xrCreateAction(set, &info, &action)});
    for (const auto& [name, localized_name, expected] :
         {std::tuple("", "Running", XR_ERROR_NAME_INVALID),
          {"running", "", XR_ERROR_LOCALIZED_NAME_INVALID},
          {"Running", "Running", XR_ERROR_PATH_FORMAT_INVALID},
          {"run/ning", "Running", XR_ERROR_PATH_FORMAT_INVALID},
          {"running fast", "Running", XR_ERROR_PATH_FORMAT_INVALID},
          {"walking", "Running", XR_ERROR_NAME_DUPLICATED},
          {"running", "Walking", XR_ERROR_LOCALIZED_NAME_DUPLICATED},
          {"running", "\xC3\x28", XR_ERROR_VALIDATION_FAILURE},
          {"running", "L\xC3\xA4uft", XR_SUCCESS}}) {
        INFO(name, " ", localized_name);
        const XrActionSetCreateInfo of_set = actionSetInfo(name, localized_name);
        CHECK(xrCreateActionSet(instance, &of_set, &other_set) == expected);
        const XrActionCreateInfo of_action = actionInfo(name, localized_name);
        CHECK(xrCreateAction(set, &of_action, &other) == expected);
    }
    // A name is free in another set, and again once its owner is gone.
    checkEach(XR_SUCCESS, {xrCreateAction(other_set, &info, &other), xrDestroyAction(action),
                           xrCreateAction(set, &info, &action), xrDestroyActionSet(set),
                           xrCreateActionSet(instance, &set_info, &set)});
    CHECK(xrDestroyAction(action) == XR_ERROR_HANDLE_INVALID);
    checkArguments(xrCreateActionSet, instance, &set_info, &set);
    std::ranges::fill(set_info.actionSetName, 'a');
    CHECK(xrCreateActionSet(instance, &set_info, &other_set) == XR_ERROR_VALIDATION_FAILURE);
    info = actionInfo("roll", "Roll", XR_ACTION_TYPE_FLOAT_INPUT);
    XrPath paths[2] = {left, path("/user/gamepad")};
    info.countSubactionPaths = 2;
    info.subactionPaths = paths;
    const auto makeForHands = [&] { return xrCreateAction(set, &info, &other); };
    checkChanges(makeForHands, XR_ERROR_VALIDATION_FAILURE,
                 to(info.actionType, static_cast<XrActionType>(77)), to(info.subactionPaths, nullptr));
    checkChanges(makeForHands, XR_ERROR_PATH_UNSUPPORTED, to(paths[1], paths[0]),
                 to(paths[1], path("/user/foot/left")), to(paths[1], path("/user/eyes_ext")));
    CHECK(with(paths[1], 999'999, makeForHands) == XR_ERROR_PATH_INVALID);
    CHECK(makeForHands() == XR_SUCCESS);
    checkArguments(xrCreateAction, set, &info, &action);
    CHECK(xrDestroyActionSet(set) == XR_SUCCESS);
    CHECK(xrDestroyAction(other) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "suggestions are whole, sets are attached once and fixed from then on") {
    const XrActionSet set = makeActionSet("walking"), left_out = makeActionSet("running");
    const XrAction action = makeAction(set, "jump", kBoolean), other = makeAction(left_out, "jump", kBoolean);
    const std::string click = "/user/hand/left/input/select/click";
    XrActionSuggestedBinding binding{action, path(click)};
    XrInteractionProfileSuggestedBinding suggestion{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING, nullptr,
                                                    path(kSimple), 1, &binding};
    const auto suggestIt = [&] { return xrSuggestInteractionProfileBindings(instance, &suggestion); };
    CHECK(with(suggestion.countSuggestedBindings, 0, suggestIt) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(with(binding.action, XR_NULL_HANDLE, suggestIt) == XR_ERROR_HANDLE_INVALID);
    checkChanges(suggestIt, XR_ERROR_PATH_INVALID, to(binding.binding, XR_NULL_PATH),
                 to(binding.binding, 123'456), to(suggestion.interactionProfile, XR_NULL_PATH));
    CHECK(with(suggestion.interactionProfile, left, suggestIt) == XR_ERROR_PATH_UNSUPPORTED);
    checkArguments(xrSuggestInteractionProfileBindings, instance, &suggestion);

    XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
    XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, action, XR_NULL_PATH};
    XrInteractionProfileState profile{XR_TYPE_INTERACTION_PROFILE_STATE};
    checkEach(XR_ERROR_ACTIONSET_NOT_ATTACHED,
              {xrGetActionStateBoolean(session, &get, &state),
               xrGetCurrentInteractionProfile(session, left, &profile), sync(set)});
    const XrActionSet nothing = XR_NULL_HANDLE;
    XrSessionActionSetsAttachInfo info{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 1, &set};
    const auto attachIt = [&] { return xrAttachSessionActionSets(session, &info); };
    CHECK(with(info.countActionSets, 0, attachIt) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(with(info.actionSets, &nothing, attachIt) == XR_ERROR_HANDLE_INVALID);
    checkArguments(xrAttachSessionActionSets, session, &info);
    CHECK(attachIt() == XR_SUCCESS);
    CHECK(with(info.actionSets, &left_out, attachIt) == XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
    const XrActionCreateInfo late = actionInfo("duck", "Duck");
    XrAction made = XR_NULL_HANDLE;
    CHECK(xrCreateAction(set, &late, &made) == XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
    CHECK(xrCreateAction(left_out, &late, &made) == XR_SUCCESS);
    CHECK(suggest(kSimple, {{action, click}}) == XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
    CHECK(suggest(kSimple, {{other, click}}) == XR_SUCCESS);
    CHECK(boolean(action).isActive == XR_FALSE);
    CHECK(with(get.action, other, [&] { return xrGetActionStateBoolean(session, &get, &state); }) ==
          XR_ERROR_ACTIONSET_NOT_ATTACHED);
    CHECK(sync(left_out) == XR_ERROR_ACTIONSET_NOT_ATTACHED);
    CHECK(sync(XR_NULL_HANDLE) == XR_ERROR_HANDLE_INVALID);
    CHECK(sync(set) == XR_SESSION_NOT_FOCUSED);
    CHECK(profileOf(left) == "none");
    for (const char* nobody : {"/user/foot/left", "/user/eyes_ext"}) {
        CHECK(xrGetCurrentInteractionProfile(session, path(nobody), &profile) == XR_ERROR_PATH_UNSUPPORTED);
    }
    CHECK(xrGetCurrentInteractionProfile(session, XR_NULL_PATH, &profile) == XR_ERROR_PATH_INVALID);
}

TEST_CASE_FIXTURE(InputFixture, "a profile is in use, and announced, from the first sync in focus on") {
    attach({set});
    CHECK(sync(set) == XR_SESSION_NOT_FOCUSED);
    CHECK(profileOf(left) == "none");
    focus();
    CHECK(sync(set) == XR_SUCCESS);
    CHECK(these(profileOf(left), profileOf(path("/user/gamepad"))) == these(kTouch, "none"));
    CHECK(isProfileAnnounced());
    CHECK(sync(set) == XR_SUCCESS);
    XrEventDataBuffer event;
    CHECK(poll(event) == XR_TYPE_UNKNOWN);
}

TEST_CASE_FIXTURE(InputFixture, "states are got by type and hand, and sources have names") {
    start();
    REQUIRE(sync(set) == XR_SUCCESS);
    XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
    XrActionStateFloat number{XR_TYPE_ACTION_STATE_FLOAT};
    XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, pull, XR_NULL_PATH};
    const auto getBoolean = [&] { return xrGetActionStateBoolean(session, &get, &state); };
    const auto getNumber = [&] { return xrGetActionStateFloat(session, &get, &number); };
    CHECK(getBoolean() == XR_ERROR_ACTION_TYPE_MISMATCH);
    CHECK(with(get.subactionPath, path("/user/head"), getNumber) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(with(get.subactionPath, 88'888, getNumber) == XR_ERROR_PATH_INVALID);
    checkArguments(xrGetActionStateFloat, session, &get, &number);
    CHECK(with(get.action, XR_NULL_HANDLE, getBoolean) == XR_ERROR_HANDLE_INVALID);
    get = {XR_TYPE_ACTION_STATE_GET_INFO, nullptr, click, left};
    CHECK(getBoolean() == XR_ERROR_PATH_UNSUPPORTED);

    const XrBoundSourcesForActionEnumerateInfo info{XR_TYPE_BOUND_SOURCES_FOR_ACTION_ENUMERATE_INFO, nullptr,
                                                    pull};
    const auto sources = checkListOf(XrPath{}, xrEnumerateBoundSourcesForAction, session, &info);
    CHECK(sources == std::vector{path("/user/hand/left/input/trigger/value"),
                                 path("/user/hand/right/input/trigger/value")});
    XrInputSourceLocalizedNameGetInfo named{XR_TYPE_INPUT_SOURCE_LOCALIZED_NAME_GET_INFO, nullptr, sources[0],
                                            XR_INPUT_SOURCE_LOCALIZED_NAME_COMPONENT_BIT};
    const auto name = [&] {
        return std::string(checkListOf('\0', xrGetInputSourceLocalizedName, session, &named).data());
    };
    CHECK(name() == "Trigger");
    named.whichComponents = 7;
    CHECK(name() == "Left hand Touch controller Trigger");
    std::uint32_t count = 0;
    const auto getName = [&] { return xrGetInputSourceLocalizedName(session, &named, 0, &count, nullptr); };
    CHECK(with(named.whichComponents, 0, getName) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(with(named.sourcePath, left, getName) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(with(named.sourcePath, XR_NULL_PATH, getName) == XR_ERROR_PATH_INVALID);
}

TEST_CASE_FIXTURE(InputFixture, "presses are the script's, seen at syncs; of two hands the stronger counts") {
    start();
    runTo(4);
    CHECK(these(boolean(click).isActive, boolean(click).currentState, boolean(click).changedSinceLastSync) ==
          these(XR_TRUE, XR_FALSE, XR_FALSE));
    frame();
    CHECK_MESSAGE(boolean(click).currentState == XR_FALSE, "nothing changes between syncs");
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(these(boolean(click).currentState, boolean(click).changedSinceLastSync,
                boolean(click).lastChangeTime) == these(XR_TRUE, XR_TRUE, 1'500'000'000));
    CHECK(
        these(number(pull, left).currentState, number(pull, right).currentState, number(pull).currentState) ==
        these(doctest::Approx(0.2), doctest::Approx(0.5), doctest::Approx(0.5)));
    CHECK(these(vector(stick).currentState.x, vector(stick).currentState.y) ==
          these(doctest::Approx(0.5), doctest::Approx(-0.5)));
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(these(boolean(click).changedSinceLastSync, boolean(click).lastChangeTime) ==
          these(XR_FALSE, 1'500'000'000));
    for (int i = 0; i < 2; ++i) { frame(); }
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(these(boolean(click).currentState, boolean(click).changedSinceLastSync) ==
          these(XR_FALSE, XR_TRUE));
    // A set that is not synchronized is inactive, and so is a hand that is not included.
    REQUIRE(sync(set, left) == XR_SUCCESS);
    CHECK(these(number(pull, left).isActive, number(pull, right).isActive) == these(XR_TRUE, XR_FALSE));
    CHECK(sync() == XR_SUCCESS);
    CHECK(number(pull, left).isActive == XR_FALSE);
    CHECK(sync(set, path("/user/head")) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(sync(set, 77'777) == XR_ERROR_PATH_INVALID);
    const XrActionsSyncInfo missing{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, nullptr};
    CHECK(xrSyncActions(session, &missing) == XR_ERROR_VALIDATION_FAILURE);
    XrActionsSyncInfo nothing{XR_TYPE_ACTIONS_SYNC_INFO};
    checkArguments(xrSyncActions, session, &nothing);
}

TEST_CASE_FIXTURE(InputFixture, "spaces of poses move with their hands, also once the action is gone") {
    XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, grip, left, kIdentity};
    XrSpace made = XR_NULL_HANDLE;
    const auto make = [&] { return xrCreateActionSpace(session, &info, &made); };
    CHECK(with(info.subactionPath, path("/user/head"), make) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(with(info.subactionPath, 55'555, make) == XR_ERROR_PATH_INVALID);
    CHECK(with(info.action, XR_NULL_HANDLE, make) == XR_ERROR_HANDLE_INVALID);
    CHECK(with(info.poseInActionSpace.orientation.w, 2, make) == XR_ERROR_POSE_INVALID);
    checkArguments(xrCreateActionSpace, session, &info, &made);
    info.subactionPath = XR_NULL_PATH;
    CHECK(with(info.action, click, make) == XR_ERROR_ACTION_TYPE_MISMATCH);

    start();
    const XrSpace held = makeActionSpace(grip, right), other = makeActionSpace(grip, left);
    const XrSpace above = makeActionSpace(grip, right, {{0, 0, 0, 1}, {0, 0.5f, 0}});
    const XrSpace stage = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    CHECK_MESSAGE(locate(above, held, 1'500'000'000).locationFlags == 0, "no set was active yet");
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK((locate(held, local, 1'500'000'000).locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) != 0);
    CHECK(locate(other, stage, 1'000'000'000).pose.position.x == doctest::Approx(-1));

    // The right controller is off from 2 s on: inactive, and its space has no location. But spaces of the
    // same action have locations relative to each other while its set is active, whether that was read before
    // or after.
    CHECK(locate(above, held, 2'500'000'000).locationFlags == 15);
    runTo(11);
    CHECK(these(number(pull, right).isActive, number(pull, right).currentState,
                number(pull, right).lastChangeTime) == these(XR_FALSE, 0, 0));
    CHECK(number(pull).currentState == doctest::Approx(0.2));
    CHECK(pose(grip, right).isActive == XR_FALSE);
    CHECK(locate(held, local, 2'100'000'000).locationFlags == 0);
    XrSpaceVelocity velocity{XR_TYPE_SPACE_VELOCITY};
    XrSpaceLocation location = locate(above, held, 2'100'000'000, &velocity);
    CHECK(these(location.locationFlags, location.pose.position.y) == these(15, doctest::Approx(0.5)));
    CHECK(these(velocity.velocityFlags, velocity.linearVelocity.y) == these(kMoving, 0));
    location = locate(held, above, 2'100'000'000);
    CHECK(these(location.locationFlags, location.pose.position.y) == these(15, doctest::Approx(-0.5)));
    for (const XrSpace base : {other, local}) {
        CHECK(locate(above, base, 2'100'000'000).locationFlags == 0);
    }
    REQUIRE(sync(set, left) == XR_SUCCESS);
    CHECK(locate(above, held, 2'100'000'000).locationFlags == 0);
    CHECK(xrDestroyAction(grip) == XR_SUCCESS);
    CHECK(locate(other, stage, 2'500'000'000).pose.position.x == doctest::Approx(0.5));
}

TEST_CASE_FIXTURE(InputFixture, "a set of higher priority takes the controls that it uses") {
    const XrActionSet menu = makeActionSet("menu", 5);
    const XrAction choose = makeAction(menu, "choose", kBoolean);
    REQUIRE(suggest(kTouch, {{choose, "/user/hand/right/input/trigger/touch"},
                             {pull, "/user/hand/right/input/trigger/value"},
                             {click, "/user/hand/right/input/a/click"}}) == XR_SUCCESS);
    attach({set, menu});
    focus();
    REQUIRE(sync({{set, XR_NULL_PATH}, {menu, XR_NULL_PATH}}) == XR_SUCCESS);
    CHECK(number(pull, right).isActive == XR_FALSE);
    CHECK(these(boolean(choose).isActive, boolean(click).isActive) == these(XR_TRUE, XR_TRUE));
    REQUIRE(sync(set) == XR_SUCCESS);
    CHECK(number(pull, right).isActive == XR_TRUE);
}

TEST_CASE_FIXTURE(InputFixture,
                  "haptics go to haptic actions, in focus, and to the log, if not of strength 0") {
    attach({set});
    XrHapticVibration vibration{XR_TYPE_HAPTIC_VIBRATION, nullptr, XR_MIN_HAPTIC_DURATION, 0, 0.5f};
    const auto* const feedback = reinterpret_cast<const XrHapticBaseHeader*>(&vibration);
    XrHapticActionInfo info{XR_TYPE_HAPTIC_ACTION_INFO, nullptr, shake, left};
    const auto apply = [&] { return xrApplyHapticFeedback(session, &info, feedback); };
    const auto stop = [&] { return xrStopHapticFeedback(session, &info); };
    begin();
    frame();
    checkEach(XR_SESSION_NOT_FOCUSED, {apply(), stop()});
    frame();
    frame();
    checkEach(XR_SUCCESS, {apply(), stop()});
    CHECK(with(info.subactionPath, path("/user/head"), apply) == XR_ERROR_PATH_UNSUPPORTED);
    checkChanges(apply, XR_ERROR_VALIDATION_FAILURE, to(vibration.amplitude, 2),
                 to(vibration.type, XR_TYPE_UNKNOWN));
    CHECK(xrApplyHapticFeedback(session, &info, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    checkEach(XR_ERROR_ACTION_TYPE_MISMATCH, {with(info.action, pull, apply), with(info.action, pull, stop)});
    CHECK(with(info.action, XR_NULL_HANDLE, stop) == XR_ERROR_HANDLE_INVALID);

    frame();
    REQUIRE(sync(set) == XR_SUCCESS);
    vibration.duration = 20'000'000;
    checkChanges(apply, XR_SUCCESS, to(vibration.amplitude, 0.25f), to(vibration.amplitude, 0));
    frame();
    CHECK(logged().back()["events"] == nlohmann::json{"haptic left on 20000000 0.25", "haptic left off"});
}

// A press of what the simple controller lacks, and actions for all that its `select` can be bound to.
struct PressFixture : SessionFixture {
    XrActionSet set = makeActionSet("walking");
    XrAction by_trigger = makeAction(set, "pull", XR_ACTION_TYPE_FLOAT_INPUT);
    XrAction by_select = makeAction(set, "select", kBoolean);
    XrAction as_float = makeAction(set, "float", XR_ACTION_TYPE_FLOAT_INPUT);
    XrAction as_stick = makeAction(set, "stick", XR_ACTION_TYPE_VECTOR2F_INPUT);

    PressFixture(bool knows_touch, const std::string& script)
        : SessionFixture(kQuietScript + "rate 10\npress left trigger 0 2\n" + script) {
        REQUIRE(suggest(kSimple, {{by_select, "/user/hand/left/input/select"},
                                  {as_float, "/user/hand/left/input/select"},
                                  {as_stick, "/user/hand/left/input/select/click"}}) == XR_SUCCESS);
        const Bindings of_touch{{by_trigger, "/user/hand/left/input/trigger/value"}};
        if (knows_touch) { REQUIRE(suggest(kTouch, of_touch) == XR_SUCCESS); }
        attach({set});
        focus();
    }
};

TEST_CASE("a script that moves what the program's controllers lack is refused when they are chosen") {
    const PressFixture made(false, "");
    for (int i = 0; i < 2; ++i) { CHECK(made.sync(made.set) == XR_ERROR_RUNTIME_FAILURE); }
}

TEST_CASE("controllers taken up are announced and read; those that the program does not know are its first") {
    const PressFixture made(true,
                            "press left select 0 2\nat 0.5 profile khr/simple_controller\n"
                            "at 0.7 profile valve/index_controller\n");
    for (int shown = 2; shown < 9; ++shown) {
        CAPTURE(shown);
        const bool is_simple = shown == 5 || shown == 6;
        REQUIRE(made.sync(made.set) == XR_SUCCESS);
        CHECK(made.profileOf(made.left) == (is_simple ? kSimple : kTouch));
        CHECK(made.isProfileAnnounced() == (shown == 2 || shown == 5 || shown == 7));
        // A button is bound to a number, but not to a stick.
        CHECK(these(made.number(made.by_trigger).currentState, made.boolean(made.by_select).currentState,
                    made.number(made.as_float).currentState,
                    made.vector(made.as_stick).isActive) == these(!is_simple, is_simple, is_simple, false));
        made.frame();
    }
}

}  // SUITE(simulated_input)
