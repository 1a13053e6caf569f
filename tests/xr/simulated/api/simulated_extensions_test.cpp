// Extensions of the simulated runtime that need no graphics, in headless sessions and without a loader, and objects that end in every
// order.
#include "tests/xr/simulated/api/simulated_direct.h"

SUITE(simulated_extensions) {

constexpr auto kError = XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
constexpr auto kInfo = XR_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT;
constexpr auto kGeneral = XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
constexpr auto kValidation = XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
using Names = std::vector<std::string>;

std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * 1'000'000'000LL + time.tv_nsec; }

std::vector<bool> presences(const HeadlessSession& made) {
    std::vector<bool> found;
    for (const auto& change : made.events<XrEventDataUserPresenceChangedEXT>(XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT)) {
        CHECK(change.session == made.session);
        found.push_back(change.isUserPresent == XR_TRUE);
    }
    return found;
}

// The joints of a hand where they were located last.
struct Hand {
    const HeadlessSession& made;
    XrHandTrackerEXT tracker = XR_NULL_HANDLE;
    XrHandJointLocationEXT joints[XR_HAND_JOINT_COUNT_EXT];
    XrHandJointVelocityEXT speeds[XR_HAND_JOINT_COUNT_EXT];
    XrHandJointVelocitiesEXT velocities{XR_TYPE_HAND_JOINT_VELOCITIES_EXT, nullptr, XR_HAND_JOINT_COUNT_EXT, speeds};
    XrHandJointLocationsEXT locations{XR_TYPE_HAND_JOINT_LOCATIONS_EXT, &velocities, XR_TRUE, XR_HAND_JOINT_COUNT_EXT, joints};
    XrHandJointsLocateInfoEXT where{XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT};

    Hand(const HeadlessSession& session, XrHandEXT side) : made(session) {
        const XrHandTrackerCreateInfoEXT info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT, nullptr, side, XR_HAND_JOINT_SET_DEFAULT_EXT};
        REQUIRE(made.XR(xrCreateHandTrackerEXT)(made.session, &info, &tracker) == XR_SUCCESS);
        where.baseSpace = made.makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    }
    XrResult locate() { return made.XR(xrLocateHandJointsEXT)(tracker, &where, &locations); }
    bool isActiveAt(double time_s) {
        where.time = kStart + std::llround(1e9 * time_s);
        REQUIRE(locate() == XR_SUCCESS);
        return locations.isActive == XR_TRUE;
    }
    double reach(XrHandJointEXT tip, XrHandJointEXT from) const {
        const XrVector3f &a = joints[tip].pose.position, &b = joints[from].pose.position;
        return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    }
    double turning(XrHandJointEXT joint) const {
        const XrVector3f& speed = speeds[joint].angularVelocity;
        return std::hypot(speed.x, speed.y, speed.z);
    }
};

struct Heard {
    XrDebugUtilsMessageSeverityFlagsEXT severity;
    XrDebugUtilsMessageTypeFlagsEXT types;
    std::string id, function, text;
    Names labels, objects;
};

XrBool32 hear(XrDebugUtilsMessageSeverityFlagsEXT severity, XrDebugUtilsMessageTypeFlagsEXT types,
              const XrDebugUtilsMessengerCallbackDataEXT* data, void* heard) {
    const auto textOf = [](const char* text) { return text == nullptr ? "none" : text; };
    Heard message{severity, types, textOf(data->messageId), textOf(data->functionName), data->message, {}, {}};
    for (std::uint32_t i = 0; i < data->sessionLabelCount; ++i) { message.labels.emplace_back(data->sessionLabels[i].labelName); }
    for (std::uint32_t i = 0; i < data->objectCount; ++i) { message.objects.emplace_back(textOf(data->objects[i].objectName)); }
    static_cast<std::vector<Heard>*>(heard)->push_back(message);
    return XR_FALSE;
}

XrDebugUtilsMessengerCreateInfoEXT messengerOf(std::vector<Heard>& heard) {
    return {XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT, nullptr, kError | kInfo, kValidation | kGeneral, hear, &heard};
}

struct MessageFixture : HeadlessSession {
    std::vector<Heard> heard;
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;
    PFN_xrSubmitDebugUtilsMessageEXT submit = XR(xrSubmitDebugUtilsMessageEXT);
    PFN_xrSetDebugUtilsObjectNameEXT setName = XR(xrSetDebugUtilsObjectNameEXT);
    XrDebugUtilsObjectNameInfoEXT object{XR_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, XR_OBJECT_TYPE_SESSION,
                                         reinterpret_cast<std::uint64_t>(session), "the session"};

    MessageFixture() : HeadlessSession(k1_0, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME}) {
        const XrDebugUtilsMessengerCreateInfoEXT info = messengerOf(heard);
        REQUIRE(create(&info) == XR_SUCCESS);
    }
    XrResult create(const XrDebugUtilsMessengerCreateInfoEXT* info) {
        return XR(xrCreateDebugUtilsMessengerEXT)(instance, info, &messenger);
    }
    void beMistaken() const {
        XrPath path = XR_NULL_PATH;
        CHECK(XR(xrStringToPath)(instance, "no slash", &path) == XR_ERROR_PATH_FORMAT_INVALID);
    }
    std::string reason() {
        REQUIRE(heard.size() == 1);
        return std::exchange(heard, {})[0].text;
    }
};

XrDebugUtilsLabelEXT label(const char* name) { return {XR_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name}; }

struct Everything : HeadlessSession {
    struct Object {
        const char* parent;
        std::function<XrResult()> destroy;
    };
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;
    XrActionSet set = makeActionSet("set");
    XrAction action = makeAction(set, "grip", XR_ACTION_TYPE_POSE_INPUT);
    XrSpace reference_space = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE), action_space = XR_NULL_HANDLE;
    XrHandTrackerEXT tracker = Hand(*this, XR_HAND_LEFT_EXT).tracker;
    // By their names.
    std::map<std::string, Object> objects{
        {"messenger", {"", [&] { return XR(xrDestroyDebugUtilsMessengerEXT)(messenger); }}},
        {"set", {"", [&] { return XR(xrDestroyActionSet)(set); }}},
        {"action", {"set", [&] { return XR(xrDestroyAction)(action); }}},
        {"session", {"", [&] { return XR(xrDestroySession)(session); }}},
        {"reference space", {"session", [&] { return XR(xrDestroySpace)(reference_space); }}},
        {"action space", {"session", [&] { return XR(xrDestroySpace)(action_space); }}},
        {"tracker", {"session", [&] { return XR(xrDestroyHandTrackerEXT)(tracker); }}},
    };

    explicit Everything(bool attaches) : HeadlessSession(k1_1, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME, XR_EXT_HAND_TRACKING_EXTENSION_NAME}) {
        static std::vector<Heard> heard;
        const XrDebugUtilsMessengerCreateInfoEXT info = messengerOf(heard);
        REQUIRE(XR(xrCreateDebugUtilsMessengerEXT)(instance, &info, &messenger) == XR_SUCCESS);
        if (attaches) { attach({set}); }
        action_space = makeActionSpace(action);
        begin();
    }

    // What is left is used: it must not look at what is gone.
    void use(const std::set<std::string>& gone) const {
        XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
        CHECK(XR_SUCCEEDED(XR(xrPollEvent)(instance, &event)));
        if (!gone.contains("session")) { CHECK(XR_SUCCEEDED(sync())); }
        if (!gone.contains("reference space") && !gone.contains("action space")) { locate(action_space, reference_space, kStart); }
    }
};

TEST_CASE("time is converted to CLOCK_MONOTONIC and back") {
    const HeadlessSession made(k1_0, {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME});
    const auto toTime = made.XR(xrConvertTimespecTimeToTimeKHR);
    const auto toTimespec = made.XR(xrConvertTimeToTimespecTimeKHR);
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

    for (const XrTime bad : {XrTime{0}, XrTime{-1}, std::numeric_limits<XrTime>::max()}) {
        CHECK(toTimespec(made.instance, bad, &back) == XR_ERROR_TIME_INVALID);
    }
    checkArguments(toTime, made.instance, &now, &time);
    checkArguments([&](XrInstance of, timespec* place) { return toTimespec(of, time, place); }, made.instance, &back);
    for (const timespec bad : {timespec{0, 0}, timespec{-1, 0}, timespec{now.tv_sec, 1'000'000'000}, timespec{now.tv_sec, -1}}) {
        CHECK(toTime(made.instance, &bad, &time) == XR_ERROR_TIME_INVALID);
    }
}

TEST_CASE("with the real clock OpenXR's time and CLOCK_MONOTONIC go alike, also before the first frame") {
    Headset::clock = "real";
    const HeadlessSession made(k1_0, {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME});
    Headset::clock = "lockstep";
    const auto toTime = made.XR(xrConvertTimespecTimeToTimeKHR);
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

TEST_CASE("the application is told whether somebody wears the headset: when the session begins, and when that changes") {
    const std::string script = "rate 10\nat 0.15 present off\nat 0.35 present on\n";
    {
        const HeadlessSession made(k1_0, {XR_EXT_USER_PRESENCE_EXTENSION_NAME}, script);
        XrSystemUserPresencePropertiesEXT presence{XR_TYPE_SYSTEM_USER_PRESENCE_PROPERTIES_EXT, nullptr, XR_FALSE};
        XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES, &presence};
        CHECK(made.XR(xrGetSystemProperties)(made.instance, made.system, &properties) == XR_SUCCESS);
        CHECK(presence.supportsUserPresence == XR_TRUE);
        CHECK(presences(made).empty());
        made.begin();
        CHECK(presences(made) == std::vector<bool>{true});
        for (int i = 0; i < 3; ++i) { made.sync(); }
        CHECK(presences(made) == std::vector<bool>{false});
        for (int i = 0; i < 3; ++i) { made.sync(); }
        CHECK(presences(made) == std::vector<bool>{true});
    }
    // Without its extension nobody hears of it.
    const HeadlessSession plain(k1_0, {}, script);
    plain.begin();
    for (int i = 0; i < 3; ++i) { plain.sync(); }
    CHECK(presences(plain).empty());
}

TEST_CASE("the display's rate is one of a list, or the one that is fixed") {
    for (const bool is_fixed : {false, true}) {
        const HeadlessSession made(k1_0, {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME}, is_fixed ? "rate 80 fixed\n" : "rate 100\n");
        const auto request = [&](float rate) { return made.XR(xrRequestDisplayRefreshRateFB)(made.session, rate); };
        const auto list = [&](auto... step) { return made.XR(xrEnumerateDisplayRefreshRatesFB)(made.session, step...); };
        const std::vector<float> rates = checkList<float>(list);
        if (is_fixed) {
            CHECK(rates == std::vector<float>{80});
            CHECK(request(80) == XR_SUCCESS);
            CHECK(request(0) == XR_SUCCESS);
            CHECK(request(90) == XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB);
            continue;
        }
        const auto current = [&] {
            float rate = 0;
            CHECK(made.XR(xrGetDisplayRefreshRateFB)(made.session, &rate) == XR_SUCCESS);
            return rate;
        };
        CHECK(rates == std::vector<float>{72, 80, 90, 100, 120});
        CHECK(current() == 100);
        CHECK(request(75) == XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB);
        CHECK(request(NAN) == XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB);
        made.states();
        CHECK(request(80) == XR_SUCCESS);
        CHECK(request(80) == XR_SUCCESS);
        const auto changes = made.events<XrEventDataDisplayRefreshRateChangedFB>(XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB);
        REQUIRE(changes.size() == 1);
        CHECK(changes[0].fromDisplayRefreshRate == 100);
        CHECK(changes[0].toDisplayRefreshRate == 80);
        CHECK(current() == 80);
        CHECK(request(0) == XR_SUCCESS);
        CHECK(current() == 100);
        float rate = 0;
        checkArguments(made.XR(xrGetDisplayRefreshRateFB), made.session, &rate);
        CHECK(made.XR(xrRequestDisplayRefreshRateFB)(XR_NULL_HANDLE, 80) == XR_ERROR_HANDLE_INVALID);
    }
}

TEST_CASE("hands hold the script's controllers, in focus and while they are tracked") {
    const HeadlessSession made(k1_0, {XR_EXT_HAND_TRACKING_EXTENSION_NAME},
                               "rate 10\ncontroller left 0 position -0.2 1 0\ncontroller left 1 position 0.8 1 0\naxis right trigger 0 1\n"
                               "at 0.25 controller right off\n");
    XrSystemHandTrackingPropertiesEXT hands{XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT};
    XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES, &hands};
    CHECK(made.XR(xrGetSystemProperties)(made.instance, made.system, &properties) == XR_SUCCESS);
    CHECK(hands.supportsHandTracking == XR_TRUE);

    const auto create = made.XR(xrCreateHandTrackerEXT);
    XrHandTrackerCreateInfoEXT info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT, nullptr, XR_HAND_LEFT_EXT, XR_HAND_JOINT_SET_DEFAULT_EXT};
    XrHandTrackerEXT none = XR_NULL_HANDLE;
    const auto make = [&] { return create(made.session, &info, &none); };
    checkChanges(make, XR_ERROR_VALIDATION_FAILURE, to(info.hand, static_cast<XrHandEXT>(3)),
                 to(info.handJointSet, static_cast<XrHandJointSetEXT>(1)));
    checkArguments(create, made.session, &info, &none);

    Hand left(made, XR_HAND_LEFT_EXT), right(made, XR_HAND_RIGHT_EXT);
    CHECK_MESSAGE(!left.isActiveAt(0.1), "not in focus yet");
    CHECK(left.joints[3].locationFlags == 0);
    made.begin();
    CHECK(left.isActiveAt(0.1));
    // The palm lies beside the grip pose, at -0.1 1 0, and moves a metre a second.
    CHECK(left.joints[XR_HAND_JOINT_PALM_EXT].pose.position.x == doctest::Approx(-0.12));
    CHECK(left.joints[XR_HAND_JOINT_PALM_EXT].pose.position.y == doctest::Approx(1));
    for (const auto& joint : left.joints) {
        CHECK(joint.locationFlags == 15);
        CHECK(joint.radius > 0);
    }
    for (const auto& speed : left.speeds) { CHECK(speed.linearVelocity.x == doctest::Approx(1)); }
    // The right trigger is pulled: its index finger is bent, no other.
    CHECK(right.isActiveAt(0.1));
    const double straight = left.reach(XR_HAND_JOINT_INDEX_TIP_EXT, XR_HAND_JOINT_INDEX_PROXIMAL_EXT);
    CHECK(straight == doctest::Approx(0.085));
    CHECK(right.reach(XR_HAND_JOINT_INDEX_TIP_EXT, XR_HAND_JOINT_INDEX_PROXIMAL_EXT) < 0.6 * straight);
    CHECK(right.reach(XR_HAND_JOINT_LITTLE_TIP_EXT, XR_HAND_JOINT_LITTLE_PROXIMAL_EXT) == doctest::Approx(0.07));
    CHECK_FALSE(right.isActiveAt(0.3));

    const auto locate = [&] { return left.locate(); };
    checkChanges(locate, XR_ERROR_VALIDATION_FAILURE, to(left.locations.jointCount, 25), to(left.velocities.jointCount, 25));
    CHECK(with(left.where.time, 0, locate) == XR_ERROR_TIME_INVALID);
    CHECK(with(left.where.baseSpace, XR_NULL_HANDLE, locate) == XR_ERROR_HANDLE_INVALID);
    checkArguments(made.XR(xrLocateHandJointsEXT), left.tracker, &left.where, &left.locations);
    const auto destroy = made.XR(xrDestroyHandTrackerEXT);
    CHECK(destroy(left.tracker) == XR_SUCCESS);
    CHECK(destroy(left.tracker) == XR_ERROR_HANDLE_INVALID);
    CHECK(locate() == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE("the joints of a hand turn with its controller, and those of a finger that bends with that, too") {
    const HeadlessSession made(k1_0, {XR_EXT_HAND_TRACKING_EXTENSION_NAME},
                               "rate 10\ncontroller left 0 position 0 1 0 turn 0 0\ncontroller left 1 position 0 1 0 turn 45 0\n"
                               "axis right trigger 0 0\naxis right trigger 1 1\n");
    made.begin();
    Hand left(made, XR_HAND_LEFT_EXT), right(made, XR_HAND_RIGHT_EXT);
    for (Hand* hand : {&left, &right}) {
        REQUIRE(hand->isActiveAt(0.5));
        for (const auto& speed : hand->speeds) { CHECK(speed.velocityFlags == kMoving); }
    }
    // A quarter of pi in a second, to the left, which is about +y.
    for (const auto& speed : left.speeds) {
        CHECK(speed.angularVelocity.x == doctest::Approx(0));
        CHECK(speed.angularVelocity.y == doctest::Approx(0.25 * 3.14159265).epsilon(1e-3));
        CHECK(speed.angularVelocity.z == doctest::Approx(0));
    }
    CHECK(right.turning(XR_HAND_JOINT_INDEX_TIP_EXT) > 1);
    CHECK(right.turning(XR_HAND_JOINT_LITTLE_TIP_EXT) == doctest::Approx(0));
}

TEST_CASE_FIXTURE(MessageFixture, "a refused call is told to the application's own function, with what was wrong, to which it asked for") {
    beMistaken();
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].severity == kError);
    CHECK(heard[0].types == kValidation);
    CHECK(heard[0].id == "XR_ERROR_PATH_FORMAT_INVALID");
    CHECK(heard[0].function == "xrStringToPath");
    CHECK(heard[0].text == "'no slash' is not a well-formed path");
    CHECK(heard[0].labels.empty());
    // The loader's own questions are no mistakes.
    CHECK_FALSE(has("xrMakeCoffee"));
    CHECK(heard.size() == 1);
    CHECK(XR(xrDestroyDebugUtilsMessengerEXT)(messenger) == XR_SUCCESS);
    beMistaken();
    CHECK(heard.size() == 1);
    CHECK(XR(xrDestroyDebugUtilsMessengerEXT)(messenger) == XR_ERROR_HANDLE_INVALID);

    XrDebugUtilsMessengerCreateInfoEXT info = messengerOf(heard);
    const auto make = [&] { return create(&info); };
    checkChanges(make, XR_SUCCESS, to(info.messageSeverities, XR_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT),
                 to(info.messageTypes, XR_DEBUG_UTILS_MESSAGE_TYPE_CONFORMANCE_BIT_EXT));
    beMistaken();
    CHECK(heard.size() == 1);
    checkChanges(make, XR_ERROR_VALIDATION_FAILURE, to(info.messageSeverities, 0), to(info.messageSeverities, 2), to(info.messageTypes, 0),
                 to(info.messageTypes, 1 << 9), to(info.userCallback, nullptr));
    checkArguments(XR(xrCreateDebugUtilsMessengerEXT), instance, &info, &messenger);
}

TEST_CASE_FIXTURE(MessageFixture, "the reason of a refusal names what was refused") {
    const std::string trigger = "/user/hand/left/input/trigger/", profiles = "/interaction_profiles/";
    for (const auto& [profile, binding, expected] :
         {std::tuple("khr/simple_controller", "value",
                     "khr/simple_controller has no /user/hand/left/input/trigger/value, suggested for the action action"),
          std::tuple("oculus/touch_controller", "proximity",
                     "oculus/touch_controller has no /user/hand/left/input/trigger/proximity without XR_VERSION_1_1, suggested for the "
                     "action action"),
          std::tuple("meta/touch_plus_controller", "value", "meta/touch_plus_controller needs XR_VERSION_1_1"),
          std::tuple("nobody/nothing", "value", "nobody/nothing is not an interaction profile")}) {
        CHECK(suggest(profiles + profile, trigger + binding) == XR_ERROR_PATH_UNSUPPORTED);
        CHECK(reason() == profiles + expected);
    }
    std::uint32_t count = 0;
    char text[4];
    CHECK(XR(xrPathToString)(instance, path("/user/head"), 4, &count, text) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(reason() == "the array has room for 4, must have for 11");
    CHECK(XR(xrPathToString)(instance, 4711, 4, &count, text) == XR_ERROR_PATH_INVALID);
    CHECK(reason() == "the number 4711 is not a path");
    XrSpace space = XR_NULL_HANDLE;
    XrReferenceSpaceCreateInfo info{XR_TYPE_ACTION_CREATE_INFO, nullptr, XR_REFERENCE_SPACE_TYPE_LOCAL, {{0, 0, 0, 2}, {0, 0, 0}}};
    const auto make = XR(xrCreateReferenceSpace);
    CHECK(make(session, &info, &space) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(reason() == "a structure is of type XR_TYPE_ACTION_CREATE_INFO, must be XR_TYPE_REFERENCE_SPACE_CREATE_INFO");
    info.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    CHECK(make(session, &info, &space) == XR_ERROR_POSE_INVALID);
    CHECK(reason() == "the quaternion 0 0 0 2 is not of length 1");
    CHECK(make(reinterpret_cast<XrSession>(0x1234), &info, &space) == XR_ERROR_HANDLE_INVALID);
    CHECK(reason() == "0x1234 is not an XrSession that lives");
}

TEST_CASE_FIXTURE(MessageFixture, "applications submit messages of their own, with the session's labels and the objects' names") {
    const auto begin_region = XR(xrSessionBeginDebugUtilsLabelRegionEXT);
    const auto end_region = XR(xrSessionEndDebugUtilsLabelRegionEXT);
    const auto insert = XR(xrSessionInsertDebugUtilsLabelEXT);
    const auto frame = label("frame"), eye = label("left eye"), here = label("here"), nameless = label(nullptr);
    CHECK(begin_region(session, &frame) == XR_SUCCESS);
    CHECK(begin_region(session, &eye) == XR_SUCCESS);
    CHECK(insert(session, &here) == XR_SUCCESS);
    CHECK(setName(instance, &object) == XR_SUCCESS);
    object.objectName = nullptr;
    XrDebugUtilsMessengerCallbackDataEXT data{
        XR_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT, nullptr, nullptr, "main", "hello", 1, &object, 0, nullptr};
    CHECK(submit(instance, kInfo, kGeneral, &data) == XR_SUCCESS);
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].text == "hello");
    CHECK(heard[0].function == "main");
    CHECK(heard[0].severity == kInfo);
    CHECK(heard[0].labels == Names{"here", "left eye", "frame"});
    CHECK(heard[0].objects == Names{"the session"});

    CHECK(setName(instance, &object) == XR_SUCCESS);
    CHECK(end_region(session) == XR_SUCCESS);
    CHECK(submit(instance, kInfo, kGeneral, &data) == XR_SUCCESS);
    REQUIRE(heard.size() == 2);
    CHECK(heard[1].labels == Names{"frame"});
    CHECK(heard[1].objects == Names{"none"});
    CHECK(submit(instance, XR_DEBUG_UTILS_MESSAGE_SEVERITY_VERBOSE_BIT_EXT, kGeneral, &data) == XR_SUCCESS);
    CHECK(heard.size() == 2);

    CHECK(submit(instance, 0, kGeneral, &data) == XR_ERROR_VALIDATION_FAILURE);
    data.message = nullptr;
    CHECK(submit(instance, kInfo, kGeneral, &data) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(submit(XR_NULL_HANDLE, kInfo, kGeneral, &data) == XR_ERROR_HANDLE_INVALID);
    object.objectHandle = 0;
    CHECK(setName(instance, &object) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(begin_region(XR_NULL_HANDLE, &frame) == XR_ERROR_HANDLE_INVALID);
    CHECK(begin_region(session, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(insert(session, &nameless) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(end_region(XR_NULL_HANDLE) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(MessageFixture, "what an application's message says is passed on, but objects go by the names they were given for good") {
    const auto region = label("the session's own");
    CHECK(XR(xrSessionBeginDebugUtilsLabelRegionEXT)(session, &region) == XR_SUCCESS);
    CHECK(setName(instance, &object) == XR_SUCCESS);
    XrDebugUtilsLabelEXT labels[]{label("inner"), label("outer")};
    XrDebugUtilsObjectNameInfoEXT objects[3] = {object, object, object};
    objects[0].objectName = "passed";
    objects[1].objectName = nullptr;
    objects[2].objectHandle = 77;
    objects[2].objectName = "never registered";
    XrDebugUtilsMessengerCallbackDataEXT data{
        XR_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT, nullptr, nullptr, nullptr, "hello", 3, objects, 2, labels};
    const auto send = [&] { return submit(instance, kInfo, kGeneral, &data); };
    CHECK(send() == XR_SUCCESS);
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].id == "none");
    CHECK(heard[0].function == "none");
    CHECK(heard[0].labels == Names{"inner", "outer"});
    CHECK(heard[0].objects == Names{"the session", "the session", "never registered"});
    data.messageId = "an id";
    data.functionName = "";
    CHECK(send() == XR_SUCCESS);
    REQUIRE(heard.size() == 2);
    CHECK(heard[1].id == "an id");
    CHECK(heard[1].function.empty());
    checkChanges(send, XR_ERROR_VALIDATION_FAILURE, to(labels[1].labelName, nullptr), to(data.sessionLabels, nullptr));
}

TEST_CASE("a messenger in the chain hears why the instance itself was refused; messages come through the loader, too") {
    std::vector<Heard> heard;
    XrDebugUtilsMessengerCreateInfoEXT messenger_info = messengerOf(heard);
    {
        const Headset headset(kQuietScript);
        const Direct runtime;
        const Extensions foreign{XR_EXT_DEBUG_UTILS_EXTENSION_NAME, "XR_KHR_opengl_enable"}, unknown{"XR_KHR_nothing"};
        XrInstanceCreateInfo info = instanceInfo(foreign);
        info.next = &messenger_info;
        CHECK(tryInstance(info, runtime.get) == XR_ERROR_EXTENSION_NOT_PRESENT);
        REQUIRE(heard.size() == 1);
        CHECK(heard[0].id == "XR_ERROR_EXTENSION_NOT_PRESENT");
        CHECK(heard[0].text == "XR_KHR_opengl_enable: this runtime has Vulkan alone, XR_KHR_vulkan_enable2 or XR_KHR_vulkan_enable");
        // Without the extension nobody listens.
        info = instanceInfo(unknown);
        info.next = &messenger_info;
        CHECK(tryInstance(info, runtime.get) == XR_ERROR_EXTENSION_NOT_PRESENT);
        CHECK(heard.size() == 1);
    }
    heard.clear();
    const InstanceFixture made(kQuietScript, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME});
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;
    REQUIRE(made.XR(xrCreateDebugUtilsMessengerEXT)(made.instance, &messenger_info, &messenger) == XR_SUCCESS);
    XrPath path = XR_NULL_PATH;
    CHECK(xrStringToPath(made.instance, "no slash", &path) == XR_ERROR_PATH_FORMAT_INVALID);
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].function == "xrStringToPath");
    CHECK(heard[0].text == "'no slash' is not a well-formed path");
    CHECK(made.XR(xrDestroyDebugUtilsMessengerEXT)(messenger) == XR_SUCCESS);
}

TEST_CASE("objects end in every order, each once, and with their parents") {
    for (const bool attaches : {false, true}) {
        Names order;
        for (const auto& [name, object] : Everything(attaches).objects) { order.push_back(name); }
        int number = 0;
        do {
            // A share of the 5040 orders; 37 is prime, so that none of the objects keeps a place.
            if (number++ % 37 != 0) { continue; }
            const Everything made(attaches);
            std::set<std::string> gone;
            for (const std::string& name : order) {
                CHECK(made.objects.at(name).destroy() == (gone.contains(name) ? XR_ERROR_HANDLE_INVALID : XR_SUCCESS));
                for (const auto& [other, object] : made.objects) {
                    if (other == name || object.parent == name) { gone.insert(other); }
                }
                made.use(gone);
                CHECK(made.objects.at(name).destroy() == XR_ERROR_HANDLE_INVALID);
            }
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

}  // SUITE(simulated_extensions)
