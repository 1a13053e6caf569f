// Makes any device call fail, chosen by its number, for a process that tests itself, through the functions at
// the end (dlsym). Needs BINOSPLAT_FAULT_ANY=1 when the device is created.
#include "tests/faults/parts.h"

#include <atomic>

namespace binosplat::faults {
namespace {

std::atomic<int> g_left{0}, g_result{0};
std::atomic<const char*> g_struck{nullptr};

struct Fallible {
    template <typename Call, typename... Arguments>
    static VkResult run(const char* name, const Call& call, Arguments...) {
        if (g_left <= 0 || --g_left != 0) { return call(); }
        g_struck = name;
        return static_cast<VkResult>(g_result.load());
    }
};

}  // namespace

PFN_vkVoidFunction fallible(std::string_view name, PFN_vkVoidFunction next) {
    static const bool is_wanted = std::getenv("BINOSPLAT_FAULT_ANY") != nullptr;
    if (!is_wanted) { return next; }
#define BINOSPLAT_FALLIBLE(function) \
    if (name == #function) { return Wrapped<&function, Fallible>::around(#function, next); }
    BINOSPLAT_FALLIBLE(vkAllocateCommandBuffers)
    BINOSPLAT_FALLIBLE(vkAllocateMemory)
    BINOSPLAT_FALLIBLE(vkBeginCommandBuffer)
    BINOSPLAT_FALLIBLE(vkBindBufferMemory)
    BINOSPLAT_FALLIBLE(vkCreateBuffer)
    BINOSPLAT_FALLIBLE(vkCreateCommandPool)
    BINOSPLAT_FALLIBLE(vkCreateComputePipelines)
    BINOSPLAT_FALLIBLE(vkCreateFence)
    BINOSPLAT_FALLIBLE(vkCreatePipelineLayout)
    BINOSPLAT_FALLIBLE(vkCreateQueryPool)
    BINOSPLAT_FALLIBLE(vkCreateShaderModule)
    BINOSPLAT_FALLIBLE(vkEndCommandBuffer)
    BINOSPLAT_FALLIBLE(vkMapMemory)
    BINOSPLAT_FALLIBLE(vkQueueSubmit)
    BINOSPLAT_FALLIBLE(vkResetCommandBuffer)
    return next;
}

}  // namespace binosplat::faults

#define BINOSPLAT_SEEN extern "C" __attribute__((visibility("default")))

// Makes the Nth such call from now on fail once with this VkResult; with 0, none.
BINOSPLAT_SEEN void binosplat_faults_arm(int number, int result) {
    binosplat::faults::g_struck = nullptr;
    binosplat::faults::g_result = result;
    binosplat::faults::g_left = number;
}
// The name of the call that has failed since then; null if there were fewer calls.
BINOSPLAT_SEEN const char* binosplat_faults_struck() { return binosplat::faults::g_struck; }
// The number of objects and allocations that exist; see live.cpp.
BINOSPLAT_SEEN long long binosplat_faults_live() { return binosplat::faults::liveObjects(); }
