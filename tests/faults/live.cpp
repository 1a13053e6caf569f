// What is alive on a device: objects, device memory and the host's heap, counted while a program runs.
// BINOSPLAT_FAULT_LIVE=FILE: a line for every tenth submission: "submissions objects device-bytes heap-bytes
// resident-bytes kernels-made". The objects and the device's bytes are given as the minimum and maximum since
// the line before: "10 120-140 5242880-6291456 1048576 3145728 24".
// BINOSPLAT_FAULT_READ=FILE: how many bytes the program has read from files when it unloads the layer.
#include "tests/faults/parts.h"

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

struct Makes {
    template <typename Call, typename... Arguments>
    static VkResult run(const char* /*label*/, const Call& call, Arguments...) {
        return count(call(), 1);
    }
    // Several pipelines.
    template <typename Call, typename... Arguments>
    static VkResult run(const char* label, const Call& call, VkDevice, VkPipelineCache, std::uint32_t many,
                        Arguments...) {
        const VkResult result = count(call(), many);
        const std::lock_guard lock(g_mutex);
        g_kernels_made += result == VK_SUCCESS && std::string_view(label) == "kernels" ? many : 0;
        return result;
    }

private:
    static VkResult count(VkResult result, std::uint32_t made) {
        const std::lock_guard lock(g_mutex);
        g_objects.add(result == VK_SUCCESS ? made : 0);
        return result;
    }
};

struct Ends {
    template <typename Call, typename Object>
    static void run(const char* /*label*/, const Call& call, VkDevice, Object object,
                    const VkAllocationCallbacks*) {
        {
            const std::lock_guard lock(g_mutex);
            g_objects.add(object != VK_NULL_HANDLE ? -1 : 0);
        }
        call();
    }
};

struct Frees {
    template <typename Call>
    static void run(const char* /*label*/, const Call& call, VkDevice, VkDeviceMemory memory,
                    const VkAllocationCallbacks*) {
        {
            const std::lock_guard lock(g_mutex);
            if (const auto found = g_memory.find(memory); found != g_memory.end()) {
                g_bytes.add(-static_cast<std::int64_t>(found->second));
                g_objects.add(-1);
                g_memory.erase(found);
            }
        }
        call();
    }
};

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

PFN_vkVoidFunction counted(std::string_view name, PFN_vkVoidFunction next) {
    if (output() == nullptr) { return next; }
#define BINOSPLAT_COUNTED(Kind)                                                                          \
    if (name == "vkCreate" #Kind) { return Wrapped<&vkCreate##Kind, Makes>::around("an object", next); } \
    if (name == "vkDestroy" #Kind) { return Wrapped<&vkDestroy##Kind, Ends>::around("an object", next); }
    BINOSPLAT_COUNTED(Buffer)
    BINOSPLAT_COUNTED(Image)
    BINOSPLAT_COUNTED(ImageView)
    BINOSPLAT_COUNTED(ShaderModule)
    BINOSPLAT_COUNTED(PipelineLayout)
    BINOSPLAT_COUNTED(CommandPool)
    BINOSPLAT_COUNTED(Fence)
    BINOSPLAT_COUNTED(Semaphore)
    BINOSPLAT_COUNTED(QueryPool)
    BINOSPLAT_COUNTED(DescriptorPool)
    BINOSPLAT_COUNTED(DescriptorSetLayout)
    BINOSPLAT_COUNTED(Sampler)
    BINOSPLAT_COUNTED(RenderPass)
    BINOSPLAT_COUNTED(Framebuffer)
    BINOSPLAT_COUNTED(PipelineCache)
#define BINOSPLAT_COUNTED_AS(function, Around, label) \
    if (name == #function) { return Wrapped<&function, Around>::around(label, next); }
    BINOSPLAT_COUNTED_AS(vkCreateComputePipelines, Makes, "kernels")
    BINOSPLAT_COUNTED_AS(vkCreateGraphicsPipelines, Makes, "pipelines")
    BINOSPLAT_COUNTED_AS(vkDestroyPipeline, Ends, "a pipeline")
    BINOSPLAT_COUNTED_AS(vkFreeMemory, Frees, "memory")
    return next;
}

void countMemory(VkDeviceMemory memory, VkDeviceSize bytes) {
    if (output() == nullptr) { return; }
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
