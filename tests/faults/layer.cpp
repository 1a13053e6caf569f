// A Vulkan layer in which a call fails, or a signal arrives, at a point that a test names: machines do this
// at unknown points.
// BINOSPLAT_FAULT=CALL:N:FAULT with CALL submit, wait, present or allocate, N from 1, and FAULT lost,
// surface-lost, surface-lost-once, no-device-memory, no-device-memory-once, no-host-memory, type-full, SIGINT
// or SIGTERM. From the Nth such call on, what is lost stays lost and memory stays full; signals come once. On
// a lost device, waiting until it is idle always fails. type-full: buffers may lie in one more type of
// memory, and the first type is full.
// BINOSPLAT_FAULT_TICKS=N: timestamps are N ticks apart, however long the work between them took.
// BINOSPLAT_FAULT_TRACE=FILE: a line for each submission and each wait, in their order, with the fence:
// "submit 55d0", "wait 55d0"; "wait all" for a wait for the queue or the device.
// BINOSPLAT_FAULT_LIVE=FILE: what is alive, see live.cpp.
// BINOSPLAT_FAULT_LOAD=...: how long frames take, see load.cpp.
// BINOSPLAT_FAULT_WAITS=FILE: work in frames that could wait, see waits.h.
// BINOSPLAT_FAULT_ANY=1: any call may fail, see any.cpp.
#include "tests/faults/parts.h"
#include "tests/faults/waits.h"

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

namespace {

namespace faults = binosplat::faults;
using faults::asVoid;

// What BINOSPLAT_FAULT says.
struct Plan {
    std::string call, fault;
    int number = 0;

    Plan() {
        const char* given = std::getenv("BINOSPLAT_FAULT");
        const std::string text = given != nullptr ? given : "";
        const std::size_t first = text.find(':'), second = text.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) { return; }
        call = text.substr(0, first);
        number = std::atoi(text.substr(first + 1, second - first - 1).c_str());
        fault = text.substr(second + 1);
    }
};

// One instance and one device per process, as the program has them.
PFN_vkGetInstanceProcAddr g_instance_next = nullptr;
VkInstance g_instance = VK_NULL_HANDLE;
PFN_vkGetPhysicalDeviceMemoryProperties g_memory_properties = nullptr;
std::atomic<bool> g_is_lost{false};
std::uint32_t g_added_type = 0;  // of memory

const Plan& thePlan() {
    static const Plan plan;
    return plan;
}

// What the call returns instead of being executed; VK_SUCCESS: execute it.
VkResult strike(const char* call) {
    const Plan& plan = thePlan();
    static std::atomic<int> calls{0};
    if (plan.call != call) { return VK_SUCCESS; }
    const int number = ++calls;
    if (number < plan.number) { return VK_SUCCESS; }
    const bool is_once = plan.fault.ends_with("-once") || plan.fault.starts_with("SIG");
    if (is_once && number > plan.number) { return VK_SUCCESS; }
    const auto is = [&](const char* fault) { return plan.fault.starts_with(fault); };
    if (is("SIG")) { (void)std::raise(is("SIGTERM") ? SIGTERM : SIGINT); }
    g_is_lost = g_is_lost || is("lost");
    return is("lost")                                  ? VK_ERROR_DEVICE_LOST
           : is("surface-lost")                        ? VK_ERROR_SURFACE_LOST_KHR
           : is("no-device-memory") || is("type-full") ? VK_ERROR_OUT_OF_DEVICE_MEMORY
           : is("no-host-memory")                      ? VK_ERROR_OUT_OF_HOST_MEMORY
                                                       : VK_SUCCESS;
}

std::FILE* traceFile() {
    static std::FILE* const file = faults::openNamedBy("BINOSPLAT_FAULT_TRACE");
    return file;
}

void trace(const char* call, VkFence fence) {
    if (std::FILE* const file = traceFile(); file != nullptr) {
        std::fprintf(file, "%s %llx\n", call,
                     static_cast<unsigned long long>(reinterpret_cast<std::uintptr_t>(fence)));
        std::fflush(file);
    }
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* infos,
                                      VkFence fence) {
    trace("submit", fence);
    faults::noteSubmission();
    faults::noteFenceSubmitted(fence);
    const VkResult result = strike("submit");
    return result != VK_SUCCESS ? result : BINOSPLAT_NEXT(vkQueueSubmit)(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL present(VkQueue queue, const VkPresentInfoKHR* info) {
    faults::notePresented();
    const VkResult result = strike("present");
    return result != VK_SUCCESS ? result : BINOSPLAT_NEXT(vkQueuePresentKHR)(queue, info);
}

// A device is lost while it works: the wait itself is executed, so nothing is destroyed that is still in use.
VKAPI_ATTR VkResult VKAPI_CALL wait(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                                    std::uint64_t timeout) {
    for (std::uint32_t i = 0; i < count; ++i) {
        trace("wait", fences[i]);
        faults::noteFenceWait(fences[i], timeout);
    }
    const VkResult waited = BINOSPLAT_NEXT(vkWaitForFences)(device, count, fences, all, timeout);
    const VkResult result = strike("wait");
    return result != VK_SUCCESS ? result : waited;
}

// For the queue or the device.
struct WaitsForAll {
    template <typename Call, typename Handle>
    static VkResult run(const char* /*label*/, const Call& call, Handle) {
        if (std::FILE* const file = traceFile(); file != nullptr) { std::fprintf(file, "wait all\n"); }
        const VkResult waited = call();
        return g_is_lost ? VK_ERROR_DEVICE_LOST : waited;
    }
};

bool addsType() { return thePlan().fault == "type-full"; }

VKAPI_ATTR void VKAPI_CALL memoryProperties(VkPhysicalDevice physical_device,
                                            VkPhysicalDeviceMemoryProperties* properties) {
    g_memory_properties(physical_device, properties);
    g_added_type = properties->memoryTypeCount++;
    properties->memoryTypes[g_added_type] = properties->memoryTypes[0];
}

VKAPI_ATTR void VKAPI_CALL requirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements* needs) {
    BINOSPLAT_NEXT(vkGetBufferMemoryRequirements)(device, buffer, needs);
    if ((needs->memoryTypeBits & 1) != 0) { needs->memoryTypeBits |= 1u << g_added_type; }
}

VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo* info,
                                        const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
    VkMemoryAllocateInfo own = *info;
    if (addsType() && info->memoryTypeIndex == g_added_type) { own.memoryTypeIndex = 0; }
    const VkResult struck = own.memoryTypeIndex == info->memoryTypeIndex ? strike("allocate") : VK_SUCCESS;
    const VkResult result =
        struck != VK_SUCCESS ? struck : BINOSPLAT_NEXT(vkAllocateMemory)(device, &own, callbacks, memory);
    if (result == VK_SUCCESS) { faults::countMemory(*memory, info->allocationSize); }
    return result;
}

// The program reads 64 bits for each.
VKAPI_ATTR VkResult VKAPI_CALL results(VkDevice device, VkQueryPool pool, std::uint32_t first,
                                       std::uint32_t count, std::size_t bytes, void* data,
                                       VkDeviceSize stride, VkQueryResultFlags flags) {
    const VkResult result =
        BINOSPLAT_NEXT(vkGetQueryPoolResults)(device, pool, first, count, bytes, data, stride, flags);
    const char* const apart = std::getenv("BINOSPLAT_FAULT_TICKS");
    const std::optional<std::uint64_t> frame = faults::ticksOf(pool);
    if ((apart == nullptr && !frame) || (flags & VK_QUERY_RESULT_64_BIT) == 0) { return result; }
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t ticks = frame ? *frame * (first + i) / (first + count - 1)
                                          : (first + i) * std::strtoull(apart, nullptr, 10);
        std::memcpy(static_cast<char*>(data) + i * stride, &ticks, sizeof ticks);
    }
    return result;
}

// The next layer's link in what the loader chained to a create info.
template <typename Link>
Link* linkOf(const void* chain, VkStructureType type) {
    for (const auto* item = static_cast<const VkBaseInStructure*>(chain); item != nullptr;
         item = item->pNext) {
        if (item->sType != type) { continue; }
        auto* link = reinterpret_cast<Link*>(const_cast<VkBaseInStructure*>(item));
        if (link->function == VK_LAYER_LINK_INFO) { return link; }
    }
    return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* callbacks, VkInstance* instance) {
    auto* link =
        linkOf<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr) { return VK_ERROR_INITIALIZATION_FAILED; }
    g_instance_next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(g_instance_next(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, callbacks, instance);
    if (result != VK_SUCCESS) { return result; }
    g_instance = *instance;
    const auto memory = g_instance_next(*instance, "vkGetPhysicalDeviceMemoryProperties");
    g_memory_properties = reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(memory);
    return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name);

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical_device, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks, VkDevice* device) {
    auto* link = linkOf<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr) { return VK_ERROR_INITIALIZATION_FAILED; }
    const PFN_vkGetInstanceProcAddr instance_next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    faults::device_next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(instance_next(VK_NULL_HANDLE, "vkCreateDevice"));
    const VkResult result = create(physical_device, info, callbacks, device);
    if (result != VK_SUCCESS) { return result; }
    faults::the_device = *device;
    VkPhysicalDeviceProperties properties{};
    reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(
        instance_next(g_instance, "vkGetPhysicalDeviceProperties"))(physical_device, &properties);
    faults::beginLoad(static_cast<double>(properties.limits.timestampPeriod));
    return VK_SUCCESS;
}

// Null if it is left to the next layer. `next`: what that has.
PFN_vkVoidFunction ownFunction(const char* text, PFN_vkVoidFunction next) {
    const std::string_view name = text;
    if (name == "vkCreateInstance") { return asVoid(createInstance); }
    if (name == "vkCreateDevice") { return asVoid(createDevice); }
    if (name == "vkGetInstanceProcAddr") { return asVoid(getInstanceProcAddr); }
    if (name == "vkGetDeviceProcAddr") { return asVoid(getDeviceProcAddr); }
    if (name == "vkQueueSubmit") { return asVoid(submit); }
    if (name == "vkQueuePresentKHR" && next != nullptr) { return asVoid(present); }
    if (name == "vkWaitForFences") { return asVoid(wait); }
    if (name == "vkAllocateMemory") { return asVoid(allocate); }
    if (name == "vkGetQueryPoolResults") { return asVoid(results); }
    if (addsType() && name == "vkGetBufferMemoryRequirements") { return asVoid(requirements); }
    if (addsType() && name == "vkGetPhysicalDeviceMemoryProperties") { return asVoid(memoryProperties); }
    return faults::loadFunction(text);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    const PFN_vkVoidFunction next = faults::device_next(device, name), own = ownFunction(name, next);
    PFN_vkVoidFunction function = own != nullptr ? own : next;
    if (function == nullptr) { return nullptr; }
    if (std::strcmp(name, "vkDeviceWaitIdle") == 0) {
        function = faults::Wrapped<&vkDeviceWaitIdle, WaitsForAll>::around("device", next);
    } else if (std::strcmp(name, "vkQueueWaitIdle") == 0) {
        function = faults::Wrapped<&vkQueueWaitIdle, WaitsForAll>::around("queue", next);
    }
    return faults::fallible(name, faults::watched(name, faults::counted(name, function)));
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction next = instance != VK_NULL_HANDLE ? g_instance_next(instance, name) : nullptr,
                             own = ownFunction(name, next);
    return own != nullptr ? own : next;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    if (interface->loaderLayerInterfaceVersion < 2) { return VK_ERROR_INITIALIZATION_FAILED; }
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = getInstanceProcAddr;
    interface->pfnGetDeviceProcAddr = getDeviceProcAddr;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
