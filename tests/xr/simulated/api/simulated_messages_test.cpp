// XR_EXT_debug_utils on the simulated runtime: what its messengers hear. There is no loader here; sessions are headless.
#include "tests/xr/simulated/api/simulated_direct.h"

TEST_SUITE_BEGIN("simulated_messages");

namespace simulated_messages_test {

using namespace binosplat::test;

namespace {

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

}  // namespace

TEST_CASE_FIXTURE(MessageFixture, "a refused call is told to the application's own function, with what was wrong") {
    beMistaken();
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].severity == XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT);
    CHECK(heard[0].types == XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT);
    CHECK(heard[0].id == "XR_ERROR_PATH_FORMAT_INVALID");
    CHECK(heard[0].function == "xrStringToPath");
    CHECK(heard[0].text == "'no slash' is not a well-formed path");
    CHECK(heard[0].labels.empty());
    // The loader's own questions are no mistakes.
    CHECK_FALSE(has("xrMakeCoffee"));
    CHECK(heard.size() == 1);
    CHECK(xr<PFN_xrDestroyDebugUtilsMessengerEXT>("xrDestroyDebugUtilsMessengerEXT")(messenger) == XR_SUCCESS);
    beMistaken();
    CHECK(heard.size() == 1);
    CHECK(xr<PFN_xrDestroyDebugUtilsMessengerEXT>("xrDestroyDebugUtilsMessengerEXT")(messenger) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(MessageFixture, "the reason of a refusal names what was refused") {
    const char *const simple = "/interaction_profiles/khr/simple_controller", *const touch =
                                                                                  "/interaction_profiles/oculus/touch_controller";
    const auto reason = [&] {
        REQUIRE(heard.size() == 1);
        const std::string text = heard[0].text;
        heard.clear();
        return text;
    };
    CHECK(suggest(simple, "/user/hand/left/input/trigger/value") == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(reason() ==
          "/interaction_profiles/khr/simple_controller has no /user/hand/left/input/trigger/value, suggested for the action action");
    CHECK(suggest(touch, "/user/hand/left/input/trigger/proximity") == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(reason() ==
          "/interaction_profiles/oculus/touch_controller has no /user/hand/left/input/trigger/proximity without XR_VERSION_1_1, suggested "
          "for "
          "the action action");
    CHECK(suggest("/interaction_profiles/meta/touch_plus_controller", "/user/hand/left/input/trigger/value") == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(reason() == "/interaction_profiles/meta/touch_plus_controller needs XR_VERSION_1_1");
    CHECK(suggest("/interaction_profiles/nobody/nothing", "/user/hand/left/input/trigger/value") == XR_ERROR_PATH_UNSUPPORTED);
    CHECK(reason() == "/interaction_profiles/nobody/nothing is not an interaction profile");
    std::uint32_t count = 0;
    char text[4];
    CHECK(xr<PFN_xrPathToString>("xrPathToString")(instance, path("/user/head"), 4, &count, text) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(reason() == "the array has room for 4, must have for 11");
    CHECK(xr<PFN_xrPathToString>("xrPathToString")(instance, 4711, 4, &count, text) == XR_ERROR_PATH_INVALID);
    CHECK(reason() == "the number 4711 is not a path");
    XrSpace space = XR_NULL_HANDLE;
    XrReferenceSpaceCreateInfo info{XR_TYPE_ACTION_CREATE_INFO, nullptr, XR_REFERENCE_SPACE_TYPE_LOCAL, {{0, 0, 0, 2}, {0, 0, 0}}};
    const auto make = xr<PFN_xrCreateReferenceSpace>("xrCreateReferenceSpace");
    CHECK(make(session, &info, &space) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(reason() == "a structure is of type XR_TYPE_ACTION_CREATE_INFO, must be XR_TYPE_REFERENCE_SPACE_CREATE_INFO");
    info.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    CHECK(make(session, &info, &space) == XR_ERROR_POSE_INVALID);
    CHECK(reason() == "the quaternion 0 0 0 2 is not of length 1");
    CHECK(make(reinterpret_cast<XrSession>(0x1234), &info, &space) == XR_ERROR_HANDLE_INVALID);
    CHECK(reason() == "0x1234 is not an XrSession that lives");
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

TEST_CASE_FIXTURE(MessageFixture,
                  "what an application's message says is passed on, but objects go by the names that they were given for good") {
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
    CHECK(heard[0].objects == std::vector<std::string>{"registered", "registered", "never registered"});
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

}  // namespace simulated_messages_test
