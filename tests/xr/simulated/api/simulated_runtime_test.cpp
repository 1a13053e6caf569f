// The simulated runtime as a library that strangers load: what it shows, how it negotiates, and programs that were not written for it.
#include "tests/xr/simulated/api/simulated_direct.h"
#include "tests/xr/simulated/api/simulated_fixture.h"
#include "tests/xr/simulated/installed.h"

#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

TEST_SUITE_BEGIN("simulated_runtime");

namespace simulated_runtime_test {

using namespace binosplat::test;

namespace {

struct Run {
    int exit_code = -1;
    std::string output;
};

// Standard input is a pipe that nobody writes to: hello_xr ends at the first key.
Run run(const Headset& headset, const std::string& command, const std::string& environment = "") {
    const std::string log = (headset.folder / "log").string(), keys = (headset.folder / "keys").string();
    const std::string line = "rm -f " + keys + " && mkfifo " + keys + " && " BINOSPLAT_STRANGERS_ENVIRONMENT + environment +
                             " timeout 100 " + command + " 0<>" + keys + " > " + log + " 2>&1";
    const int status = std::system(line.c_str());
    std::ifstream stream(log);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, {std::istreambuf_iterator<char>(stream), {}}};
}

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

void checkSilent(const std::string& output) {
    for (const char* complaint : {"VUID-", "SYNC-HAZARD", "UNASSIGNED-", "Validation Error", "Validation Warning"}) {
        const std::size_t place = output.find(complaint);
        if (place != std::string::npos) FAIL_CHECK(output.substr(place, 500));
    }
}

// What is said on standard error, with explanations on.
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
    for (int c = std::fgetc(said); c != EOF; c = std::fgetc(said)) text += static_cast<char>(c);
    std::fclose(said);
    return text;
}

constexpr const char* kLeaving = "size 128 128\nframes every 10\npress right squeeze 0.1 0.3\nat 0.4 exit\n";
constexpr const char* kValidation =
    "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT";

}  // namespace

TEST_CASE("the library shows one function, which negotiates version 1") {
    void* const handle = dlopen(Direct::path().c_str(), RTLD_NOW | RTLD_LOCAL);
    REQUIRE(handle != nullptr);
    // What is found then belongs to another library that this one needs.
    for (const char* name : {"xrCreateInstance", "xrGetInstanceProcAddr", "vkCreateInstance"}) {
        Dl_info owner{};
        void* const found = dlsym(handle, name);
        CHECK((found == nullptr || (dladdr(found, &owner) != 0 && !contains(owner.dli_fname, "binosplat"))));
    }
    const auto negotiate = reinterpret_cast<Negotiate>(dlsym(handle, "xrNegotiateLoaderRuntimeInterface"));
    REQUIRE((negotiate != nullptr));
    const auto negotiated = [&](auto&& change) {
        LoaderInfo info;
        RuntimeRequest request;
        change(info, request);
        return negotiate(&info, &request);
    };
    CHECK(negotiated([](auto&, auto&) {}) == XR_SUCCESS);
    CHECK(negotiated([](auto& info, auto&) { info.type = 2; }) == XR_ERROR_INITIALIZATION_FAILED);
    CHECK(negotiated([](auto& info, auto&) { info.version = 2; }) == XR_ERROR_INITIALIZATION_FAILED);
    CHECK(negotiated([](auto& info, auto&) { info.size = 8; }) == XR_ERROR_INITIALIZATION_FAILED);
    CHECK(negotiated([](auto& info, auto&) { info.least_interface = info.most_interface = 2; }) == XR_ERROR_INITIALIZATION_FAILED);
    CHECK(negotiated([](auto& info, auto&) { info.least_api = XR_MAKE_VERSION(2, 0, 0); }) == XR_ERROR_INITIALIZATION_FAILED);
    CHECK(negotiated([](auto&, auto& request) { request.type = 1; }) == XR_ERROR_INITIALIZATION_FAILED);
    CHECK(negotiated([](auto&, auto& request) { request.size = 8; }) == XR_ERROR_INITIALIZATION_FAILED);
    CHECK(negotiate(nullptr, nullptr) == XR_ERROR_INITIALIZATION_FAILED);
    RuntimeRequest request;
    const LoaderInfo info;
    CHECK(negotiate(&info, &request) == XR_SUCCESS);
    CHECK(request.interface == 1);
    CHECK(XR_VERSION_MAJOR(request.api) == 1);
    REQUIRE((request.get_instance_proc_addr != nullptr));
    // The loader answers for the layers by itself; a loader that asks is told of none.
    PFN_xrVoidFunction found = nullptr;
    CHECK(request.get_instance_proc_addr(XR_NULL_HANDLE, "xrEnumerateApiLayerProperties", &found) == XR_SUCCESS);
    const auto enumerateLayers = reinterpret_cast<PFN_xrEnumerateApiLayerProperties>(found);
    REQUIRE((enumerateLayers != nullptr));
    std::uint32_t count = 9;
    CHECK(enumerateLayers(0, &count, nullptr) == XR_SUCCESS);
    CHECK(count == 0);
    CHECK(enumerateLayers(0, nullptr, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    dlclose(handle);
}

TEST_CASE("what the loader asks for after a refused instance is not explained, what the program asked for is") {
    const Headset headset(kLeaving);
    const Direct runtime;
    const std::string explained = explainedBy([&] {
        XrInstanceCreateInfo info = instanceInfo({});
        info.createFlags = 1;
        XrInstance instance = XR_NULL_HANDLE;
        CHECK(runtime.function<PFN_xrCreateInstance>(XR_NULL_HANDLE, "xrCreateInstance")(&info, &instance) == XR_ERROR_VALIDATION_FAILURE);
        PFN_xrVoidFunction found = nullptr;
        for (const char* name : {"xrWaitFrame", "xrEndFrame", "xrCreateHandTrackerEXT"}) {
            CHECK(runtime.get(XR_NULL_HANDLE, name, &found) == XR_ERROR_HANDLE_INVALID);
            CHECK(runtime.get(instance, name, &found) == XR_ERROR_HANDLE_INVALID);
        }
    });
    CHECK(explained == "simulated runtime: xrCreateInstance: XR_ERROR_VALIDATION_FAILURE: createFlags is 1, no flags are known\n");
}

TEST_CASE("the environment is read again for each instance") {
    const Headset headset("plugged off\n");
    const auto systemOf = [&](const Direct& runtime) {
        const XrInstanceCreateInfo info = instanceInfo({});
        XrInstance instance = XR_NULL_HANDLE;
        REQUIRE(runtime.function<PFN_xrCreateInstance>(XR_NULL_HANDLE, "xrCreateInstance")(&info, &instance) == XR_SUCCESS);
        const XrSystemGetInfo get{XR_TYPE_SYSTEM_GET_INFO, nullptr, XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
        XrSystemId system = XR_NULL_SYSTEM_ID;
        const XrResult result = runtime.function<PFN_xrGetSystem>(instance, "xrGetSystem")(instance, &get, &system);
        CHECK(runtime.function<PFN_xrDestroyInstance>(instance, "xrDestroyInstance")(instance) == XR_SUCCESS);
        return result;
    };
    const Direct runtime;
    CHECK_MESSAGE(systemOf(runtime) == XR_ERROR_FORM_FACTOR_UNAVAILABLE, "no headset");
    std::ofstream(headset.folder / "other.script") << "plugged on\n";
    setenv("SIMULATED_OPENXR_SCRIPT", (headset.folder / "other.script").c_str(), 1);
    CHECK(systemOf(runtime) == XR_SUCCESS);
    setenv("SIMULATED_OPENXR_CLOCK", "sundial", 1);
    const std::string explained = explainedBy([&] {
        const XrInstanceCreateInfo info = instanceInfo({});
        XrInstance instance = XR_NULL_HANDLE;
        CHECK(runtime.function<PFN_xrCreateInstance>(XR_NULL_HANDLE, "xrCreateInstance")(&info, &instance) == XR_ERROR_RUNTIME_FAILURE);
    });
    CHECK(explained == "simulated runtime: xrCreateInstance: SIMULATED_OPENXR_CLOCK is 'sundial', must be lockstep or real\n");
    for (const char* name : {"SIMULATED_OPENXR_SCRIPT", "SIMULATED_OPENXR_CLOCK"}) unsetenv(name);
}

TEST_CASE("a refusal that comes again is counted, not repeated") {
    const std::string explained = explainedBy([&] {
        const DirectInstance made(k1_0, {});
        XrPath path = XR_NULL_PATH;
        const auto toPath = made.xr<PFN_xrStringToPath>("xrStringToPath");
        for (int i = 0; i < 125; ++i) {
            CHECK(toPath(made.instance, "no slash", &path) == XR_ERROR_PATH_FORMAT_INVALID);
            if (i % 20 == 0) { CHECK(toPath(made.instance, "/a/../b", &path) == XR_ERROR_PATH_FORMAT_INVALID); }
        }
    });
    const std::string line = "simulated runtime: xrStringToPath: XR_ERROR_PATH_FORMAT_INVALID: 'no slash' is not a well-formed path";
    const std::string other = "simulated runtime: xrStringToPath: XR_ERROR_PATH_FORMAT_INVALID: '/a/../b' is not a well-formed path";
    CHECK(explained == line + "\n" + other + "\n" + line + " (10 times so far)\n" + line + " (100 times so far)\n" + other +
                           " (7 times in all)\n" + line + " (125 times in all)\n");
}

TEST_CASE("an instance empties the folder of an earlier run, one that is refused leaves it alone") {
    const Headset headset(kQuietScript);
    std::filesystem::create_directories(headset.written);
    const std::filesystem::path picture = headset.written / "frame_000003.png";
    std::ofstream(picture) << "x";
    std::ofstream(headset.written / "frames.jsonl") << "{\"frame\":0,\"display_time_ns\":1,\"picture\":\"frame_000003.png\"}\n";
    const Direct runtime;
    const auto create = runtime.function<PFN_xrCreateInstance>(XR_NULL_HANDLE, "xrCreateInstance");
    const std::vector<const char*> unknown{"XR_KHR_nothing"};
    XrInstanceCreateInfo info = instanceInfo(unknown);
    XrInstance instance = XR_NULL_HANDLE;
    CHECK(create(&info, &instance) == XR_ERROR_EXTENSION_NOT_PRESENT);
    CHECK(std::filesystem::exists(picture));
    CHECK(std::filesystem::file_size(headset.written / "frames.jsonl") > 0);
    info = instanceInfo({});
    REQUIRE(create(&info, &instance) == XR_SUCCESS);
    CHECK_FALSE(std::filesystem::exists(picture));
    CHECK(std::filesystem::file_size(headset.written / "frames.jsonl") == 0);
    CHECK(runtime.function<PFN_xrDestroyInstance>(instance, "xrDestroyInstance")(instance) == XR_SUCCESS);
    // Somebody else's log, here behind a link.
    std::ofstream(headset.folder / "victim") << "keep me";
    std::filesystem::remove(headset.written / "frames.jsonl");
    std::filesystem::create_symlink(headset.folder / "victim", headset.written / "frames.jsonl");
    const std::string explained = explainedBy([&] { CHECK(create(&info, &instance) == XR_ERROR_RUNTIME_FAILURE); });
    CHECK(explained == "simulated runtime: xrCreateInstance: " + (headset.written / "frames.jsonl").string() +
                           ": not what an earlier run left here, must be moved elsewhere\n");
    CHECK(std::filesystem::file_size(headset.folder / "victim") == 7);
}

TEST_CASE("openxr_runtime_list finds it") {
    if (!isInstalled("openxr_runtime_list", "libopenxr-utils")) return;
    const Headset headset(kLeaving);
    const Run listed = run(headset, "openxr_runtime_list");
    CHECK(listed.exit_code == 0);
    CHECK(contains(listed.output, "Simulated headset"));
    CHECK(contains(listed.output, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME));
}

TEST_CASE("hello_xr runs on it from start to end, and neither validation layer has anything to say") {
    if (!isInstalled("hello_xr", "libopenxr-utils")) return;
    const Headset headset(kLeaving);
    std::string environment = kValidation;
    SUBCASE("XR_KHR_vulkan_enable2") {
        const Run hello = run(headset, "hello_xr -g Vulkan2", environment);
        CHECK(hello.exit_code == 0);
        CHECK(contains(hello.output, "XR_SESSION_STATE_VISIBLE->XR_SESSION_STATE_FOCUSED"));
        CHECK(contains(hello.output, "XR_SESSION_STATE_IDLE->XR_SESSION_STATE_EXITING"));
        CHECK(std::filesystem::exists(headset.written / "frame_000010.png"));
        CHECK(std::filesystem::exists(headset.written / "frame_000030.png"));
        checkSilent(hello.output);
    }
    SUBCASE("XR_KHR_vulkan_enable") {
        const Run hello = run(headset, "hello_xr -g Vulkan", environment);
        CHECK(hello.exit_code == 0);
        CHECK(contains(hello.output, "XR_SESSION_STATE_VISIBLE->XR_SESSION_STATE_FOCUSED"));
        checkSilent(hello.output);
    }
    SUBCASE("under OpenXR's own validation layer") {
        environment +=
            " XR_ENABLE_API_LAYERS=XR_APILAYER_LUNARG_core_validation XR_CORE_VALIDATION_EXPORT_TYPE=text XR_CORE_VALIDATION_FILE_NAME=" +
            (headset.folder / "validation").string();
        const Run hello = run(headset, "hello_xr -g Vulkan2", environment);
        CHECK(hello.exit_code == 0);
        checkSilent(hello.output);
        std::ifstream validation(headset.folder / "validation");
        checkSilent({std::istreambuf_iterator<char>(validation), {}});
    }
    SUBCASE("paced by a real clock") {
        const Run hello = run(headset, "hello_xr -g Vulkan2", environment + " SIMULATED_OPENXR_CLOCK=real");
        CHECK(hello.exit_code == 0);
        CHECK(contains(hello.output, "XR_SESSION_STATE_IDLE->XR_SESSION_STATE_EXITING"));
    }
    SUBCASE("with other controllers") {
        const Run hello = run(headset, "hello_xr -g Vulkan2", environment + " SIMULATED_OPENXR_PROFILE=valve/index_controller");
        CHECK(hello.exit_code == 0);
        CHECK(contains(hello.output, "Left hand Index controller Squeeze"));
    }
}

TEST_CASE("a machine without GPU is told apart from one without headset and from a broken script") {
    if (!isInstalled("hello_xr", "libopenxr-utils")) return;
    const Headset headset(kLeaving);
    const Run no_gpu = run(headset, "hello_xr -g Vulkan2", "VK_ICD_FILENAMES=/nowhere.json VK_DRIVER_FILES=/nowhere.json");
    CHECK(contains(no_gpu.output, "simulated runtime: xrCreateVulkanInstanceKHR: no GPU: Vulkan has no driver"));
    const Headset absent("plugged off\n");
    const Run no_headset = run(absent, "hello_xr -g Vulkan2", "SIMULATED_OPENXR_EXPLAIN=1");
    CHECK(contains(no_headset.output, "simulated runtime: xrGetSystem: XR_ERROR_FORM_FACTOR_UNAVAILABLE: no headset"));
    const Headset broken("at noon exit\n");
    const Run no_script = run(broken, "hello_xr -g Vulkan2");
    CHECK(contains(no_script.output, "test.script:1: "));
    for (const Run& one : {no_headset, no_script}) CHECK(!contains(one.output, "no GPU"));
}

}  // namespace simulated_runtime_test
