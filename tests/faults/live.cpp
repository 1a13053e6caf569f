// Counting.
#include "tests/faults/live.h"

#include <dlfcn.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace binosplat::faults {

namespace {

constexpr std::uint64_t kEvery = 10;

// A number that goes up and down, and its bounds since it was last read.
struct Bounds {
    std::int64_t now = 0, least = 0, most = 0;

    void add(std::int64_t more) {
        now += more;
        least = std::min(least, now);
        most = std::max(most, now);
    }
    void beginAnew() { least = most = now; }
};

std::mutex g_mutex;
Bounds g_objects, g_bytes;
std::map<VkDeviceMemory, VkDeviceSize> g_memory;
std::uint64_t g_submissions = 0, g_kernels_made = 0;

void count(std::int64_t more) {
    const std::lock_guard lock(g_mutex);
    g_objects.add(more);
}

// Calls that have one create info and make one object.
#define BINOSPLAT_EACH_KIND(of)                                                                           \
    of(Buffer) of(Image) of(ImageView) of(ShaderModule) of(PipelineLayout) of(CommandPool) of(Fence)      \
        of(Semaphore) of(QueryPool) of(DescriptorPool) of(DescriptorSetLayout) of(Sampler) of(RenderPass) \
            of(Framebuffer) of(PipelineCache)

#define BINOSPLAT_COUNT_KIND(Kind)                                                                        \
    VKAPI_ATTR VkResult VKAPI_CALL create##Kind(VkDevice device, const Vk##Kind##CreateInfo* info,        \
                                                const VkAllocationCallbacks* callbacks, Vk##Kind* made) { \
        const VkResult result = BINOSPLAT_NEXT(vkCreate##Kind)(device, info, callbacks, made);            \
        if (result == VK_SUCCESS) { count(1); }                                                           \
        return result;                                                                                    \
    }                                                                                                     \
    VKAPI_ATTR void VKAPI_CALL destroy##Kind(VkDevice device, Vk##Kind object,                            \
                                             const VkAllocationCallbacks* callbacks) {                    \
        if (object != VK_NULL_HANDLE) { count(-1); }                                                      \
        BINOSPLAT_NEXT(vkDestroy##Kind)(device, object, callbacks);                                       \
    }
BINOSPLAT_EACH_KIND(BINOSPLAT_COUNT_KIND)

VKAPI_ATTR VkResult VKAPI_CALL createCompute(VkDevice device, VkPipelineCache cache, std::uint32_t many,
                                             const VkComputePipelineCreateInfo* infos,
                                             const VkAllocationCallbacks* callbacks, VkPipeline* made) {
    const VkResult result =
        BINOSPLAT_NEXT(vkCreateComputePipelines)(device, cache, many, infos, callbacks, made);
    if (result != VK_SUCCESS) { return result; }
    count(many);
    const std::lock_guard lock(g_mutex);
    g_kernels_made += many;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createGraphics(VkDevice device, VkPipelineCache cache, std::uint32_t many,
                                              const VkGraphicsPipelineCreateInfo* infos,
                                              const VkAllocationCallbacks* callbacks, VkPipeline* made) {
    const VkResult result =
        BINOSPLAT_NEXT(vkCreateGraphicsPipelines)(device, cache, many, infos, callbacks, made);
    if (result == VK_SUCCESS) { count(many); }
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroyPipeline(VkDevice device, VkPipeline pipeline,
                                           const VkAllocationCallbacks* callbacks) {
    if (pipeline != VK_NULL_HANDLE) { count(-1); }
    BINOSPLAT_NEXT(vkDestroyPipeline)(device, pipeline, callbacks);
}

VKAPI_ATTR void VKAPI_CALL freeMemory(VkDevice device, VkDeviceMemory memory,
                                      const VkAllocationCallbacks* callbacks) {
    {
        const std::lock_guard lock(g_mutex);
        if (const auto found = g_memory.find(memory); found != g_memory.end()) {
            g_bytes.add(-static_cast<std::int64_t>(found->second));
            g_objects.add(-1);
            g_memory.erase(found);
        }
    }
    BINOSPLAT_NEXT(vkFreeMemory)(device, memory, callbacks);
}

// The host's memory, counted by the sanitizer if there is one.
std::uint64_t heapBytes() {
    static const auto ask =
        reinterpret_cast<std::size_t (*)()>(dlsym(RTLD_DEFAULT, "__sanitizer_get_current_allocated_bytes"));
    if (ask != nullptr) { return ask(); }
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

std::uint64_t residentBytes() {
    unsigned long all = 0, resident = 0;
    std::FILE* const file = std::fopen("/proc/self/statm", "r");
    if (file == nullptr) { return 0; }
    const bool is_read = std::fscanf(file, "%lu %lu", &all, &resident) == 2;
    std::fclose(file);
    return is_read ? resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

std::FILE* output() {
    static std::FILE* const file = openNamedBy("BINOSPLAT_FAULT_LIVE");
    return file;
}

// At the end.
__attribute__((destructor)) void noteRead() {
    const char* const name = std::getenv("BINOSPLAT_FAULT_READ");
    std::FILE* const counts = name != nullptr ? std::fopen("/proc/self/io", "r") : nullptr;
    if (counts == nullptr) { return; }
    unsigned long long bytes = 0;
    const bool is_known = std::fscanf(counts, "rchar: %llu", &bytes) == 1;
    std::fclose(counts);
    std::FILE* const file = is_known ? std::fopen(name, "w") : nullptr;
    if (file == nullptr) { return; }
    std::fprintf(file, "%llu\n", bytes);
    std::fclose(file);
}

}  // namespace

bool countsLive() { return output() != nullptr; }

PFN_vkVoidFunction countingFunction(const char* name) {
    if (!countsLive()) { return nullptr; }
    static const std::map<std::string, PFN_vkVoidFunction> functions{
#define BINOSPLAT_NAME_KIND(Kind) \
    {"vkCreate" #Kind, asVoid(create##Kind)}, {"vkDestroy" #Kind, asVoid(destroy##Kind)},
        BINOSPLAT_EACH_KIND(BINOSPLAT_NAME_KIND){"vkCreateComputePipelines", asVoid(createCompute)},
        {"vkCreateGraphicsPipelines", asVoid(createGraphics)},
        {"vkDestroyPipeline", asVoid(destroyPipeline)},
        {"vkFreeMemory", asVoid(freeMemory)},
    };
    const auto found = functions.find(name);
    return found == functions.end() ? nullptr : found->second;
}

void countMemory(VkDeviceMemory memory, VkDeviceSize bytes) {
    if (!countsLive()) { return; }
    const std::lock_guard lock(g_mutex);
    g_memory[memory] = bytes;
    g_bytes.add(static_cast<std::int64_t>(bytes));
    g_objects.add(1);
}

long long liveObjects() {
    const std::lock_guard lock(g_mutex);
    return g_objects.now;
}

void noteSubmission() {
    std::FILE* const file = output();
    if (file == nullptr) { return; }
    const std::lock_guard lock(g_mutex);
    if (++g_submissions % kEvery != 0) { return; }
    const auto say = [](std::int64_t value) { return static_cast<long long>(value); };
    std::fprintf(file, "%llu %lld-%lld %lld-%lld %llu %llu %llu\n",
                 static_cast<unsigned long long>(g_submissions), say(g_objects.least), say(g_objects.most),
                 say(g_bytes.least), say(g_bytes.most), static_cast<unsigned long long>(heapBytes()),
                 static_cast<unsigned long long>(residentBytes()),
                 static_cast<unsigned long long>(g_kernels_made));
    std::fflush(file);
    g_objects.beginAnew();
    g_bytes.beginAnew();
}

}  // namespace binosplat::faults
