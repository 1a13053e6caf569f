// The one symbol that the library exports: the loader asks for the rest through it.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "xr/simulated/api/api.h"
#include "xr/simulated/system.h"

namespace {

// The loader's interface, version 1. Debian's headers lack it; the fields follow "OpenXR loader - design and
// operation".
enum class InterfaceStructure : int { LoaderInfo = 1, RuntimeRequest = 3 };
constexpr std::uint32_t kInterfaceVersion = 1;
constexpr std::uint32_t kStructureVersion = 1;
constexpr XrVersion kApiVersion = XR_MAKE_VERSION(1, 1, 41);

struct NegotiateLoaderInfo {
    InterfaceStructure structure_type;
    std::uint32_t structure_version;
    std::size_t structure_size;
    std::uint32_t least_interface_version;
    std::uint32_t most_interface_version;
    XrVersion least_api_version;
    XrVersion most_api_version;
};

struct NegotiateRuntimeRequest {
    InterfaceStructure structure_type;
    std::uint32_t structure_version;
    std::size_t structure_size;
    std::uint32_t interface_version;
    XrVersion api_version;
    PFN_xrGetInstanceProcAddr get_instance_proc_addr;
};

bool isUnderstood(const NegotiateLoaderInfo* info) {
    return info != nullptr && info->structure_type == InterfaceStructure::LoaderInfo &&
           info->structure_version == kStructureVersion && info->structure_size == sizeof *info &&
           info->least_interface_version <= kInterfaceVersion &&
           info->most_interface_version >= kInterfaceVersion &&
           XR_VERSION_MAJOR(info->least_api_version) <= 1 &&
           info->most_api_version >= XR_MAKE_VERSION(1, 0, 0);
}

bool isUnderstood(const NegotiateRuntimeRequest* request) {
    return request != nullptr && request->structure_type == InterfaceStructure::RuntimeRequest &&
           request->structure_version == kStructureVersion && request->structure_size == sizeof *request;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const NegotiateLoaderInfo* loader_info, NegotiateRuntimeRequest* request) {
    if (!isUnderstood(loader_info) || !isUnderstood(request)) { return XR_ERROR_INITIALIZATION_FAILED; }
    simulated::keepThisLibrary();
    request->interface_version = kInterfaceVersion;
    // The versions that this runtime implements, as far as the loader supports them.
    request->api_version = std::min<XrVersion>(kApiVersion, loader_info->most_api_version);
    request->get_instance_proc_addr = simulated::xrGetInstanceProcAddr;
    return XR_SUCCESS;
}
