// Chapters 4 to 6 of OpenXR on the simulated runtime: instances, systems, view configurations, paths, names of values.
#include "tests/xr/simulated/api/simulated_fixture.h"

TEST_SUITE_BEGIN("simulated_instance");

namespace simulated_instance_test {

using namespace binosplat::test;

namespace {

std::vector<XrExtensionProperties> extensionsThere() {
    std::uint32_t count = 0;
    REQUIRE(xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr) == XR_SUCCESS);
    std::vector<XrExtensionProperties> properties(count, {XR_TYPE_EXTENSION_PROPERTIES});
    REQUIRE(xrEnumerateInstanceExtensionProperties(nullptr, count, &count, properties.data()) == XR_SUCCESS);
    return properties;
}

}  // namespace

TEST_CASE("extensions are enumerated in two calls, and none of a layer") {
    const Headset headset(kQuietScript);
    std::uint32_t count = 0;
    CHECK(xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr) == XR_SUCCESS);
    REQUIRE(count >= 4);
    std::vector<XrExtensionProperties> properties(count, {XR_TYPE_EXTENSION_PROPERTIES});
    CHECK(xrEnumerateInstanceExtensionProperties(nullptr, count, &count, properties.data()) == XR_SUCCESS);
    const auto has = [&](const char* name) {
        for (const auto& property : properties) {
            if (std::strcmp(property.extensionName, name) == 0) return true;
        }
        return false;
    };
    CHECK(has(XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME));
    CHECK(has(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME));
    CHECK(has(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME));
    CHECK(xrEnumerateInstanceExtensionProperties(nullptr, 1, &count, properties.data()) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(xrEnumerateInstanceExtensionProperties(nullptr, 0, nullptr, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrEnumerateInstanceExtensionProperties("XR_APILAYER_nobody_nothing", 0, &count, nullptr) == XR_ERROR_API_LAYER_NOT_PRESENT);
}

TEST_CASE("every extension is enabled alone, and all are together, some twice, with a session that draws and one that does not") {
    std::vector<XrExtensionProperties> properties;
    {
        const Headset headset(kQuietScript);
        properties = extensionsThere();
        for (const XrExtensionProperties& property : properties) {
            const std::vector<const char*> alone{property.extensionName};
            const XrInstanceCreateInfo info = instanceInfo(alone);
            XrInstance instance = XR_NULL_HANDLE;
            CHECK_MESSAGE(xrCreateInstance(&info, &instance) == XR_SUCCESS, std::string(property.extensionName));
            CHECK(xrDestroyInstance(instance) == XR_SUCCESS);
        }
    }
    std::vector<const char*> all;
    for (const XrExtensionProperties& property : properties) all.push_back(property.extensionName);
    // The fixture enables three of them by itself.
    const SessionFixture made(kQuietScript, all);
    made.focus();
    made.turn(made.makeSwapchain());
    CHECK(xrDestroySession(made.session) == XR_SUCCESS);
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, nullptr, 0, made.system};
    XrSession headless = XR_NULL_HANDLE;
    CHECK(xrCreateSession(made.instance, &info, &headless) == XR_SUCCESS);
}

TEST_CASE("an extension that the script takes away is neither listed nor enabled") {
    const Headset headset("extension XR_KHR_visibility_mask off\n");
    const std::vector<const char*> wanted{XR_KHR_VISIBILITY_MASK_EXTENSION_NAME};
    const XrInstanceCreateInfo info = instanceInfo(wanted);
    XrInstance instance = XR_NULL_HANDLE;
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_EXTENSION_NOT_PRESENT);
}

TEST_CASE("an instance is refused for what its description lacks") {
    const Headset headset(kQuietScript);
    XrInstance instance = XR_NULL_HANDLE;
    XrInstanceCreateInfo info = instanceInfo({});
    CHECK(xrCreateInstance(nullptr, &instance) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrCreateInstance(&info, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    info.type = XR_TYPE_SYSTEM_GET_INFO;
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_VALIDATION_FAILURE);
    info = instanceInfo({});
    info.createFlags = 1;
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_VALIDATION_FAILURE);
    info = instanceInfo({});
    info.applicationInfo.applicationName[0] = '\0';
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_NAME_INVALID);
    info = instanceInfo({});
    std::strcpy(info.applicationInfo.engineName, "\xFF\xFE");
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_VALIDATION_FAILURE);
    info = instanceInfo({});
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 2, 0);
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_API_VERSION_UNSUPPORTED);
    info.applicationInfo.apiVersion = 0;
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_API_VERSION_UNSUPPORTED);
    const std::vector<const char*> unknown{"XR_KHR_nothing"};
    info = instanceInfo(unknown);
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_EXTENSION_NOT_PRESENT);
}

TEST_CASE("layers are the loader's business") {
    const Headset headset(kQuietScript);
    XrInstance instance = XR_NULL_HANDLE;
    // The loader wants the layer to be there, so it is one that there is: the loader hands its name on.
    std::uint32_t count = 0;
    REQUIRE(xrEnumerateApiLayerProperties(0, &count, nullptr) == XR_SUCCESS);
    std::vector<XrApiLayerProperties> layers(count, {XR_TYPE_API_LAYER_PROPERTIES});
    REQUIRE(xrEnumerateApiLayerProperties(count, &count, layers.data()) == XR_SUCCESS);
    for (const XrApiLayerProperties& layer : layers) {
        const char* const name = layer.layerName;
        XrInstanceCreateInfo info = instanceInfo({});
        info.enabledApiLayerCount = 1;
        info.enabledApiLayerNames = &name;
        CHECK(xrCreateInstance(&info, &instance) == XR_SUCCESS);
        CHECK(xrDestroyInstance(instance) == XR_SUCCESS);
    }
}

TEST_CASE("a script whose controllers lack what it presses is a failure of the runtime") {
    const Headset headset("profile khr/simple_controller\npress left squeeze 0 1\n");
    const XrInstanceCreateInfo info = instanceInfo({});
    XrInstance instance = XR_NULL_HANDLE;
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_RUNTIME_FAILURE);
}

TEST_CASE("a broken script is a failure of the runtime") {
    const Headset headset("hed 0 position 0 0 0\n");
    const XrInstanceCreateInfo info = instanceInfo({});
    XrInstance instance = XR_NULL_HANDLE;
    CHECK(xrCreateInstance(&info, &instance) == XR_ERROR_RUNTIME_FAILURE);
}

TEST_CASE_FIXTURE(InstanceFixture, "an instance says what it runs on, and ends once") {
    XrInstanceProperties properties{XR_TYPE_INSTANCE_PROPERTIES};
    CHECK(xrGetInstanceProperties(instance, &properties) == XR_SUCCESS);
    CHECK(std::string(properties.runtimeName) == "Simulated OpenXR runtime");
    CHECK(properties.runtimeVersion > 0);
    properties.type = XR_TYPE_SYSTEM_PROPERTIES;
    CHECK(xrGetInstanceProperties(instance, &properties) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrGetInstanceProperties(instance, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrDestroyInstance(XR_NULL_HANDLE) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrDestroyInstance(instance) == XR_SUCCESS);
    CHECK(xrDestroyInstance(instance) == XR_ERROR_HANDLE_INVALID);
    instance = XR_NULL_HANDLE;
}

TEST_CASE_FIXTURE(InstanceFixture, "functions are found by name, those of extensions only where they are enabled") {
    PFN_xrVoidFunction found = nullptr;
    CHECK(xrGetInstanceProcAddr(instance, "xrWaitFrame", &found) == XR_SUCCESS);
    CHECK((found != nullptr));
    CHECK(xrGetInstanceProcAddr(instance, "xrGetVisibilityMaskKHR", &found) == XR_SUCCESS);
    CHECK(xrGetInstanceProcAddr(instance, "xrGetVulkanGraphicsDeviceKHR", &found) == XR_ERROR_FUNCTION_UNSUPPORTED);
    CHECK((found == nullptr));
    CHECK(xrGetInstanceProcAddr(instance, "xrMakeCoffee", &found) == XR_ERROR_FUNCTION_UNSUPPORTED);
    CHECK(xrGetInstanceProcAddr(XR_NULL_HANDLE, "xrCreateSession", &found) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrGetInstanceProcAddr(XR_NULL_HANDLE, "xrCreateInstance", &found) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(InstanceFixture, "values have names") {
    char result[XR_MAX_RESULT_STRING_SIZE], type[XR_MAX_STRUCTURE_NAME_SIZE];
    CHECK(xrResultToString(instance, XR_ERROR_LAYER_INVALID, result) == XR_SUCCESS);
    CHECK(std::string(result) == "XR_ERROR_LAYER_INVALID");
    CHECK(xrResultToString(instance, static_cast<XrResult>(-31415), result) == XR_SUCCESS);
    CHECK(std::string(result) == "XR_UNKNOWN_FAILURE_-31415");
    CHECK(xrResultToString(instance, static_cast<XrResult>(31415), result) == XR_SUCCESS);
    CHECK(std::string(result) == "XR_UNKNOWN_SUCCESS_31415");
    CHECK(xrStructureTypeToString(instance, XR_TYPE_SWAPCHAIN_CREATE_INFO, type) == XR_SUCCESS);
    CHECK(std::string(type) == "XR_TYPE_SWAPCHAIN_CREATE_INFO");
    CHECK(xrStructureTypeToString(instance, static_cast<XrStructureType>(31415), type) == XR_SUCCESS);
    CHECK(std::string(type) == "XR_UNKNOWN_STRUCTURE_TYPE_31415");
    CHECK(xrResultToString(instance, XR_SUCCESS, nullptr) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(InstanceFixture, "events are polled into a buffer of the right type") {
    XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
    CHECK(xrPollEvent(instance, &event) == XR_EVENT_UNAVAILABLE);
    event.type = XR_TYPE_EVENT_DATA_EVENTS_LOST;
    CHECK(xrPollEvent(instance, &event) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrPollEvent(instance, nullptr) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(InstanceFixture, "a system is one head-mounted display") {
    XrSystemGetInfo get{XR_TYPE_SYSTEM_GET_INFO, nullptr, XR_FORM_FACTOR_HANDHELD_DISPLAY};
    XrSystemId id = XR_NULL_SYSTEM_ID;
    CHECK(xrGetSystem(instance, &get, &id) == XR_ERROR_FORM_FACTOR_UNSUPPORTED);
    get.formFactor = static_cast<XrFormFactor>(77);
    CHECK(xrGetSystem(instance, &get, &id) == XR_ERROR_FORM_FACTOR_UNSUPPORTED);
    get.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    CHECK(xrGetSystem(instance, &get, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    get.type = XR_TYPE_UNKNOWN;
    CHECK(xrGetSystem(instance, &get, &id) == XR_ERROR_VALIDATION_FAILURE);

    XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES};
    CHECK(xrGetSystemProperties(instance, system, &properties) == XR_SUCCESS);
    CHECK(properties.systemId == system);
    CHECK(properties.graphicsProperties.maxLayerCount >= XR_MIN_COMPOSITION_LAYERS_SUPPORTED);
    CHECK(properties.trackingProperties.positionTracking == XR_TRUE);
    CHECK(xrGetSystemProperties(instance, XR_NULL_SYSTEM_ID, &properties) == XR_ERROR_SYSTEM_INVALID);
    CHECK(xrGetSystemProperties(instance, system + 1, &properties) == XR_ERROR_SYSTEM_INVALID);
}

TEST_CASE_FIXTURE(InstanceFixture, "a next chain may hold what the runtime does not know, but it must end") {
    XrBaseInStructure stranger{static_cast<XrStructureType>(987654321), nullptr};
    XrSystemGetInfo get{XR_TYPE_SYSTEM_GET_INFO, &stranger, XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
    XrSystemId id = XR_NULL_SYSTEM_ID;
    CHECK(xrGetSystem(instance, &get, &id) == XR_SUCCESS);
    stranger.next = &stranger;
    CHECK(xrGetSystem(instance, &get, &id) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(InstanceFixture, "views are two, of the script's size") {
    std::uint32_t count = 0;
    XrViewConfigurationType type{};
    CHECK(xrEnumerateViewConfigurations(instance, system, 1, &count, &type) == XR_SUCCESS);
    CHECK(count == 1);
    CHECK(type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO);
    CHECK(xrEnumerateViewConfigurations(instance, 0, 0, &count, nullptr) == XR_ERROR_SYSTEM_INVALID);
    CHECK(xrEnumerateViewConfigurations(instance, system, 1, &count, nullptr) == XR_ERROR_VALIDATION_FAILURE);

    XrViewConfigurationProperties properties{XR_TYPE_VIEW_CONFIGURATION_PROPERTIES};
    CHECK(xrGetViewConfigurationProperties(instance, system, type, &properties) == XR_SUCCESS);
    CHECK(properties.fovMutable == XR_TRUE);
    const auto mono = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO;
    CHECK(xrGetViewConfigurationProperties(instance, system, mono, &properties) == XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
    for (const auto none :
         {XR_VIEW_CONFIGURATION_TYPE_MAX_ENUM, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO, static_cast<XrViewConfigurationType>(0)}) {
        CHECK(xrGetViewConfigurationProperties(instance, system, none, &properties) == XR_ERROR_VALIDATION_FAILURE);
    }

    XrViewConfigurationView views[2] = {{XR_TYPE_VIEW_CONFIGURATION_VIEW}, {XR_TYPE_VIEW_CONFIGURATION_VIEW}};
    CHECK(xrEnumerateViewConfigurationViews(instance, system, type, 2, &count, views) == XR_SUCCESS);
    CHECK(count == 2);
    CHECK(views[1].recommendedImageRectWidth == 64);
    CHECK(xrEnumerateViewConfigurationViews(instance, system, type, 1, &count, views) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(count == 2);
    views[1].type = XR_TYPE_VIEW;
    CHECK(xrEnumerateViewConfigurationViews(instance, system, type, 2, &count, views) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrEnumerateViewConfigurationViews(instance, system, mono, 0, &count, nullptr) == XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
}

TEST_CASE_FIXTURE(InstanceFixture, "the blend mode is opaque") {
    std::uint32_t count = 0;
    XrEnvironmentBlendMode mode{};
    const auto stereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    CHECK(xrEnumerateEnvironmentBlendModes(instance, system, stereo, 1, &count, &mode) == XR_SUCCESS);
    CHECK(mode == XR_ENVIRONMENT_BLEND_MODE_OPAQUE);
    CHECK(xrEnumerateEnvironmentBlendModes(instance, 5, stereo, 1, &count, &mode) == XR_ERROR_SYSTEM_INVALID);
    CHECK(xrEnumerateEnvironmentBlendModes(instance, system, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO, 1, &count, &mode) ==
          XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
}

TEST_CASE_FIXTURE(InstanceFixture, "paths are the same for the same text, and back") {
    const XrPath hand = path("/user/hand/left");
    CHECK(hand != XR_NULL_PATH);
    CHECK(hand == path("/user/hand/left"));
    CHECK(hand != path("/user/hand/right"));
    char text[XR_MAX_PATH_LENGTH];
    std::uint32_t count = 0;
    CHECK(xrPathToString(instance, hand, 0, &count, nullptr) == XR_SUCCESS);
    CHECK(count == 16);
    CHECK(xrPathToString(instance, hand, count, &count, text) == XR_SUCCESS);
    CHECK(std::string(text) == "/user/hand/left");
    CHECK(xrPathToString(instance, hand, count - 1, &count, text) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(xrPathToString(instance, hand, count, nullptr, text) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrPathToString(instance, hand, count, &count, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrPathToString(instance, XR_NULL_PATH, 0, &count, nullptr) == XR_ERROR_PATH_INVALID);
    CHECK(xrPathToString(instance, 123456, 0, &count, nullptr) == XR_ERROR_PATH_INVALID);
}

TEST_CASE_FIXTURE(InstanceFixture, "a path has a form") {
    XrPath made = XR_NULL_PATH;
    for (const char* good : {"/a", "/a/b.c-d_e/9", "/.a/..b"}) CHECK_MESSAGE(xrStringToPath(instance, good, &made) == XR_SUCCESS, good);
    for (const char* bad : {"", "/", "a", "a/b", "/a/", "//a", "/a//b", "/A", "/a b", "/a/.", "/..", "/a/.../b", "/\xC3\xA4", "/a\n"}) {
        CHECK_MESSAGE(xrStringToPath(instance, bad, &made) == XR_ERROR_PATH_FORMAT_INVALID, bad);
    }
    const std::string longest = "/" + std::string(XR_MAX_PATH_LENGTH - 2, 'a');
    CHECK(xrStringToPath(instance, longest.c_str(), &made) == XR_SUCCESS);
    CHECK(xrStringToPath(instance, (longest + "a").c_str(), &made) == XR_ERROR_PATH_FORMAT_INVALID);
    CHECK(xrStringToPath(instance, nullptr, &made) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrStringToPath(instance, "/a", nullptr) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE("messages of refused calls come through the loader") {
    struct Listening : InstanceFixture {
        Listening() : InstanceFixture(kQuietScript, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME}) {}
    };
    const Listening fixture;
    std::vector<std::string> heard;
    const XrDebugUtilsMessengerCreateInfoEXT info{
        XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        nullptr,
        XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        [](XrDebugUtilsMessageSeverityFlagsEXT, XrDebugUtilsMessageTypeFlagsEXT, const XrDebugUtilsMessengerCallbackDataEXT* data,
           void* list) -> XrBool32 {
            static_cast<std::vector<std::string>*>(list)->push_back(std::string(data->functionName) + ": " + data->message);
            return XR_FALSE;
        },
        &heard};
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;
    const auto create = fixture.function<PFN_xrCreateDebugUtilsMessengerEXT>("xrCreateDebugUtilsMessengerEXT");
    REQUIRE(create(fixture.instance, &info, &messenger) == XR_SUCCESS);
    XrPath path = XR_NULL_PATH;
    CHECK(xrStringToPath(fixture.instance, "no slash", &path) == XR_ERROR_PATH_FORMAT_INVALID);
    CHECK(heard == std::vector<std::string>{"xrStringToPath: 'no slash' is not a well-formed path"});
    CHECK(fixture.function<PFN_xrDestroyDebugUtilsMessengerEXT>("xrDestroyDebugUtilsMessengerEXT")(messenger) == XR_SUCCESS);
}

}  // namespace simulated_instance_test
