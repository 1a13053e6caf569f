// The runtime without a loader between: for what Debian's loader, of API 1.0, keeps to itself.
#pragma once

#include "tests/simulated_fixture.h"

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
    PFN_xrGetInstanceProcAddr get = nullptr;
    XrVersion api = 0;

    Direct() {
        library = dlopen(path().c_str(), RTLD_NOW | RTLD_LOCAL);
        REQUIRE(library != nullptr);
        const auto negotiate = reinterpret_cast<Negotiate>(dlsym(library, "xrNegotiateLoaderRuntimeInterface"));
        REQUIRE((negotiate != nullptr));
        const LoaderInfo info;
        RuntimeRequest request;
        REQUIRE(negotiate(&info, &request) == XR_SUCCESS);
        get = request.get_instance_proc_addr;
        api = request.api;
    }
    ~Direct() { dlclose(library); }
    Direct(const Direct&) = delete;
    Direct& operator=(const Direct&) = delete;

    static std::filesystem::path path() {
        return std::filesystem::path(BINOSPLAT_SIMULATED_RUNTIME).parent_path() / "libbinosplat_simulated_runtime.so";
    }

    template <class Function>
    Function function(XrInstance instance, const char* name) const {
        PFN_xrVoidFunction found = nullptr;
        REQUIRE_MESSAGE(get(instance, name, &found) == XR_SUCCESS, name);
        return reinterpret_cast<Function>(found);
    }

private:
    void* library = nullptr;
};

}  // namespace binosplat::test
