// OpenXR 1.1 on the simulated runtime, and the extensions of 1.0 that became part of it. Debian's loader knows 1.0 alone, so there is none
// here; sessions are headless (XR_MND_headless).
#include "tests/xr/simulated/api/simulated_direct.h"
#include "xr/simulated/openxr_later.h"

#include <algorithm>
#include <cmath>

TEST_SUITE_BEGIN("simulated_version");

namespace simulated_version_test {

using namespace binosplat::test;

namespace {

// The head a metre to the right of the room's middle, and turned to the left.
constexpr const char* kAside = "head 0 position 1 1.7 0 turn 90 20\nhead 1 position 2 1.7 0\n";

constexpr XrTime kStart = 1'000'000'000;

}  // namespace

TEST_CASE("the runtime negotiates 1.1, or what its loader can do with") {
    const Direct runtime;
    CHECK(XR_VERSION_MAJOR(runtime.api) == 1);
    CHECK(XR_VERSION_MINOR(runtime.api) == 1);
    void* const library = dlopen(Direct::path().c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto negotiate = reinterpret_cast<Negotiate>(dlsym(library, "xrNegotiateLoaderRuntimeInterface"));
    LoaderInfo older;
    older.most_api = XR_MAKE_VERSION(1, 0, 0xFFF);
    RuntimeRequest request;
    CHECK(negotiate(&older, &request) == XR_SUCCESS);
    CHECK(XR_VERSION_MINOR(request.api) == 0);
    dlclose(library);
}

TEST_CASE("instances are of 1.0 and 1.1, whatever the patch, and of nothing else") {
    for (const XrVersion good :
         {XR_MAKE_VERSION(1, 0, 0), XR_MAKE_VERSION(1, 0, 34), XR_MAKE_VERSION(1, 1, 0), XR_MAKE_VERSION(1, 1, 4711)}) {
        const DirectInstance made(good, {});
    }
    DirectInstance made(k1_1, {});
    CHECK(made.xr<PFN_xrDestroyInstance>("xrDestroyInstance")(made.instance) == XR_SUCCESS);
    for (const XrVersion bad : {XR_MAKE_VERSION(1, 2, 0), XR_MAKE_VERSION(2, 0, 0), XR_MAKE_VERSION(0, 9, 0), 1ULL}) {
        CHECK(made.make(bad, {}) == XR_ERROR_API_VERSION_UNSUPPORTED);
    }
    REQUIRE(made.make(k1_1, {}) == XR_SUCCESS);
}

TEST_CASE("names that are not ended are invalid") {
    const Headset headset(kQuietScript);
    const Direct runtime;
    const auto create = runtime.function<PFN_xrCreateInstance>(XR_NULL_HANDLE, "xrCreateInstance");
    XrInstance instance = XR_NULL_HANDLE;
    XrInstanceCreateInfo info = instanceInfo({});
    std::memset(info.applicationInfo.applicationName, 'a', sizeof info.applicationInfo.applicationName);
    CHECK(create(&info, &instance) == XR_ERROR_NAME_INVALID);
    info = instanceInfo({});
    std::memset(info.applicationInfo.engineName, 'a', sizeof info.applicationInfo.engineName);
    CHECK(create(&info, &instance) == XR_ERROR_NAME_INVALID);
    // Layers are the loader's, whatever they are called.
    const char* const layer = "XR_APILAYER_nobody_nothing";
    info = instanceInfo({});
    info.enabledApiLayerCount = 1;
    info.enabledApiLayerNames = &layer;
    REQUIRE(create(&info, &instance) == XR_SUCCESS);
    CHECK(runtime.function<PFN_xrDestroyInstance>(instance, "xrDestroyInstance")(instance) == XR_SUCCESS);
}

TEST_CASE("functions of 1.1 are there for instances of 1.1, and those of its extensions for instances that enabled them") {
    {
        const DirectInstance of_1_0(k1_0, {});
        CHECK_FALSE(of_1_0.has("xrLocateSpaces"));
        CHECK_FALSE(of_1_0.has("xrLocateSpacesKHR"));
    }
    {
        const DirectInstance with_extension(k1_0, {XR_KHR_LOCATE_SPACES_EXTENSION_NAME});
        CHECK_FALSE(with_extension.has("xrLocateSpaces"));
        CHECK(with_extension.has("xrLocateSpacesKHR"));
    }
    const DirectInstance of_1_1(k1_1, {});
    CHECK(of_1_1.has("xrLocateSpaces"));
    CHECK_FALSE(of_1_1.has("xrLocateSpacesKHR"));
}

TEST_CASE("values of 1.1 have names") {
    const DirectInstance made(k1_1, {});
    char text[XR_MAX_RESULT_STRING_SIZE];
    const auto nameResult = made.xr<PFN_xrResultToString>("xrResultToString");
    CHECK(nameResult(made.instance, static_cast<XrResult>(-1000710001), text) == XR_SUCCESS);
    CHECK(std::string(text) == "XR_ERROR_EXTENSION_DEPENDENCY_NOT_ENABLED");
    CHECK(nameResult(made.instance, static_cast<XrResult>(-1000710000), text) == XR_SUCCESS);
    CHECK(std::string(text) == "XR_ERROR_PERMISSION_INSUFFICIENT");
    const auto nameType = made.xr<PFN_xrStructureTypeToString>("xrStructureTypeToString");
    CHECK(nameType(made.instance, static_cast<XrStructureType>(1000471001), text) == XR_SUCCESS);
    CHECK(std::string(text) == "XR_TYPE_SPACE_LOCATIONS");
}

TEST_CASE("the view configuration of quad views is one of 1.1, also of a headset that has two views") {
    const auto inset = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO_WITH_FOVEATED_INSET;
    XrViewConfigurationProperties properties{XR_TYPE_VIEW_CONFIGURATION_PROPERTIES};
    const auto answerOf = [&](const DirectInstance& made) {
        return made.xr<PFN_xrGetViewConfigurationProperties>("xrGetViewConfigurationProperties")(made.instance, made.system, inset,
                                                                                                 &properties);
    };
    CHECK(answerOf(DirectInstance(k1_0, {})) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(answerOf(DirectInstance(k1_1, {})) == XR_SUCCESS);
    const std::string without = std::string(kQuietScript) + "extension XR_VARJO_quad_views off\n";
    CHECK(answerOf(DirectInstance(k1_1, {}, without)) == XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
}

TEST_CASE("LOCAL_FLOOR is there in 1.1, and in 1.0 by its extension: LOCAL brought down to the floor") {
    const auto floor = XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR;
    const auto isListed = [&](const HeadlessSession& made) {
        const auto types = made.spaceTypes();
        return std::find(types.begin(), types.end(), floor) != types.end();
    };
    {
        const HeadlessSession older(k1_0, {});
        XrSpace space = XR_NULL_HANDLE;
        CHECK_FALSE(isListed(older));
        CHECK(older.makeSpace(floor, space) == XR_ERROR_REFERENCE_SPACE_UNSUPPORTED);
        XrExtent2Df bounds;
        CHECK(older.xr<PFN_xrGetReferenceSpaceBoundsRect>("xrGetReferenceSpaceBoundsRect")(older.session, floor, &bounds) ==
              XR_ERROR_VALIDATION_FAILURE);
    }
    for (const auto& [version, extensions] :
         {std::pair(k1_1, std::vector<const char*>{}), std::pair(k1_0, std::vector<const char*>{XR_EXT_LOCAL_FLOOR_EXTENSION_NAME})}) {
        const HeadlessSession made(version, extensions, kAside);
        CHECK(isListed(made));
        XrExtent2Df bounds{-1, -1};
        CHECK(made.xr<PFN_xrGetReferenceSpaceBoundsRect>("xrGetReferenceSpaceBoundsRect")(made.session, floor, &bounds) ==
              XR_SPACE_BOUNDS_UNAVAILABLE);
        XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
        const auto locate = made.xr<PFN_xrLocateSpace>("xrLocateSpace");
        CHECK(locate(made.space(floor), made.space(XR_REFERENCE_SPACE_TYPE_STAGE), kStart, &location) == XR_SUCCESS);
        CHECK(location.pose.position.x == doctest::Approx(1));
        CHECK(location.pose.position.y == doctest::Approx(0));
        CHECK(location.pose.orientation.y == doctest::Approx(std::sqrt(0.5)));
        CHECK(locate(made.space(floor), made.space(XR_REFERENCE_SPACE_TYPE_LOCAL), kStart, &location) == XR_SUCCESS);
        CHECK(location.pose.position.x == doctest::Approx(0));
        CHECK(location.pose.position.y == doctest::Approx(-1.7));
        CHECK(location.pose.orientation.w == doctest::Approx(1));
    }
}

TEST_CASE("a recentring is announced for LOCAL, and for LOCAL_FLOOR where that is there") {
    const auto announced = [](const HeadlessSession& made) {
        made.begin();
        for (int frame = 0; frame < 3; ++frame) REQUIRE(made.sync() == XR_SUCCESS);
        std::vector<XrReferenceSpaceType> types;
        const auto poll = made.xr<PFN_xrPollEvent>("xrPollEvent");
        for (XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER}; poll(made.instance, &event) == XR_SUCCESS;
             event = {XR_TYPE_EVENT_DATA_BUFFER}) {
            if (event.type != XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) continue;
            const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
            CHECK(change.session == made.session);
            CHECK(change.changeTime == kStart + 150'000'000);
            // From where LOCAL began, at the head of time 0, to where the head is then; LOCAL_FLOOR is below it both times.
            CHECK(change.poseValid == XR_TRUE);
            CHECK(change.poseInPreviousSpace.position.x == doctest::Approx(0));
            const bool is_floor = change.referenceSpaceType == XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR;
            CHECK(change.poseInPreviousSpace.position.y == doctest::Approx(is_floor ? 0 : 0.15));
            CHECK(change.poseInPreviousSpace.position.z == doctest::Approx(-0.3));
            CHECK(change.poseInPreviousSpace.orientation.y == doctest::Approx(std::sin(std::acos(-1) / 24)));
            CHECK(change.poseInPreviousSpace.orientation.x == doctest::Approx(0));
            types.push_back(change.referenceSpaceType);
        }
        return types;
    };

    const std::string script = "rate 10\nhead 0 position 1 1.6 0 turn 90 0\nhead 1 position -1 2.6 0 turn 190 0\nat 0.15 recentre\n";
    const std::vector<XrReferenceSpaceType> both{XR_REFERENCE_SPACE_TYPE_LOCAL, XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR};
    CHECK(announced(HeadlessSession(k1_0, {}, script)) == std::vector{XR_REFERENCE_SPACE_TYPE_LOCAL});
    CHECK(announced(HeadlessSession(k1_0, {XR_EXT_LOCAL_FLOOR_EXTENSION_NAME}, script)) == both);
    CHECK(announced(HeadlessSession(k1_1, {}, script)) == both);
}

TEST_CASE("spaces are located all at once, as one by one") {
    const HeadlessSession made(k1_1, {}, kAside);
    const auto locateSpaces = made.xr<PFN_xrLocateSpaces>("xrLocateSpaces");
    const XrSpace view = made.space(XR_REFERENCE_SPACE_TYPE_VIEW), stage = made.space(XR_REFERENCE_SPACE_TYPE_STAGE);
    XrSpace spaces[3] = {view, made.space(XR_REFERENCE_SPACE_TYPE_LOCAL), stage};
    XrSpaceVelocityData speeds[3];
    XrSpaceVelocities velocities{XR_TYPE_SPACE_VELOCITIES, nullptr, 3, speeds};
    XrSpaceLocationData places[3];
    XrSpaceLocations locations{XR_TYPE_SPACE_LOCATIONS, &velocities, 3, places};
    XrSpacesLocateInfo info{XR_TYPE_SPACES_LOCATE_INFO, nullptr, stage, kStart + 500'000'000, 3, spaces};
    REQUIRE(locateSpaces(made.session, &info, &locations) == XR_SUCCESS);
    for (int i = 0; i < 3; ++i) {
        XrSpaceVelocity speed{XR_TYPE_SPACE_VELOCITY};
        XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, &speed};
        REQUIRE(made.xr<PFN_xrLocateSpace>("xrLocateSpace")(spaces[i], stage, info.time, &location) == XR_SUCCESS);
        CHECK(places[i].locationFlags == location.locationFlags);
        CHECK(std::memcmp(&places[i].pose, &location.pose, sizeof location.pose) == 0);
        CHECK(speeds[i].velocityFlags == speed.velocityFlags);
        CHECK(std::memcmp(&speeds[i].linearVelocity, &speed.linearVelocity, sizeof speed.linearVelocity) == 0);
    }
    CHECK(places[0].pose.position.x == doctest::Approx(1.5));
    CHECK(speeds[0].linearVelocity.x == doctest::Approx(1));

    const auto refused = [&](auto&& change) {
        XrSpacesLocateInfo bad = info;
        XrSpaceLocations output = locations;
        XrSpaceVelocities chained = velocities;
        output.next = &chained;
        change(bad, output, chained);
        return locateSpaces(made.session, &bad, &output);
    };
    CHECK(refused([](auto& bad, auto& output, auto&) { bad.spaceCount = output.locationCount = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad, auto&, auto&) { bad.spaceCount = 2; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto&, auto& output, auto&) { output.locationCount = 2; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto&, auto&, auto& chained) { chained.velocityCount = 2; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto&, auto&, auto& chained) { chained.velocities = nullptr; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto&, auto& output, auto&) { output.locations = nullptr; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad, auto&, auto&) { bad.spaces = nullptr; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad, auto&, auto&) { bad.type = XR_TYPE_UNKNOWN; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto&, auto& output, auto&) { output.type = XR_TYPE_UNKNOWN; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad, auto&, auto&) { bad.time = 0; }) == XR_ERROR_TIME_INVALID);
    CHECK(refused([](auto& bad, auto&, auto&) { bad.time = -42; }) == XR_ERROR_TIME_INVALID);
    CHECK(refused([](auto& bad, auto&, auto&) { bad.baseSpace = XR_NULL_HANDLE; }) == XR_ERROR_HANDLE_INVALID);
    spaces[2] = XR_NULL_HANDLE;
    CHECK(refused([](auto&, auto&, auto&) {}) == XR_ERROR_HANDLE_INVALID);
    CHECK(locateSpaces(XR_NULL_HANDLE, &info, &locations) == XR_ERROR_HANDLE_INVALID);
    CHECK(locateSpaces(made.session, nullptr, &locations) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(locateSpaces(made.session, &info, nullptr) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE("controllers and paths of 1.1 may be bound in 1.1, and in 1.0 with their extension") {
    struct Case {
        const char *profile, *extension, *binding;
        XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT;
    };
    const Case cases[] = {
        {"/interaction_profiles/hp/mixed_reality_controller", "XR_EXT_hp_mixed_reality_controller", "/user/hand/left/input/x/click"},
        {"/interaction_profiles/samsung/odyssey_controller", "XR_EXT_samsung_odyssey_controller", "/user/hand/left/input/trackpad/click"},
        {"/interaction_profiles/htc/vive_cosmos_controller", "XR_HTC_vive_cosmos_controller_interaction",
         "/user/hand/left/input/shoulder/click"},
        {"/interaction_profiles/htc/vive_focus3_controller", "XR_HTC_vive_focus3_controller_interaction",
         "/user/hand/right/input/squeeze/touch"},
        {"/interaction_profiles/ml/ml2_controller", "XR_ML_ml2_controller_interaction", "/user/hand/right/input/home/click"},
        {"/interaction_profiles/bytedance/pico_neo3_controller", "XR_BD_controller_interaction", "/user/hand/right/input/menu/click"},
        {"/interaction_profiles/bytedance/pico4_controller", "XR_BD_controller_interaction", "/user/hand/left/input/menu/click"},
        {"/interaction_profiles/bytedance/pico_g3_controller", "XR_BD_controller_interaction", "/user/hand/left/input/thumbstick/click"},
        {"/interaction_profiles/bytedance/pico_g3_controller", "XR_BD_controller_interaction", "/user/hand/right/input/thumbstick/x"},
        {"/interaction_profiles/oculus/touch_controller", nullptr, "/user/hand/left/input/trigger/proximity"},
        {"/interaction_profiles/oculus/touch_controller", nullptr, "/user/hand/right/input/thumb_resting_surfaces/proximity"},
        {"/interaction_profiles/meta/touch_pro_controller", nullptr, "/user/hand/left/input/stylus/force"},
        {"/interaction_profiles/meta/touch_pro_controller", nullptr, "/user/hand/left/output/haptic_thumb",
         XR_ACTION_TYPE_VIBRATION_OUTPUT},
        {"/interaction_profiles/meta/touch_plus_controller", nullptr, "/user/hand/left/input/trigger/force"},
        {"/interaction_profiles/meta/touch_controller_quest_2", nullptr, "/user/hand/left/input/thumbrest/touch"},
        {"/interaction_profiles/meta/touch_controller_quest_1_rift_s", nullptr, "/user/hand/left/input/trigger/proximity"},
        {"/interaction_profiles/meta/touch_controller_rift_cv1", nullptr, "/user/hand/left/input/thumb_resting_surfaces/proximity"},
    };
    for (const Case& one : cases) {
        INFO(one.profile);
        CHECK(DirectInstance(k1_1, {}).suggest(one.profile, one.binding, one.type) == XR_SUCCESS);
        CHECK(DirectInstance(k1_0, {}).suggest(one.profile, one.binding, one.type) == XR_ERROR_PATH_UNSUPPORTED);
        if (one.extension != nullptr)
            CHECK(DirectInstance(k1_0, {one.extension}).suggest(one.profile, one.binding, one.type) == XR_SUCCESS);
    }
    const DirectInstance made(k1_1, {});
    CHECK(made.suggest("/interaction_profiles/bytedance/pico4_controller", "/user/hand/right/input/menu/click") ==
          XR_ERROR_PATH_UNSUPPORTED);
    CHECK(made.suggest("/interaction_profiles/meta/touch_controller_quest_1_rift_s", "/user/hand/left/input/thumbrest/touch") ==
          XR_ERROR_PATH_UNSUPPORTED);
    CHECK(made.suggest("/interaction_profiles/htc/vive_cosmos_controller", "/user/hand/left/input/thumbrest/touch") ==
          XR_ERROR_PATH_UNSUPPORTED);
}

TEST_CASE("finger tips are poses of every hand with the hands' extension, and gestures are of its profile alone") {
    const char* const simple = "/interaction_profiles/khr/simple_controller";
    const char *const hands = "/interaction_profiles/ext/hand_interaction_ext", *const pinch = "/user/hand/left/input/pinch_ext/value";
    const char* const tips[] = {"/user/hand/left/input/pinch_ext/pose", "/user/hand/right/input/poke_ext/pose"};
    {
        const DirectInstance made(k1_1, {});
        for (const char* tip : tips) CHECK(made.suggest(simple, tip) == XR_ERROR_PATH_UNSUPPORTED);
        CHECK(made.suggest(hands, pinch, XR_ACTION_TYPE_FLOAT_INPUT) == XR_ERROR_PATH_UNSUPPORTED);
    }
    const DirectInstance extended(k1_1, {"XR_EXT_hand_interaction"});
    for (const char* tip : tips) CHECK(extended.suggest(simple, tip) == XR_SUCCESS);
    CHECK(extended.suggest(hands, pinch, XR_ACTION_TYPE_FLOAT_INPUT) == XR_SUCCESS);
    CHECK(extended.suggest(simple, pinch, XR_ACTION_TYPE_FLOAT_INPUT) == XR_ERROR_PATH_UNSUPPORTED);
}

TEST_CASE("the palm's surface is grip_surface in 1.1 and palm_ext by the extension") {
    const char* const simple = "/interaction_profiles/khr/simple_controller";
    const char *const grip_surface = "/user/hand/left/input/grip_surface/pose", *const palm = "/user/hand/left/input/palm_ext/pose";
    {
        const DirectInstance older(k1_0, {});
        CHECK(older.suggest(simple, grip_surface) == XR_ERROR_PATH_UNSUPPORTED);
        CHECK(older.suggest(simple, palm) == XR_ERROR_PATH_UNSUPPORTED);
    }
    {
        const DirectInstance extended(k1_0, {XR_EXT_PALM_POSE_EXTENSION_NAME});
        CHECK(extended.suggest(simple, grip_surface) == XR_ERROR_PATH_UNSUPPORTED);
        CHECK(extended.suggest(simple, palm) == XR_SUCCESS);
    }
    CHECK(DirectInstance(k1_0, {XR_KHR_MAINTENANCE1_EXTENSION_NAME}).suggest(simple, grip_surface) == XR_SUCCESS);
    const DirectInstance made(k1_1, {});
    CHECK(made.suggest(simple, grip_surface) == XR_SUCCESS);
    CHECK(made.suggest(simple, "/user/hand/left/input/grip_surface") == XR_SUCCESS);
    CHECK(made.suggest(simple, palm) == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(made.suggest("/interaction_profiles/microsoft/xbox_controller", "/user/gamepad/input/grip_surface/pose") ==
          XR_ERROR_PATH_UNSUPPORTED);
}

TEST_CASE("the palm's surface lies beside the grip, turned towards the index finger") {
    const HeadlessSession made(k1_1, {}, "controller left 0 position 1 2 3 turn 40 10\n");
    XrActionSetCreateInfo set_info{XR_TYPE_ACTION_SET_CREATE_INFO, nullptr, "set", "the set", 0};
    XrActionSet set = XR_NULL_HANDLE;
    REQUIRE(made.xr<PFN_xrCreateActionSet>("xrCreateActionSet")(made.instance, &set_info, &set) == XR_SUCCESS);
    const char* const hands[] = {"/user/hand/left", "/user/hand/right"};
    const XrPath paths[] = {made.path(hands[0]), made.path(hands[1])};
    std::vector<XrAction> actions;
    std::vector<XrActionSuggestedBinding> bindings;
    for (const char* name : {"grip", "grip_surface"}) {
        XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
        std::strcpy(info.actionName, name);
        std::strcpy(info.localizedActionName, name);
        info.actionType = XR_ACTION_TYPE_POSE_INPUT;
        info.countSubactionPaths = 2;
        info.subactionPaths = paths;
        XrAction action = XR_NULL_HANDLE;
        REQUIRE(made.xr<PFN_xrCreateAction>("xrCreateAction")(set, &info, &action) == XR_SUCCESS);
        actions.push_back(action);
        for (const char* hand : hands) bindings.push_back({action, made.path((std::string(hand) + "/input/" + name + "/pose").c_str())});
    }
    const XrInteractionProfileSuggestedBinding suggested{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING, nullptr,
                                                         made.path("/interaction_profiles/khr/simple_controller"), 4, bindings.data()};
    REQUIRE(made.xr<PFN_xrSuggestInteractionProfileBindings>("xrSuggestInteractionProfileBindings")(made.instance, &suggested) ==
            XR_SUCCESS);
    const XrSessionActionSetsAttachInfo attach{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 1, &set};
    REQUIRE(made.xr<PFN_xrAttachSessionActionSets>("xrAttachSessionActionSets")(made.session, &attach) == XR_SUCCESS);
    made.begin();
    const XrActiveActionSet active{set, XR_NULL_PATH};
    const XrActionsSyncInfo sync{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, &active};
    REQUIRE(made.xr<PFN_xrSyncActions>("xrSyncActions")(made.session, &sync) == XR_SUCCESS);
    for (int hand = 0; hand < 2; ++hand) {
        XrSpace spaces[2];
        for (int i = 0; i < 2; ++i) {
            const XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, actions[i], paths[hand], kIdentity};
            REQUIRE(made.xr<PFN_xrCreateActionSpace>("xrCreateActionSpace")(made.session, &info, &spaces[i]) == XR_SUCCESS);
        }
        XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
        REQUIRE(made.xr<PFN_xrLocateSpace>("xrLocateSpace")(spaces[1], spaces[0], kStart, &location) == XR_SUCCESS);
        CHECK(location.locationFlags == 15);
        CHECK(location.pose.position.x == doctest::Approx(hand == 0 ? -0.02 : 0.02));
        CHECK(location.pose.orientation.x == doctest::Approx(-std::sin(3.14159265 / 8)));
        CHECK(location.pose.orientation.w == doctest::Approx(std::cos(3.14159265 / 8)));
    }
}

}  // namespace simulated_version_test
