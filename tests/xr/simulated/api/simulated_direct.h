// The runtime without a loader in between: for what Debian's loader, with API 1.0, does not pass on.
#pragma once

#include "tests/xr/simulated/api/simulated_fixture.h"
#include "xr/simulated/openxr_later.h"

#include <dlfcn.h>

namespace binosplat::test {

// The loader's interface, version 1.
struct LoaderInfo {
    int type = 1;
    std::uint32_t version = 1;
    std::size_t size = sizeof(LoaderInfo);
    std::uint32_t least_interface = 1, most_interface = 1;
    XrVersion least_api = XR_MAKE_VERSION(1, 0, 0), most_api = XR_MAKE_VERSION(1, 0x3FF, 0xFFF);
};
struct RuntimeRequest {
    int type = 3;
    std::uint32_t version = 1;
    std::size_t size = sizeof(RuntimeRequest);
    std::uint32_t interface = 0;
    XrVersion api = 0;
    PFN_xrGetInstanceProcAddr get_instance_proc_addr = nullptr;
};
using Negotiate = XrResult (*)(const LoaderInfo*, RuntimeRequest*);

class Direct {
public:
    void* library = nullptr;
    Negotiate negotiate = nullptr;
    PFN_xrGetInstanceProcAddr get = nullptr;
    XrVersion api = 0;

    Direct() {
        const auto path = std::filesystem::path(BINOSPLAT_SIMULATED_RUNTIME).parent_path() /
                          "libbinosplat_simulated_runtime.so";
        library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        REQUIRE(library != nullptr);
        negotiate = reinterpret_cast<Negotiate>(dlsym(library, "xrNegotiateLoaderRuntimeInterface"));
        REQUIRE((negotiate != nullptr));
        const LoaderInfo info;
        RuntimeRequest request;
        REQUIRE(negotiate(&info, &request) == XR_SUCCESS);
        REQUIRE(request.interface == 1);
        get = request.get_instance_proc_addr;
        REQUIRE((get != nullptr));
        api = request.api;
    }
    ~Direct() { dlclose(library); }
    Direct(const Direct&) = delete;
    Direct& operator=(const Direct&) = delete;
};

inline constexpr XrVersion k1_0 = XR_MAKE_VERSION(1, 0, 0), k1_1 = XR_MAKE_VERSION(1, 1, 0);

struct DirectInstance : Direct, InstanceFixture {
    DirectInstance(XrVersion version, const Extensions& extensions, const std::string& script = kQuietScript)
        : InstanceFixture(script, get, instanceInfo(extensions, version)) {}
};

struct HeadlessSession : DirectInstance {
    HeadlessSession(XrVersion version, Extensions extensions, const std::string& script = kQuietScript)
        : DirectInstance(version, (extensions.push_back(XR_MND_HEADLESS_EXTENSION_NAME), extensions),
                         script) {
        const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, nullptr, 0, system};
        REQUIRE(XR(xrCreateSession)(instance, &info, &session) == XR_SUCCESS);
    }
};

}  // namespace binosplat::test
