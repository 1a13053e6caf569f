// Chapters 4 to 6 of OpenXR on the simulated runtime: the library, instances, systems, view configurations,
// paths and names of values.
#include "tests/xr/simulated/api/simulated_direct.h"

#include <unistd.h>

SUITE(simulated_instance) {

// What appears on standard error when explanations are on.
template <class Body>
std::string explainedBy(Body&& body) {
    std::FILE* const said = std::tmpfile();
    REQUIRE(said != nullptr);
    std::fflush(stderr);
    const int before = dup(STDERR_FILENO);
    dup2(fileno(said), STDERR_FILENO);
    setenv("SIMULATED_OPENXR_EXPLAIN", "1", 1);
    body();
    unsetenv("SIMULATED_OPENXR_EXPLAIN");
    std::fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    std::string text;
    std::rewind(said);
    for (int c = std::fgetc(said); c != EOF; c = std::fgetc(said)) { text += static_cast<char>(c); }
    std::fclose(said);
    return text;
}

XrResult tryScript(const std::string& script, const Extensions& extensions = {}) {
    const Headset headset(script);
    return tryInstance(instanceInfo(extensions));
}

TEST_CASE("the library shows one function, which negotiates an interface and a version with its loader") {
    const Direct runtime;
    // What is found belongs to another library, on which this one depends.
    for (const char* name : {"xrCreateInstance", "xrGetInstanceProcAddr", "vkCreateInstance"}) {
        Dl_info owner{};
        void* const found = dlsym(runtime.library, name);
        CHECK((found == nullptr ||
               (dladdr(found, &owner) != 0 && std::strstr(owner.dli_fname, "binosplat") == nullptr)));
    }
    LoaderInfo info;
    RuntimeRequest request;
    const auto negotiate = [&] { return runtime.negotiate(&info, &request); };
    const auto negotiateOther = [&] { return with(info.most_interface, 2, negotiate); };
    CHECK(with(info.least_interface, 2, negotiateOther) == XR_ERROR_INITIALIZATION_FAILED);
    checkChanges(negotiate, XR_ERROR_INITIALIZATION_FAILED, to(info.type, 2), to(info.version, 2),
                 to(info.size, 8), to(info.least_api, XR_MAKE_VERSION(2, 0, 0)), to(request.type, 1),
                 to(request.size, 8));
    CHECK(runtime.negotiate(nullptr, nullptr) == XR_ERROR_INITIALIZATION_FAILED);
    CHECK(these(XR_VERSION_MAJOR(runtime.api), XR_VERSION_MINOR(runtime.api)) == these(1u, 1u));
    CHECK(with(info.most_api, XR_MAKE_VERSION(1, 0, 0xFFF), negotiate) == XR_SUCCESS);
    CHECK(XR_VERSION_MINOR(request.api) == 0);
    // The loader itself answers for layers; a loader that asks the runtime gets none.
    PFN_xrVoidFunction found = nullptr;
    REQUIRE(runtime.get(XR_NULL_HANDLE, "xrEnumerateApiLayerProperties", &found) == XR_SUCCESS);
    const auto listLayers = reinterpret_cast<PFN_xrEnumerateApiLayerProperties>(found);
    std::uint32_t count = 9;
    CHECK(listLayers(0, &count, nullptr) == XR_SUCCESS);
    CHECK(count == 0);
    CHECK(listLayers(0, nullptr, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    // A loader that names layers, whatever they are called, has them.
    const Headset headset(kQuietScript);
    const char* const name = "XR_APILAYER_nobody_nothing";
    XrInstanceCreateInfo instance_info = instanceInfo({});
    instance_info.enabledApiLayerCount = 1;
    instance_info.enabledApiLayerNames = &name;
    CHECK(tryInstance(instance_info, runtime.get) == XR_SUCCESS);
}

TEST_CASE(
    "extensions are listed, and enabled alone, and all, with a session that draws and one that does not") {
    Extensions all;
    const auto list = [](auto... step) {
        const Headset headset(kQuietScript);
        return xrEnumerateInstanceExtensionProperties(nullptr, step...);
    };
    const auto properties = checkList<XrExtensionProperties>(list, {XR_TYPE_EXTENSION_PROPERTIES});
    for (const XrExtensionProperties& property : properties) {
        CHECK_MESSAGE(tryScript(kQuietScript, {property.extensionName}) == XR_SUCCESS,
                      std::string(property.extensionName));
        all.push_back(property.extensionName);
    }
    CHECK(tryScript("extension XR_KHR_visibility_mask off\n", {XR_KHR_VISIBILITY_MASK_EXTENSION_NAME}) ==
          XR_ERROR_EXTENSION_NOT_PRESENT);
    // The fixture itself enables three of them, so they stand there twice.
    const SessionFixture made(kQuietScript, all);
    made.focus();
    made.turn(made.makeSwapchain());
    CHECK(xrDestroySession(made.session) == XR_SUCCESS);
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, nullptr, 0, made.system};
    XrSession headless = XR_NULL_HANDLE;
    CHECK(xrCreateSession(made.instance, &info, &headless) == XR_SUCCESS);
}

TEST_CASE("instances are of 1.0 and 1.1, and refused for what their description lacks, or their script") {
    {
        const Headset headset(kQuietScript);
        const Direct runtime;
        XrInstanceCreateInfo info = instanceInfo({});
        XrApplicationInfo& application = info.applicationInfo;
        const auto make = [&] { return tryInstance(info, runtime.get); };
        checkChanges(make, XR_ERROR_VALIDATION_FAILURE, to(info.type, XR_TYPE_SYSTEM_GET_INFO),
                     to(info.createFlags, 1), to(application.engineName[0], '\xFF'));
        CHECK(with(application.applicationName[0], '\0', make) == XR_ERROR_NAME_INVALID);
        checkChanges(make, XR_ERROR_API_VERSION_UNSUPPORTED,
                     to(application.apiVersion, XR_MAKE_VERSION(1, 2, 0)), to(application.apiVersion, 0),
                     to(application.apiVersion, XR_MAKE_VERSION(2, 0, 0)),
                     to(application.apiVersion, XR_MAKE_VERSION(0, 9, 0)), to(application.apiVersion, 1));
        checkChanges(make, XR_SUCCESS, to(application.apiVersion, XR_MAKE_VERSION(1, 0, 34)),
                     to(application.apiVersion, k1_1),
                     to(application.apiVersion, XR_MAKE_VERSION(1, 1, 4711)));
        // Names without a terminator.
        std::ranges::fill(application.engineName, 'a');
        CHECK(make() == XR_ERROR_NAME_INVALID);
        info = instanceInfo({});
        std::ranges::fill(application.applicationName, 'a');
        CHECK(make() == XR_ERROR_NAME_INVALID);
    }
    CHECK(tryScript(kQuietScript, {"XR_KHR_nothing"}) == XR_ERROR_EXTENSION_NOT_PRESENT);
    CHECK(tryScript("profile khr/simple_controller\npress left squeeze 0 1\n") == XR_ERROR_RUNTIME_FAILURE);
}

TEST_CASE("the environment is read again for each instance") {
    const Headset headset("hed 0 position 0 0 0\n");
    const Direct runtime;
    CHECK(tryInstance(instanceInfo({}), runtime.get) == XR_ERROR_RUNTIME_FAILURE);
    std::ofstream(headset.folder / "other.script") << "plugged on\n";
    setenv("SIMULATED_OPENXR_SCRIPT", (headset.folder / "other.script").c_str(), 1);
    CHECK(tryInstance(instanceInfo({}), runtime.get) == XR_SUCCESS);
    setenv("SIMULATED_OPENXR_CLOCK", "sundial", 1);
    const std::string explained =
        explainedBy([&] { CHECK(tryInstance(instanceInfo({}), runtime.get) == XR_ERROR_RUNTIME_FAILURE); });
    CHECK(explained ==
          "simulated runtime: xrCreateInstance: SIMULATED_OPENXR_CLOCK is 'sundial', must be lockstep or "
          "real\n");
    for (const char* name : {"SIMULATED_OPENXR_SCRIPT", "SIMULATED_OPENXR_CLOCK"}) { unsetenv(name); }
}

TEST_CASE("refusals are explained, and counted where they come again, but not the loader's own questions") {
    const std::string refused = explainedBy([] {
        const Headset headset(kQuietScript);
        const Direct runtime;
        XrInstanceCreateInfo info = instanceInfo({});
        info.createFlags = 1;
        CHECK(tryInstance(info, runtime.get) == XR_ERROR_VALIDATION_FAILURE);
        PFN_xrVoidFunction found = nullptr;
        for (const char* name : {"xrWaitFrame", "xrEndFrame", "xrCreateHandTrackerEXT"}) {
            CHECK(runtime.get(XR_NULL_HANDLE, name, &found) == XR_ERROR_HANDLE_INVALID);
        }
    });
    CHECK(refused ==
          "simulated runtime: xrCreateInstance: XR_ERROR_VALIDATION_FAILURE: createFlags is 1, no flags are "
          "known\n");

    const std::string repeated = explainedBy([] {
        const DirectInstance made(k1_0, {});
        XrPath path = XR_NULL_PATH;
        const auto toPath = made.XR(xrStringToPath);
        for (int i = 0; i < 125; ++i) {
            CHECK(toPath(made.instance, "no slash", &path) == XR_ERROR_PATH_FORMAT_INVALID);
            if (i % 20 == 0) {
                CHECK(toPath(made.instance, "/a/../b", &path) == XR_ERROR_PATH_FORMAT_INVALID);
            }
        }
    });
    std::string expected;
    for (const auto& [path, times] : {std::pair("no slash", ""),
                                      {"/a/../b", ""},
                                      {"no slash", " (10 times so far)"},
                                      {"no slash", " (100 times so far)"},
                                      {"/a/../b", " (7 times in all)"},
                                      {"no slash", " (125 times in all)"}}) {
        expected += fmt::format(
            "simulated runtime: xrStringToPath: XR_ERROR_PATH_FORMAT_INVALID: '{}' is not "
            "a well-formed path{}\n",
            path, times);
    }
    CHECK(repeated == expected);
}

TEST_CASE("an instance empties the folder of an earlier run, one that is refused leaves it alone") {
    const Headset headset(kQuietScript);
    const std::filesystem::path log = headset.written / "frames.jsonl",
                                picture = headset.written / "frame_000003.png";
    std::filesystem::create_directories(headset.written);
    std::ofstream(picture) << "x";
    std::ofstream(log) << "{\"frame\":0,\"display_time_ns\":1,\"picture\":\"frame_000003.png\"}\n";
    const Direct runtime;
    const Extensions unknown{"XR_KHR_nothing"};
    CHECK(tryInstance(instanceInfo(unknown), runtime.get) == XR_ERROR_EXTENSION_NOT_PRESENT);
    CHECK(std::filesystem::exists(picture));
    CHECK(std::filesystem::file_size(log) > 0);
    CHECK(tryInstance(instanceInfo({}), runtime.get) == XR_SUCCESS);
    CHECK_FALSE(std::filesystem::exists(picture));
    CHECK(std::filesystem::file_size(log) == 0);
    std::ofstream(log) << "somebody else's";
    const std::string explained =
        explainedBy([&] { CHECK(tryInstance(instanceInfo({}), runtime.get) == XR_ERROR_RUNTIME_FAILURE); });
    CHECK(explained == "simulated runtime: xrCreateInstance: " + log.string() +
                           ": not what an earlier run left here, must be moved elsewhere\n");
    CHECK(textIn(log) == "somebody else's");
}

TEST_CASE("functions are found by name, those of extensions and of 1.1 where these are enabled") {
    for (const auto& [version, extensions, of_1_1, of_extension] :
         {std::tuple(k1_0, Extensions{}, false, false),
          {k1_0, {XR_KHR_LOCATE_SPACES_EXTENSION_NAME}, false, true},
          {k1_1, {}, true, false}}) {
        const DirectInstance made(version, extensions);
        CHECK(these(made.has("xrWaitFrame"), made.has("xrLocateSpaces"), made.has("xrLocateSpacesKHR")) ==
              these(true, of_1_1, of_extension));
        for (const char* name :
             {"xrCreateDebugUtilsMessengerEXT", "xrConvertTimespecTimeToTimeKHR", "xrCreateHandTrackerEXT",
              "xrGetDisplayRefreshRateFB", "xrSetInputDeviceActiveEXT", "xrGetVisibilityMaskKHR",
              "xrGetVulkanGraphicsDeviceKHR", "xrMakeCoffee"}) {
            auto found = reinterpret_cast<PFN_xrVoidFunction>(std::abort);
            CHECK_MESSAGE(made.get(made.instance, name, &found) == XR_ERROR_FUNCTION_UNSUPPORTED, name);
            CHECK((found == nullptr));
        }
    }
}

TEST_CASE_FIXTURE(InstanceFixture, "an instance says what it runs on, has events, and ends once") {
    XrInstanceProperties properties{XR_TYPE_INSTANCE_PROPERTIES};
    CHECK(xrGetInstanceProperties(instance, &properties) == XR_SUCCESS);
    CHECK(std::string(properties.runtimeName) == "Simulated OpenXR runtime");
    CHECK(properties.runtimeVersion > 0);
    checkArguments(xrGetInstanceProperties, instance, &properties);
    XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
    CHECK(xrPollEvent(instance, &event) == XR_EVENT_UNAVAILABLE);
    checkArguments(xrPollEvent, instance, &event);
    CHECK(xrDestroyInstance(instance) == XR_SUCCESS);
    checkEach(XR_ERROR_HANDLE_INVALID, {xrDestroyInstance(XR_NULL_HANDLE),
                                        xrDestroyInstance(std::exchange(instance, XR_NULL_HANDLE))});
}

TEST_CASE("values have names, also those of 1.1") {
    const DirectInstance made(k1_1, {});
    const auto nameOf = [&](auto toString, auto value) {
        char text[XR_MAX_RESULT_STRING_SIZE];
        CHECK(toString(made.instance, value, text) == XR_SUCCESS);
        return std::string(text);
    };
    for (const auto& [value, name] : {std::pair(int{XR_ERROR_LAYER_INVALID}, "XR_ERROR_LAYER_INVALID"),
                                      {-31415, "XR_UNKNOWN_FAILURE_-31415"},
                                      {31415, "XR_UNKNOWN_SUCCESS_31415"},
                                      {-1000710001, "XR_ERROR_EXTENSION_DEPENDENCY_NOT_ENABLED"},
                                      {-1000710000, "XR_ERROR_PERMISSION_INSUFFICIENT"}}) {
        CHECK(nameOf(made.XR(xrResultToString), static_cast<XrResult>(value)) == name);
    }
    CHECK(made.XR(xrResultToString)(made.instance, XR_SUCCESS, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    for (const auto& [value, name] :
         {std::pair(int{XR_TYPE_SWAPCHAIN_CREATE_INFO}, "XR_TYPE_SWAPCHAIN_CREATE_INFO"),
          {31415, "XR_UNKNOWN_STRUCTURE_TYPE_31415"},
          {1000471001, "XR_TYPE_SPACE_LOCATIONS"}}) {
        CHECK(nameOf(made.XR(xrStructureTypeToString), static_cast<XrStructureType>(value)) == name);
    }
}

TEST_CASE_FIXTURE(InstanceFixture,
                  "a system is one headset; a next chain may hold what is unknown, but ends") {
    XrSystemGetInfo info{XR_TYPE_SYSTEM_GET_INFO, nullptr, XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
    XrSystemId id = XR_NULL_SYSTEM_ID;
    const auto get = [&] { return xrGetSystem(instance, &info, &id); };
    checkChanges(get, XR_ERROR_FORM_FACTOR_UNSUPPORTED, to(info.formFactor, XR_FORM_FACTOR_HANDHELD_DISPLAY),
                 to(info.formFactor, static_cast<XrFormFactor>(77)));
    checkArguments(xrGetSystem, instance, &info, &id);
    XrBaseInStructure stranger{static_cast<XrStructureType>(987654321), nullptr};
    CHECK(with(info.next, &stranger, get) == XR_SUCCESS);
    stranger.next = &stranger;
    CHECK(with(info.next, &stranger, get) == XR_ERROR_VALIDATION_FAILURE);

    XrSystemProperties properties = systemProperties();
    CHECK(properties.systemId == system);
    CHECK(std::string(properties.systemName) == "Simulated headset");
    CHECK(properties.graphicsProperties.maxLayerCount >= XR_MIN_COMPOSITION_LAYERS_SUPPORTED);
    CHECK(properties.trackingProperties.positionTracking == XR_TRUE);
    checkEach(XR_ERROR_SYSTEM_INVALID, {xrGetSystemProperties(instance, XR_NULL_SYSTEM_ID, &properties),
                                        xrGetSystemProperties(instance, system + 1, &properties)});
}

TEST_CASE_FIXTURE(InstanceFixture, "views are two, of the script's size, and opaque") {
    std::uint32_t count = 0;
    CHECK(checkListOf(XrViewConfigurationType{}, xrEnumerateViewConfigurations, instance, system) ==
          std::vector{kStereo});
    CHECK(xrEnumerateViewConfigurations(instance, 0, 0, &count, nullptr) == XR_ERROR_SYSTEM_INVALID);
    XrViewConfigurationProperties properties{XR_TYPE_VIEW_CONFIGURATION_PROPERTIES};
    CHECK(xrGetViewConfigurationProperties(instance, system, kStereo, &properties) == XR_SUCCESS);
    CHECK(properties.fovMutable == XR_TRUE);
    const auto mono = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO;
    CHECK(xrGetViewConfigurationProperties(instance, system, mono, &properties) ==
          XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
    for (const auto none :
         {XR_VIEW_CONFIGURATION_TYPE_MAX_ENUM, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO,
          static_cast<XrViewConfigurationType>(0)}) {
        CHECK(xrGetViewConfigurationProperties(instance, system, none, &properties) ==
              XR_ERROR_VALIDATION_FAILURE);
    }

    const auto views = checkListOf(XrViewConfigurationView{XR_TYPE_VIEW_CONFIGURATION_VIEW},
                                   xrEnumerateViewConfigurationViews, instance, system, kStereo);
    REQUIRE(views.size() == 2);
    CHECK(views[1].recommendedImageRectWidth == 64);
    CHECK(xrEnumerateViewConfigurationViews(instance, system, mono, 0, &count, nullptr) ==
          XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);

    CHECK(checkListOf(XrEnvironmentBlendMode{}, xrEnumerateEnvironmentBlendModes, instance, system,
                      kStereo) == std::vector{XR_ENVIRONMENT_BLEND_MODE_OPAQUE});
    CHECK(xrEnumerateEnvironmentBlendModes(instance, 5, kStereo, 0, &count, nullptr) ==
          XR_ERROR_SYSTEM_INVALID);
    CHECK(xrEnumerateEnvironmentBlendModes(instance, system, mono, 0, &count, nullptr) ==
          XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
}

TEST_CASE_FIXTURE(InstanceFixture, "paths are the same for the same text, and back, and have a form") {
    CHECK(left != XR_NULL_PATH);
    CHECK(left == path("/user/hand/left"));
    CHECK(left != right);
    const auto text = checkListOf('\0', xrPathToString, instance, left);
    CHECK(text.size() == 16);
    CHECK(std::string(text.data()) == "/user/hand/left");
    std::uint32_t count = 0;
    for (const XrPath none : {XrPath{XR_NULL_PATH}, XrPath{123456}}) {
        CHECK(xrPathToString(instance, none, 0, &count, nullptr) == XR_ERROR_PATH_INVALID);
    }

    XrPath made = XR_NULL_PATH;
    const std::string longest = "/" + std::string(XR_MAX_PATH_LENGTH - 2, 'a'), longer = longest + "a";
    for (const char* good : {"/a", "/a/b.c-d_e/9", "/.a/..b", longest.c_str()}) {
        CHECK_MESSAGE(xrStringToPath(instance, good, &made) == XR_SUCCESS, good);
    }
    for (const char* bad : {"", "/", "a", "a/b", "/a/", "//a", "/a//b", "/A", "/a b", "/a/.", "/..",
                            "/a/.../b", "/\xC3\xA4", "/a\n", longer.c_str()}) {
        CHECK_MESSAGE(xrStringToPath(instance, bad, &made) == XR_ERROR_PATH_FORMAT_INVALID, bad);
    }
    checkEach(XR_ERROR_VALIDATION_FAILURE,
              {xrStringToPath(instance, nullptr, &made), xrStringToPath(instance, "/a", nullptr)});
}

}  // SUITE(simulated_instance)
