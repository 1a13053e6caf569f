// XR_EXT_debug_utils on the simulated runtime: what the application's own function receives about refusals,
// and its own messages.
#include "tests/xr/simulated/api/simulated_direct.h"

SUITE(simulated_messages) {

constexpr auto kError = XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
               kInfo = XR_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT;
constexpr auto kGeneral = XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT,
               kValidation = XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
constexpr const char* kMistake =
    "error validation: XR_ERROR_PATH_FORMAT_INVALID in xrStringToPath: 'no slash' is not a well-formed path";

const char* orNone(const char* text) { return text == nullptr ? "none" : text; }

struct Heard {
    std::vector<std::string> messages;
    XrDebugUtilsMessengerCreateInfoEXT info{XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
                                            nullptr,
                                            kError | kInfo,
                                            kValidation | kGeneral,
                                            keep,
                                            &messages};

    // The only message since the last call.
    std::string take() {
        REQUIRE(messages.size() == 1);
        return std::exchange(messages, {})[0];
    }

private:
    // "info general: ID in FUNCTION: TEXT, in LABEL, of OBJECT"
    static XrBool32 keep(XrDebugUtilsMessageSeverityFlagsEXT severity, XrDebugUtilsMessageTypeFlagsEXT types,
                         const XrDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
        std::map<XrFlags64, std::string> severities{{kError, "error"}, {kInfo, "info"}},
            kinds{{kValidation, "validation"}, {kGeneral, "general"}};
        std::string text = fmt::format("{} {}: {} in {}: {}", severities[severity], kinds[types],
                                       orNone(data->messageId), orNone(data->functionName), data->message);
        for (std::uint32_t i = 0; i < data->sessionLabelCount; ++i) {
            text += fmt::format(", in {}", data->sessionLabels[i].labelName);
        }
        for (std::uint32_t i = 0; i < data->objectCount; ++i) {
            text += fmt::format(", of {}", orNone(data->objects[i].objectName));
        }
        static_cast<std::vector<std::string>*>(messages)->push_back(text);
        return XR_FALSE;
    }
};

struct MessageFixture : HeadlessSession {
    Heard heard;
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;
    PFN_xrSubmitDebugUtilsMessageEXT submit = XR(xrSubmitDebugUtilsMessageEXT);
    PFN_xrSetDebugUtilsObjectNameEXT setName = XR(xrSetDebugUtilsObjectNameEXT);
    XrDebugUtilsObjectNameInfoEXT object{XR_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr,
                                         XR_OBJECT_TYPE_SESSION, reinterpret_cast<std::uint64_t>(session),
                                         "the session"};

    MessageFixture() : HeadlessSession(k1_0, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME}) {
        REQUIRE(create() == XR_SUCCESS);
    }
    XrResult create() { return XR(xrCreateDebugUtilsMessengerEXT)(instance, &heard.info, &messenger); }
    void beMistaken() const {
        XrPath path = XR_NULL_PATH;
        CHECK(XR(xrStringToPath)(instance, "no slash", &path) == XR_ERROR_PATH_FORMAT_INVALID);
    }
    std::string takeReason() {
        const std::string message = heard.take();
        return message.substr(message.find(": ", message.find(" in xr")) + 2);
    }
};

XrDebugUtilsLabelEXT label(const char* name) { return {XR_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name}; }
XrDebugUtilsMessengerCallbackDataEXT hello(const char* function,
                                           std::span<XrDebugUtilsObjectNameInfoEXT> objects,
                                           std::span<XrDebugUtilsLabelEXT> labels) {
    XrDebugUtilsMessengerCallbackDataEXT data{XR_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT};
    data.functionName = function;
    data.message = "hello";
    data.objectCount = static_cast<std::uint32_t>(objects.size());
    data.objects = objects.data();
    data.sessionLabelCount = static_cast<std::uint32_t>(labels.size());
    data.sessionLabels = labels.data();
    return data;
}

TEST_CASE_FIXTURE(MessageFixture, "the application's function is told of refusals, if it asked for them") {
    beMistaken();
    CHECK(heard.take() == kMistake);
    // The loader's own queries are not mistakes.
    CHECK_FALSE(has("xrMakeCoffee"));
    CHECK(heard.messages.empty());
    CHECK(XR(xrDestroyDebugUtilsMessengerEXT)(messenger) == XR_SUCCESS);
    beMistaken();
    CHECK(heard.messages.empty());
    CHECK(XR(xrDestroyDebugUtilsMessengerEXT)(messenger) == XR_ERROR_HANDLE_INVALID);

    XrDebugUtilsMessengerCreateInfoEXT& info = heard.info;
    const auto make = [&] { return create(); };
    checkChanges(make, XR_SUCCESS,
                 to(info.messageSeverities, XR_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT),
                 to(info.messageTypes, XR_DEBUG_UTILS_MESSAGE_TYPE_CONFORMANCE_BIT_EXT));
    beMistaken();
    CHECK(heard.messages.empty());
    checkChanges(make, XR_ERROR_VALIDATION_FAILURE, to(info.messageSeverities, 0),
                 to(info.messageSeverities, 2), to(info.messageTypes, 0), to(info.messageTypes, 1 << 9),
                 to(info.userCallback, nullptr));
    checkArguments(XR(xrCreateDebugUtilsMessengerEXT), instance, &info, &messenger);
}

TEST_CASE_FIXTURE(MessageFixture, "the reason of a refusal names what was refused") {
    const std::string trigger = "/user/hand/left/input/trigger/", profiles = "/interaction_profiles/";
    for (const auto& [profile, binding, expected] :
         {std::tuple("khr/simple_controller", "value",
                     " has no /user/hand/left/input/trigger/value, suggested for the action action"),
          {"oculus/touch_controller", "proximity",
           " has no /user/hand/left/input/trigger/proximity without XR_VERSION_1_1, suggested for the action "
           "action"},
          {"meta/touch_plus_controller", "value", " needs XR_VERSION_1_1"},
          {"nobody/nothing", "value", " is not an interaction profile"}}) {
        CHECK(suggest(profiles + profile, trigger + binding) == XR_ERROR_PATH_UNSUPPORTED);
        CHECK(takeReason() == profiles + profile + expected);
    }
    std::uint32_t count = 0;
    char text[4];
    CHECK(XR(xrPathToString)(instance, path("/user/head"), 4, &count, text) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(takeReason() == "the array has room for 4, must have for 11");
    CHECK(XR(xrPathToString)(instance, 4711, 4, &count, text) == XR_ERROR_PATH_INVALID);
    CHECK(takeReason() == "the number 4711 is not a path");
    XrSpace space = XR_NULL_HANDLE;
    XrReferenceSpaceCreateInfo info{
        XR_TYPE_ACTION_CREATE_INFO, nullptr, XR_REFERENCE_SPACE_TYPE_LOCAL, {{0, 0, 0, 2}, {0, 0, 0}}};
    const auto make = XR(xrCreateReferenceSpace);
    CHECK(make(session, &info, &space) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(takeReason() ==
          "a structure is of type XR_TYPE_ACTION_CREATE_INFO, must be XR_TYPE_REFERENCE_SPACE_CREATE_INFO");
    info.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    CHECK(make(session, &info, &space) == XR_ERROR_POSE_INVALID);
    CHECK(takeReason() == "the quaternion 0 0 0 2 is not of length 1");
    CHECK(make(reinterpret_cast<XrSession>(0x1234), &info, &space) == XR_ERROR_HANDLE_INVALID);
    CHECK(takeReason() == "0x1234 is not an XrSession that exists");
}

TEST_CASE_FIXTURE(MessageFixture, "applications submit messages, with session's labels and objects' names") {
    const auto begin_region = XR(xrSessionBeginDebugUtilsLabelRegionEXT);
    const auto end_region = XR(xrSessionEndDebugUtilsLabelRegionEXT);
    const auto insert = XR(xrSessionInsertDebugUtilsLabelEXT);
    const auto frame = label("frame"), eye = label("left eye"), here = label("here"),
               nameless = label(nullptr);
    checkEach(XR_SUCCESS, {begin_region(session, &frame), begin_region(session, &eye), insert(session, &here),
                           setName(instance, &object)});
    object.objectName = nullptr;
    auto data = hello("main", {&object, 1}, {});
    CHECK(submit(instance, kInfo, kGeneral, &data) == XR_SUCCESS);
    CHECK(heard.take() ==
          "info general: none in main: hello, in here, in left eye, in frame, of the session");
    checkEach(XR_SUCCESS,
              {setName(instance, &object), end_region(session), submit(instance, kInfo, kGeneral, &data)});
    CHECK(heard.take() == "info general: none in main: hello, in frame, of none");
    CHECK(submit(instance, XR_DEBUG_UTILS_MESSAGE_SEVERITY_VERBOSE_BIT_EXT, kGeneral, &data) == XR_SUCCESS);
    CHECK(heard.messages.empty());

    CHECK(submit(instance, 0, kGeneral, &data) == XR_ERROR_VALIDATION_FAILURE);
    data.message = nullptr;
    CHECK(submit(instance, kInfo, kGeneral, &data) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(submit(XR_NULL_HANDLE, kInfo, kGeneral, &data) == XR_ERROR_HANDLE_INVALID);
    object.objectHandle = 0;
    checkEach(XR_ERROR_VALIDATION_FAILURE,
              {setName(instance, &object), begin_region(session, nullptr), insert(session, &nameless)});
    checkEach(XR_ERROR_HANDLE_INVALID, {begin_region(XR_NULL_HANDLE, &frame), end_region(XR_NULL_HANDLE)});
}

TEST_CASE_FIXTURE(MessageFixture, "messages are passed on as they are, but objects go by their given names") {
    const auto region = label("the session's own");
    checkEach(XR_SUCCESS,
              {XR(xrSessionBeginDebugUtilsLabelRegionEXT)(session, &region), setName(instance, &object)});
    XrDebugUtilsLabelEXT labels[]{label("inner"), label("outer")};
    XrDebugUtilsObjectNameInfoEXT objects[3] = {object, object, object};
    objects[0].objectName = "passed";
    objects[1].objectName = nullptr;
    objects[2].objectHandle = 77;
    objects[2].objectName = "never registered";
    auto data = hello(nullptr, objects, labels);
    const auto send = [&] { return submit(instance, kInfo, kGeneral, &data); };
    const std::string rest =
        ": hello, in inner, in outer, of the session, of the session, of never registered";
    CHECK(send() == XR_SUCCESS);
    CHECK(heard.take() == "info general: none in none" + rest);
    data.messageId = "an id";
    data.functionName = "";
    CHECK(send() == XR_SUCCESS);
    CHECK(heard.take() == "info general: an id in " + rest);
    checkChanges(send, XR_ERROR_VALIDATION_FAILURE, to(labels[1].labelName, nullptr),
                 to(data.sessionLabels, nullptr));
}

TEST_CASE("a messenger in the chain hears why the instance was refused; others hear through the loader") {
    Heard heard;
    {
        const Headset headset(kQuietScript);
        const Direct runtime;
        const Extensions foreign{XR_EXT_DEBUG_UTILS_EXTENSION_NAME, "XR_KHR_opengl_enable"},
            unknown{"XR_KHR_nothing"};
        XrInstanceCreateInfo info = instanceInfo(foreign);
        info.next = &heard.info;
        CHECK(tryInstance(info, runtime.get) == XR_ERROR_EXTENSION_NOT_PRESENT);
        CHECK(heard.take() ==
              "error validation: XR_ERROR_EXTENSION_NOT_PRESENT in xrCreateInstance: XR_KHR_opengl_enable: "
              "this runtime has Vulkan alone, XR_KHR_vulkan_enable2 or XR_KHR_vulkan_enable");
        // Without the extension, there is nobody to receive messages.
        info = instanceInfo(unknown);
        info.next = &heard.info;
        CHECK(tryInstance(info, runtime.get) == XR_ERROR_EXTENSION_NOT_PRESENT);
        CHECK(heard.messages.empty());
    }
    const InstanceFixture made(kQuietScript, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME});
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;
    REQUIRE(made.XR(xrCreateDebugUtilsMessengerEXT)(made.instance, &heard.info, &messenger) == XR_SUCCESS);
    XrPath path = XR_NULL_PATH;
    CHECK(xrStringToPath(made.instance, "no slash", &path) == XR_ERROR_PATH_FORMAT_INVALID);
    CHECK(heard.take() == kMistake);
    CHECK(made.XR(xrDestroyDebugUtilsMessengerEXT)(messenger) == XR_SUCCESS);
}

}  // SUITE(simulated_messages)
