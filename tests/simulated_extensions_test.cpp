// Extensions of the simulated runtime that need no graphics, in headless sessions and without a loader.
#include "tests/simulated_direct.h"

#include <cmath>
#include <limits>

using namespace binosplat::test;

namespace {

constexpr XrTime kStart = 1'000'000'000;

struct Heard {
    XrDebugUtilsMessageSeverityFlagsEXT severity;
    XrDebugUtilsMessageTypeFlagsEXT types;
    std::string id, function, text;
    std::vector<std::string> labels, objects;
};

XrBool32 hear(XrDebugUtilsMessageSeverityFlagsEXT severity, XrDebugUtilsMessageTypeFlagsEXT types,
              const XrDebugUtilsMessengerCallbackDataEXT* data, void* heard) {
    const auto textOf = [](const char* text) { return text == nullptr ? "none" : text; };
    Heard message{severity, types, textOf(data->messageId), textOf(data->functionName), data->message, {}, {}};
    for (std::uint32_t i = 0; i < data->sessionLabelCount; ++i) message.labels.emplace_back(data->sessionLabels[i].labelName);
    for (std::uint32_t i = 0; i < data->objectCount; ++i)
        message.objects.emplace_back(data->objects[i].objectName == nullptr ? "nameless" : data->objects[i].objectName);
    static_cast<std::vector<Heard>*>(heard)->push_back(message);
    return XR_FALSE;
}

XrDebugUtilsMessengerCreateInfoEXT messengerOf(std::vector<Heard>& heard) {
    return {XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            nullptr,
            XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | XR_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT,
            XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT,
            hear,
            &heard};
}

struct MessageFixture : HeadlessSession {
    std::vector<Heard> heard;
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;

    MessageFixture() : HeadlessSession(k1_0, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME}) {
        const XrDebugUtilsMessengerCreateInfoEXT info = messengerOf(heard);
        REQUIRE(create(&info) == XR_SUCCESS);
    }
    XrResult create(const XrDebugUtilsMessengerCreateInfoEXT* info) {
        return xr<PFN_xrCreateDebugUtilsMessengerEXT>("xrCreateDebugUtilsMessengerEXT")(instance, info, &messenger);
    }
    void beMistaken() const {
        XrPath path = XR_NULL_PATH;
        CHECK(xr<PFN_xrStringToPath>("xrStringToPath")(instance, "no slash", &path) == XR_ERROR_PATH_FORMAT_INVALID);
    }
};

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

TEST_CASE_FIXTURE(MessageFixture, "a refused call is told to the application's own function, with what was wrong") {
    beMistaken();
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].severity == XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT);
    CHECK(heard[0].types == XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT);
    CHECK(heard[0].id == "XR_ERROR_PATH_FORMAT_INVALID");
    CHECK(heard[0].function == "xrStringToPath");
    CHECK(heard[0].text == "not a well-formed path");
    CHECK(heard[0].labels.empty());
    // The loader's own questions are no mistakes.
    CHECK_FALSE(has("xrMakeCoffee"));
    CHECK(heard.size() == 1);
    CHECK(xr<PFN_xrDestroyDebugUtilsMessengerEXT>("xrDestroyDebugUtilsMessengerEXT")(messenger) == XR_SUCCESS);
    beMistaken();
    CHECK(heard.size() == 1);
    CHECK(xr<PFN_xrDestroyDebugUtilsMessengerEXT>("xrDestroyDebugUtilsMessengerEXT")(messenger) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(MessageFixture, "a messenger hears what it asked for, and has to ask for something") {
    XrDebugUtilsMessengerCreateInfoEXT info = messengerOf(heard);
    info.messageSeverities = XR_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
    CHECK(create(&info) == XR_SUCCESS);
    info = messengerOf(heard);
    info.messageTypes = XR_DEBUG_UTILS_MESSAGE_TYPE_CONFORMANCE_BIT_EXT;
    CHECK(create(&info) == XR_SUCCESS);
    beMistaken();
    CHECK(heard.size() == 1);
    const auto refused = [&](auto&& change) {
        XrDebugUtilsMessengerCreateInfoEXT bad = messengerOf(heard);
        change(bad);
        return create(&bad);
    };
    CHECK(refused([](auto& bad) { bad.messageSeverities = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad) { bad.messageSeverities = 2; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad) { bad.messageTypes = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad) { bad.messageTypes = 1 << 9; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad) { bad.userCallback = nullptr; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refused([](auto& bad) { bad.type = XR_TYPE_UNKNOWN; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(create(nullptr) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(MessageFixture, "applications submit messages of their own, with the session's labels and the objects' names") {
    const auto submit = xr<PFN_xrSubmitDebugUtilsMessageEXT>("xrSubmitDebugUtilsMessageEXT");
    const auto label = [](const char* name) { return XrDebugUtilsLabelEXT{XR_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name}; };
    const auto begin_region = xr<PFN_xrSessionBeginDebugUtilsLabelRegionEXT>("xrSessionBeginDebugUtilsLabelRegionEXT");
    const auto end_region = xr<PFN_xrSessionEndDebugUtilsLabelRegionEXT>("xrSessionEndDebugUtilsLabelRegionEXT");
    const auto insert = xr<PFN_xrSessionInsertDebugUtilsLabelEXT>("xrSessionInsertDebugUtilsLabelEXT");
    const auto frame = label("frame"), eye = label("left eye"), here = label("here");
    CHECK(begin_region(session, &frame) == XR_SUCCESS);
    CHECK(begin_region(session, &eye) == XR_SUCCESS);
    CHECK(insert(session, &here) == XR_SUCCESS);
    const auto handle = reinterpret_cast<std::uint64_t>(session);
    XrDebugUtilsObjectNameInfoEXT object{XR_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, XR_OBJECT_TYPE_SESSION, handle, "the session"};
    const auto setName = xr<PFN_xrSetDebugUtilsObjectNameEXT>("xrSetDebugUtilsObjectNameEXT");
    CHECK(setName(instance, &object) == XR_SUCCESS);
    object.objectName = nullptr;
    XrDebugUtilsMessengerCallbackDataEXT data{
        XR_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT, nullptr, nullptr, "main", "hello", 1, &object, 0, nullptr};
    const auto info = XR_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT;
    const auto general = XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    CHECK(submit(instance, info, general, &data) == XR_SUCCESS);
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].text == "hello");
    CHECK(heard[0].function == "main");
    CHECK(heard[0].severity == info);
    CHECK(heard[0].labels == std::vector<std::string>{"here", "left eye", "frame"});
    CHECK(heard[0].objects == std::vector<std::string>{"the session"});

    CHECK(setName(instance, &object) == XR_SUCCESS);
    CHECK(end_region(session) == XR_SUCCESS);
    CHECK(submit(instance, info, general, &data) == XR_SUCCESS);
    REQUIRE(heard.size() == 2);
    CHECK(heard[1].labels == std::vector<std::string>{"frame"});
    CHECK(heard[1].objects == std::vector<std::string>{"nameless"});
    CHECK(submit(instance, XR_DEBUG_UTILS_MESSAGE_SEVERITY_VERBOSE_BIT_EXT, general, &data) == XR_SUCCESS);
    CHECK(heard.size() == 2);

    CHECK(submit(instance, 0, general, &data) == XR_ERROR_VALIDATION_FAILURE);
    data.message = nullptr;
    CHECK(submit(instance, info, general, &data) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(submit(XR_NULL_HANDLE, info, general, &data) == XR_ERROR_HANDLE_INVALID);
    object.objectHandle = 0;
    CHECK(setName(instance, &object) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(begin_region(XR_NULL_HANDLE, &frame) == XR_ERROR_HANDLE_INVALID);
    CHECK(begin_region(session, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    const auto nameless = label(nullptr);
    CHECK(insert(session, &nameless) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(end_region(XR_NULL_HANDLE) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(MessageFixture, "what an application's message says is passed on as it is, and what it leaves out stays left out") {
    const auto submit = xr<PFN_xrSubmitDebugUtilsMessageEXT>("xrSubmitDebugUtilsMessageEXT");
    const XrDebugUtilsLabelEXT region{XR_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, "the session's own"};
    CHECK(xr<PFN_xrSessionBeginDebugUtilsLabelRegionEXT>("xrSessionBeginDebugUtilsLabelRegionEXT")(session, &region) == XR_SUCCESS);
    const auto handle = reinterpret_cast<std::uint64_t>(session);
    XrDebugUtilsObjectNameInfoEXT registered{XR_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, XR_OBJECT_TYPE_SESSION, handle,
                                             "registered"};
    CHECK(xr<PFN_xrSetDebugUtilsObjectNameEXT>("xrSetDebugUtilsObjectNameEXT")(instance, &registered) == XR_SUCCESS);

    XrDebugUtilsLabelEXT labels[]{{XR_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, "inner"}, {XR_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, "outer"}};
    XrDebugUtilsObjectNameInfoEXT objects[3] = {registered, registered, registered};
    objects[0].objectName = "passed";
    objects[1].objectName = nullptr;
    objects[2].objectHandle = 77;
    objects[2].objectName = "never registered";
    XrDebugUtilsMessengerCallbackDataEXT data{
        XR_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT, nullptr, nullptr, nullptr, "hello", 3, objects, 2, labels};
    const auto info = XR_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT;
    const auto general = XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    CHECK(submit(instance, info, general, &data) == XR_SUCCESS);
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].id == "none");
    CHECK(heard[0].function == "none");
    CHECK(heard[0].labels == std::vector<std::string>{"inner", "outer"});
    CHECK(heard[0].objects == std::vector<std::string>{"passed", "registered", "never registered"});
    data.messageId = "an id";
    data.functionName = "";
    CHECK(submit(instance, info, general, &data) == XR_SUCCESS);
    REQUIRE(heard.size() == 2);
    CHECK(heard[1].id == "an id");
    CHECK(heard[1].function.empty());
    labels[1].labelName = nullptr;
    CHECK(submit(instance, info, general, &data) == XR_ERROR_VALIDATION_FAILURE);
    data.sessionLabels = nullptr;
    CHECK(submit(instance, info, general, &data) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE("a messenger in the chain hears why the instance itself was refused") {
    const Headset headset(kQuietScript);
    const Direct runtime;
    std::vector<Heard> heard;
    XrDebugUtilsMessengerCreateInfoEXT messenger = messengerOf(heard);
    const std::vector<const char*> extensions{XR_EXT_DEBUG_UTILS_EXTENSION_NAME, "XR_KHR_opengl_enable"};
    XrInstanceCreateInfo info = instanceInfo(extensions);
    info.next = &messenger;
    XrInstance instance = XR_NULL_HANDLE;
    const auto create = runtime.function<PFN_xrCreateInstance>(XR_NULL_HANDLE, "xrCreateInstance");
    CHECK(create(&info, &instance) == XR_ERROR_EXTENSION_NOT_PRESENT);
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].id == "XR_ERROR_EXTENSION_NOT_PRESENT");
    CHECK(heard[0].text == "XR_KHR_opengl_enable: this runtime has Vulkan alone, XR_KHR_vulkan_enable2 or XR_KHR_vulkan_enable");
    // Without the extension nobody listens.
    const std::vector<const char*> unknown{"XR_KHR_nothing"};
    info = instanceInfo(unknown);
    info.next = &messenger;
    CHECK(create(&info, &instance) == XR_ERROR_EXTENSION_NOT_PRESENT);
    CHECK(heard.size() == 1);
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
