// Chapter 11 of OpenXR on the simulated runtime, before anything moves: action sets, actions, suggested bindings, attaching.
#include "tests/xr/simulated/api/simulated_fixture.h"

TEST_SUITE_BEGIN("simulated_action");

namespace simulated_action_test {

using namespace binosplat::test;

namespace {

constexpr const char* kSimple = "/interaction_profiles/khr/simple_controller";

XrActionSetCreateInfo setInfo(const char* name, const char* localized_name) {
    XrActionSetCreateInfo info{XR_TYPE_ACTION_SET_CREATE_INFO};
    std::strcpy(info.actionSetName, name);
    std::strcpy(info.localizedActionSetName, localized_name);
    return info;
}

XrActionCreateInfo actionInfo(const char* name, const char* localized_name) {
    XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
    std::strcpy(info.actionName, name);
    std::strcpy(info.localizedActionName, localized_name);
    info.actionType = XR_ACTION_TYPE_BOOLEAN_INPUT;
    return info;
}

}  // namespace

TEST_CASE_FIXTURE(InstanceFixture, "an action set has two names of its own") {
    XrActionSet set = XR_NULL_HANDLE, other = XR_NULL_HANDLE;
    const auto make = [&](const char* name, const char* localized_name) {
        const XrActionSetCreateInfo info = setInfo(name, localized_name);
        return xrCreateActionSet(instance, &info, &other);
    };
    const XrActionSetCreateInfo first = setInfo("walking", "Walking");
    CHECK(xrCreateActionSet(instance, &first, &set) == XR_SUCCESS);
    CHECK(make("", "Running") == XR_ERROR_NAME_INVALID);
    CHECK(make("running", "") == XR_ERROR_LOCALIZED_NAME_INVALID);
    CHECK(make("Running", "Running") == XR_ERROR_PATH_FORMAT_INVALID);
    CHECK(make("run/ning", "Running") == XR_ERROR_PATH_FORMAT_INVALID);
    CHECK(make("running fast", "Running") == XR_ERROR_PATH_FORMAT_INVALID);
    CHECK(make("walking", "Running") == XR_ERROR_NAME_DUPLICATED);
    CHECK(make("running", "Walking") == XR_ERROR_LOCALIZED_NAME_DUPLICATED);
    CHECK(make("running", "\xC3\x28") == XR_ERROR_VALIDATION_FAILURE);
    CHECK(make("running", "L\xC3\xA4uft") == XR_SUCCESS);
    CHECK(xrDestroyActionSet(set) == XR_SUCCESS);
    CHECK(make("walking", "Walking") == XR_SUCCESS);
    CHECK(xrDestroyActionSet(set) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrCreateActionSet(instance, &first, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrCreateActionSet(instance, nullptr, &other) == XR_ERROR_VALIDATION_FAILURE);
    XrActionSetCreateInfo endless = first;
    std::memset(endless.actionSetName, 'a', sizeof endless.actionSetName);
    CHECK(xrCreateActionSet(instance, &endless, &other) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(InstanceFixture, "an action has two names of its own in its set, a type and known hands") {
    const XrActionSet set = makeActionSet("walking"), other_set = makeActionSet("running");
    XrAction action = XR_NULL_HANDLE, other = XR_NULL_HANDLE;
    XrActionCreateInfo info = actionInfo("jump", "Jump");
    CHECK(xrCreateAction(set, &info, &action) == XR_SUCCESS);
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_NAME_DUPLICATED);
    CHECK(xrCreateAction(other_set, &info, &other) == XR_SUCCESS);
    info = actionInfo("duck", "Jump");
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_LOCALIZED_NAME_DUPLICATED);
    CHECK(xrDestroyAction(action) == XR_SUCCESS);
    CHECK(xrDestroyAction(action) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrCreateAction(set, &info, &other) == XR_SUCCESS);
    info = actionInfo("", "Roll");
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_NAME_INVALID);
    info = actionInfo("roll", "");
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_LOCALIZED_NAME_INVALID);
    info = actionInfo("Roll", "Roll");
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_PATH_FORMAT_INVALID);
    info = actionInfo("roll", "Roll");
    info.actionType = static_cast<XrActionType>(77);
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_VALIDATION_FAILURE);
    info.actionType = XR_ACTION_TYPE_FLOAT_INPUT;
    info.countSubactionPaths = 2;
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_VALIDATION_FAILURE);
    XrPath paths[2] = {path("/user/hand/left"), path("/user/hand/left")};
    info.subactionPaths = paths;
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_PATH_UNSUPPORTED);
    paths[1] = path("/user/foot/left");
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_PATH_UNSUPPORTED);
    paths[1] = 999'999;
    CHECK(xrCreateAction(set, &info, &other) == XR_ERROR_PATH_INVALID);
    paths[1] = path("/user/gamepad");
    CHECK(xrCreateAction(set, &info, &other) == XR_SUCCESS);
    CHECK(xrCreateAction(XR_NULL_HANDLE, &info, &other) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrDestroyActionSet(set) == XR_SUCCESS);
    CHECK(xrDestroyAction(other) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(InstanceFixture, "each profile of the core takes its own paths and no others") {
    const XrActionSet set = makeActionSet("walking");
    const XrAction action = makeAction(set, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT);
    const auto binds = [&](const std::string& profile, const std::string& binding) {
        return suggest("/interaction_profiles/" + profile, {{action, path(binding)}});
    };
    for (const auto& [profile, binding] : {
             std::pair("khr/simple_controller", "/user/hand/left/input/select/click"),
             std::pair("khr/simple_controller", "/user/hand/right/output/haptic"),
             std::pair("google/daydream_controller", "/user/hand/left/input/trackpad/touch"),
             std::pair("htc/vive_controller", "/user/hand/right/input/squeeze/click"),
             std::pair("htc/vive_controller", "/user/hand/right/input/trackpad"),
             std::pair("htc/vive_pro", "/user/head/input/volume_up/click"),
             std::pair("microsoft/motion_controller", "/user/hand/left/input/thumbstick/x"),
             std::pair("microsoft/xbox_controller", "/user/gamepad/input/dpad_up/click"),
             std::pair("microsoft/xbox_controller", "/user/gamepad/output/haptic_left_trigger"),
             std::pair("oculus/go_controller", "/user/hand/left/input/back/click"),
             std::pair("oculus/touch_controller", "/user/hand/left/input/x/click"),
             std::pair("oculus/touch_controller", "/user/hand/right/input/a/touch"),
             std::pair("oculus/touch_controller", "/user/hand/left/input/thumbrest/touch"),
             std::pair("valve/index_controller", "/user/hand/left/input/squeeze/force"),
             std::pair("valve/index_controller", "/user/hand/left/input/a/click"),
         }) {
        CHECK_MESSAGE(binds(profile, binding) == XR_SUCCESS, binding);
    }
    for (const auto& [profile, binding] : {
             std::pair("khr/simple_controller", "/user/hand/left/input/trigger/value"),
             std::pair("khr/simple_controller", "/user/head/input/select/click"),
             std::pair("khr/simple_controller", "/user/hand/left"),
             std::pair("khr/simple_controller", "/user/hand/left/input"),
             std::pair("google/daydream_controller", "/user/hand/left/output/haptic"),
             std::pair("htc/vive_controller", "/user/hand/left/input/squeeze/value"),
             std::pair("htc/vive_pro", "/user/hand/left/input/system/click"),
             std::pair("microsoft/motion_controller", "/user/hand/left/input/squeeze/value"),
             std::pair("microsoft/xbox_controller", "/user/hand/left/input/a/click"),
             std::pair("microsoft/xbox_controller", "/user/gamepad/output/haptic"),
             std::pair("oculus/go_controller", "/user/hand/left/input/menu/click"),
             std::pair("oculus/touch_controller", "/user/hand/right/input/x/click"),
             std::pair("oculus/touch_controller", "/user/hand/left/input/a/click"),
             std::pair("oculus/touch_controller", "/user/hand/right/input/menu/click"),
             std::pair("oculus/touch_controller", "/user/hand/left/input/trig/value"),
             std::pair("oculus/touch_controller", "/user/hand/left/input/trigger/click"),
             std::pair("valve/index_controller", "/user/hand/left/input/trackpad/click"),
             std::pair("nobody/nothing", "/user/hand/left/input/a/click"),
         }) {
        CHECK_MESSAGE(binds(profile, binding) == XR_ERROR_PATH_UNSUPPORTED, binding);
    }
}

TEST_CASE_FIXTURE(InstanceFixture, "suggestions are whole") {
    const XrActionSet set = makeActionSet("walking");
    const XrAction action = makeAction(set, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT);
    const XrPath click = path("/user/hand/left/input/select/click");
    CHECK(suggest(kSimple, {}) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(suggest(kSimple, {{XR_NULL_HANDLE, click}}) == XR_ERROR_HANDLE_INVALID);
    CHECK(suggest(kSimple, {{action, XR_NULL_PATH}}) == XR_ERROR_PATH_INVALID);
    CHECK(suggest(kSimple, {{action, 123'456}}) == XR_ERROR_PATH_INVALID);
    CHECK(suggest("/user/hand/left", {{action, click}}) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(xrSuggestInteractionProfileBindings(instance, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    XrActionSuggestedBinding binding{action, click};
    XrInteractionProfileSuggestedBinding info{XR_TYPE_UNKNOWN, nullptr, path(kSimple), 1, &binding};
    CHECK(xrSuggestInteractionProfileBindings(instance, &info) == XR_ERROR_VALIDATION_FAILURE);
    info.type = XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING;
    info.interactionProfile = XR_NULL_PATH;
    CHECK(xrSuggestInteractionProfileBindings(instance, &info) == XR_ERROR_PATH_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "action sets are attached once, and are fixed from then on") {
    const XrActionSet set = makeActionSet("walking"), left_out = makeActionSet("running");
    const XrAction action = makeAction(set, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT);
    const XrAction other = makeAction(left_out, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT);
    XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
    XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, action, XR_NULL_PATH};
    XrInteractionProfileState profile{XR_TYPE_INTERACTION_PROFILE_STATE};
    CHECK(xrGetActionStateBoolean(session, &get, &state) == XR_ERROR_ACTIONSET_NOT_ATTACHED);
    CHECK(xrGetCurrentInteractionProfile(session, path("/user/hand/left"), &profile) == XR_ERROR_ACTIONSET_NOT_ATTACHED);
    CHECK(sync(set) == XR_ERROR_ACTIONSET_NOT_ATTACHED);

    XrSessionActionSetsAttachInfo info{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 0, &set};
    CHECK(xrAttachSessionActionSets(session, &info) == XR_ERROR_VALIDATION_FAILURE);
    const XrActionSet nothing = XR_NULL_HANDLE;
    info = {XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 1, &nothing};
    CHECK(xrAttachSessionActionSets(session, &info) == XR_ERROR_HANDLE_INVALID);
    attach({set});
    info.actionSets = &left_out;
    CHECK(xrAttachSessionActionSets(session, &info) == XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
    const XrActionCreateInfo late = actionInfo("duck", "Duck");
    XrAction made = XR_NULL_HANDLE;
    CHECK(xrCreateAction(set, &late, &made) == XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
    CHECK(xrCreateAction(left_out, &late, &made) == XR_SUCCESS);
    const XrPath click = path("/user/hand/left/input/select/click");
    CHECK(suggest(kSimple, {{action, click}}) == XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
    CHECK(suggest(kSimple, {{other, click}}) == XR_SUCCESS);

    CHECK(xrGetActionStateBoolean(session, &get, &state) == XR_SUCCESS);
    CHECK(state.isActive == XR_FALSE);
    get.action = other;
    CHECK(xrGetActionStateBoolean(session, &get, &state) == XR_ERROR_ACTIONSET_NOT_ATTACHED);
    CHECK(sync(left_out) == XR_ERROR_ACTIONSET_NOT_ATTACHED);
    CHECK(sync(XR_NULL_HANDLE) == XR_ERROR_HANDLE_INVALID);
    CHECK(sync(set) == XR_SESSION_NOT_FOCUSED);
    CHECK(xrGetCurrentInteractionProfile(session, path("/user/hand/left"), &profile) == XR_SUCCESS);
    CHECK(profile.interactionProfile == XR_NULL_PATH);
    CHECK(xrGetCurrentInteractionProfile(session, path("/user/foot/left"), &profile) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(xrGetCurrentInteractionProfile(session, XR_NULL_PATH, &profile) == XR_ERROR_PATH_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "action spaces are made of pose actions") {
    const XrActionSet set = makeActionSet("walking");
    const XrPath left = path("/user/hand/left"), right = path("/user/hand/right");
    const XrAction pose = makeAction(set, "grip", XR_ACTION_TYPE_POSE_INPUT, {left});
    const XrAction click = makeAction(set, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT);
    XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, pose, left, kIdentity};
    XrSpace space = XR_NULL_HANDLE;
    CHECK(xrCreateActionSpace(session, &info, &space) == XR_SUCCESS);
    info.subactionPath = right;
    CHECK(xrCreateActionSpace(session, &info, &space) == XR_ERROR_PATH_UNSUPPORTED);
    info.subactionPath = 55'555;
    CHECK(xrCreateActionSpace(session, &info, &space) == XR_ERROR_PATH_INVALID);
    info.subactionPath = XR_NULL_PATH;
    info.action = click;
    CHECK(xrCreateActionSpace(session, &info, &space) == XR_ERROR_ACTION_TYPE_MISMATCH);
    info.action = XR_NULL_HANDLE;
    CHECK(xrCreateActionSpace(session, &info, &space) == XR_ERROR_HANDLE_INVALID);
    info.action = pose;
    info.poseInActionSpace.orientation.w = 2;
    CHECK(xrCreateActionSpace(session, &info, &space) == XR_ERROR_POSE_INVALID);
    info.poseInActionSpace = kIdentity;
    info.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    CHECK(xrCreateActionSpace(session, &info, &space) == XR_ERROR_VALIDATION_FAILURE);
}

}  // namespace simulated_action_test
