// An OpenXR API layer in which calls fail as a test says: things that runtimes do, but the simulated one does
// not.
// BINOSPLAT_XR_FAULT=CALL:RESULT[:N[:AFTER]], and more of these after commas: N calls of CALL, or all, return
// the number RESULT and are not executed, once AFTER others were. Instead of RESULT, "missing": the runtime
// does not have the function; "crash": it ends the program. xrCreateInstance:hang never returns.
// BINOSPLAT_XR_EARLY=METRES: a frame's first request for its eyes gets a worse prediction, too high by this
// much; later requests get the right one.
// BINOSPLAT_XR_LOSE=TYPE[:N]: events of this XrStructureType are lost, once N others came, and the runtime
// reports the loss of one.
// For BINOSPLAT_FAULT_WAITS (waits.h), it tells when a frame ends and what the runtime does itself.
#include <vulkan/vulkan.h>
#define XR_USE_GRAPHICS_API_VULKAN
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include "tests/faults/waits.h"

#include <atomic>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include <unistd.h>

namespace {

struct Fault {
    bool is_missing = false, is_crash = false;
    XrResult result = XR_SUCCESS;
    std::atomic<int> before{0}, left{INT_MAX};  // calls that do not fail yet, and calls that fail afterwards
};

// By the name of the function. Only read after the first call.
std::map<std::string, Fault>& faults() {
    static std::map<std::string, Fault> all = [] {
        std::map<std::string, Fault> found;
        const char* const given = std::getenv("BINOSPLAT_XR_FAULT");
        std::istringstream items(given != nullptr ? given : "");
        for (std::string item; std::getline(items, item, ',');) {
            std::istringstream parts(item);
            std::string name, result, count, before;
            std::getline(parts, name, ':');
            std::getline(parts, result, ':');
            Fault& fault = found[name];
            fault.is_missing = result == "missing";
            fault.is_crash = result == "crash";
            fault.result = static_cast<XrResult>(std::atoi(result.c_str()));
            if (std::getline(parts, count, ':')) { fault.left = std::atoi(count.c_str()); }
            if (std::getline(parts, before, ':')) { fault.before = std::atoi(before.c_str()); }
        }
        return found;
    }();
    return all;
}

PFN_xrGetInstanceProcAddr g_next = nullptr;

#define BINOSPLAT_FAULTY(item)                                                                             \
    item(xrApplyHapticFeedback) item(xrCreateHandTrackerEXT) item(xrLocateHandJointsEXT)                   \
        item(xrEnumerateDisplayRefreshRatesFB) item(xrGetDisplayRefreshRateFB)                             \
            item(xrRequestDisplayRefreshRateFB) item(xrEnumerateReferenceSpaces) item(xrCreateActionSpace) \
                item(xrSuggestInteractionProfileBindings) item(xrCreateSession) item(xrCreateSwapchain)    \
                    item(xrWaitFrame) item(xrBeginFrame) item(xrAcquireSwapchainImage)                     \
                        item(xrWaitSwapchainImage) item(xrReleaseSwapchainImage) item(xrEndFrame)          \
                            item(xrGetSystemProperties) item(xrLocateViews) item(xrPollEvent)

#define BINOSPLAT_TAG(name)                         \
    struct Tag_##name {                             \
        static constexpr const char* kName = #name; \
    };
BINOSPLAT_FAULTY(BINOSPLAT_TAG)

// What becomes of a function's results.
template <typename Tag, typename... Arguments>
void change(Tag, XrResult, Arguments...) {}

// How often the open frame's eyes were located.
std::atomic<int> g_looks{0};

void change(Tag_xrBeginFrame, XrResult, XrSession, const XrFrameBeginInfo*) { g_looks = 0; }

void change(Tag_xrLocateViews, XrResult result, XrSession, const XrViewLocateInfo*, XrViewState*,
            std::uint32_t capacity, std::uint32_t* count, XrView* views) {
    const char* const early = std::getenv("BINOSPLAT_XR_EARLY");
    if (early == nullptr || XR_FAILED(result) || capacity == 0 || g_looks++ != 0) { return; }
    for (std::uint32_t i = 0; i < *count; ++i) { views[i].pose.position.y += std::strtof(early, nullptr); }
}

void change(Tag_xrPollEvent, XrResult result, XrInstance, XrEventDataBuffer* event) {
    const char* const lose = std::getenv("BINOSPLAT_XR_LOSE");
    if (lose == nullptr || result != XR_SUCCESS || event->type != std::atoi(lose)) { return; }
    const char* const after = std::strchr(lose, ':');
    static std::atomic<int> left{after != nullptr ? std::atoi(after + 1) : 0};
    if (left-- > 0) { return; }
    XrEventDataEventsLost lost{XR_TYPE_EVENT_DATA_EVENTS_LOST, nullptr, 1};
    std::memcpy(event, &lost, sizeof lost);
}

// A function that fails as long as its fault lasts, and then calls the next one. `Tag` is a separate struct
// for each function.
template <typename Tag, typename Function>
struct Faulty;
template <typename Tag, typename... Arguments>
struct Faulty<Tag, XrResult(XRAPI_PTR*)(Arguments...)> {
    static XRAPI_ATTR XrResult XRAPI_CALL call(Arguments... arguments) {
        const auto found = faults().find(Tag::kName);
        if (found == faults().end() || found->second.before > 0 || found->second.left <= 0) {
            if (found != faults().end()) { --found->second.before; }
            const XrResult result =
                binosplat::faults::runInRuntime(Tag::kName, [&] { return next(arguments...); });
            change(Tag{}, result, arguments...);
            return result;
        }
        Fault& fault = found->second;
        if (fault.is_crash) { std::abort(); }
        --fault.left;
        return fault.result;
    }
    static inline XrResult(XRAPI_PTR* next)(Arguments...) = nullptr;
};

XRAPI_ATTR XrResult XRAPI_CALL getInstanceProcAddr(XrInstance instance, const char* name,
                                                   PFN_xrVoidFunction* function) {
    const auto found = faults().find(name);
    if (found != faults().end() && found->second.is_missing) {
        *function = nullptr;
        return XR_ERROR_FUNCTION_UNSUPPORTED;
    }
    const XrResult result = g_next(instance, name, function);
    if (XR_FAILED(result)) { return result; }
#define BINOSPLAT_WRAP(wrapped)                                          \
    if (std::strcmp(name, #wrapped) == 0) {                              \
        using Wrapped = Faulty<Tag_##wrapped, PFN_##wrapped>;            \
        Wrapped::next = reinterpret_cast<PFN_##wrapped>(*function);      \
        *function = reinterpret_cast<PFN_xrVoidFunction>(Wrapped::call); \
    }
    BINOSPLAT_FAULTY(BINOSPLAT_WRAP)
    return result;
}

// What the loader and layers tell each other (openxr_loader_negotiation.h, which Debian's package lacks).
struct LoaderInfo {
    std::int32_t type;
    std::uint32_t version;
    std::size_t bytes;
    std::uint32_t least_interface, most_interface;
    XrVersion least_api, most_api;
};
struct CreateInfo;
using CreateInstance = XrResult(XRAPI_PTR*)(const XrInstanceCreateInfo*, const CreateInfo*, XrInstance*);
struct LayerRequest {
    std::int32_t type;
    std::uint32_t version;
    std::size_t bytes;
    std::uint32_t interface_version;
    XrVersion api_version;
    PFN_xrGetInstanceProcAddr get_instance_proc_addr;
    CreateInstance create_instance;
};
struct NextInfo {
    std::int32_t type;
    std::uint32_t version;
    std::size_t bytes;
    char name[XR_MAX_API_LAYER_NAME_SIZE];
    PFN_xrGetInstanceProcAddr get_instance_proc_addr;
    CreateInstance create_instance;
    NextInfo* next;
};
struct CreateInfo {
    std::int32_t type;
    std::uint32_t version;
    std::size_t bytes;
    void* loader_instance;
    char settings_file[512];
    NextInfo* next;
};

XRAPI_ATTR XrResult XRAPI_CALL createInstance(const XrInstanceCreateInfo* info, const CreateInfo* layers,
                                              XrInstance* instance) {
    while (faults().contains("xrCreateInstance")) { pause(); }
    g_next = layers->next->get_instance_proc_addr;
    CreateInfo rest = *layers;
    rest.next = layers->next->next;
    return layers->next->create_instance(info, &rest, instance);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) XRAPI_ATTR XrResult XRAPI_CALL
xrNegotiateLoaderApiLayerInterface(const LoaderInfo* loader, const char* /*name*/, LayerRequest* request) {
    if (loader == nullptr || request == nullptr || loader->least_interface > 1) {
        return XR_ERROR_INITIALIZATION_FAILED;
    }
    request->interface_version = 1;
    request->api_version = XR_MAKE_VERSION(1, 0, 0);
    request->get_instance_proc_addr = getInstanceProcAddr;
    request->create_instance = createInstance;
    return XR_SUCCESS;
}
