// Counting down.
#include "tests/faults/any.h"

#include "tests/faults/live.h"

#include <atomic>
#include <cstdlib>
#include <string_view>

namespace binosplat::faults {
namespace {

std::atomic<int> g_left{0}, g_result{0};
std::atomic<const char*> g_struck{nullptr};

template <auto kFunction>
struct Fallible;
template <typename... Arguments, VkResult(VKAPI_PTR* kFunction)(Arguments...)>
struct Fallible<kFunction> {
    static VKAPI_ATTR VkResult VKAPI_CALL call(Arguments... arguments) {
        if (g_left > 0 && --g_left == 0) {
            g_struck = its_name;
            return static_cast<VkResult>(g_result.load());
        }
        return reinterpret_cast<decltype(kFunction)>(next)(arguments...);
    }
    static PFN_vkVoidFunction before(const char* name, PFN_vkVoidFunction its_next) {
        its_name = name;
        next = its_next;
        return asVoid(call);
    }
    static inline const char* its_name = nullptr;
    static inline PFN_vkVoidFunction next = nullptr;
};

}  // namespace

PFN_vkVoidFunction fallible(const char* name, PFN_vkVoidFunction next) {
    static const bool is_wanted = std::getenv("BINOSPLAT_FAULT_ANY") != nullptr;
    if (!is_wanted || next == nullptr) { return next; }
#define BINOSPLAT_FALLIBLE(function) \
    if (std::string_view(name) == #function) { return Fallible<&function>::before(#function, next); }
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

#define BINOSPLAT_SEEN __attribute__((visibility("default")))

BINOSPLAT_SEEN void binosplat_faults_arm(int number, int result) {
    binosplat::faults::g_struck = nullptr;
    binosplat::faults::g_result = result;
    binosplat::faults::g_left = number;
}

BINOSPLAT_SEEN const char* binosplat_faults_struck() { return binosplat::faults::g_struck; }

BINOSPLAT_SEEN long long binosplat_faults_live() { return binosplat::faults::liveObjects(); }
