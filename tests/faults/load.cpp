// Frames that take as long as a test says, whatever they take on the device.
// BINOSPLAT_FAULT_LOAD=FRAME:MS[,FRAME:MS...], with FRAME from 0: from that frame on, a frame with as many
// pixels as the first one takes this long; fewer pixels take a proportional share. Anything with a pass
// "present" is a frame.
#include "tests/faults/parts.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <map>
#include <mutex>

namespace binosplat::faults {

namespace {

// Since its timestamps were reset.
struct Recording {
    VkQueryPool timestamps = VK_NULL_HANDLE;
    bool is_in_present = false;
    std::uint64_t groups = 0;  // groups that present pixels
};

std::mutex g_load_mutex;
std::map<VkCommandBuffer, Recording> g_recordings;
std::uint64_t g_frames = 0, g_first_groups = 0;
double g_tick_ns = 1.0;

// In milliseconds, by the frame from which it applies.
const std::map<std::uint64_t, double>& loads() {
    static const std::map<std::uint64_t, double> all = [] {
        std::map<std::uint64_t, double> found;
        const char* text = std::getenv("BINOSPLAT_FAULT_LOAD");
        while (text != nullptr && *text != '\0') {
            char* end = nullptr;
            const std::uint64_t frame = std::strtoull(text, &end, 10);
            found[frame] = std::strtod(end + 1, &end);
            text = *end == ',' ? end + 1 : end;
        }
        return found;
    }();
    return all;
}

bool hasLoad() { return !loads().empty(); }

VKAPI_ATTR void VKAPI_CALL resetQueryPool(VkCommandBuffer commands, VkQueryPool pool, std::uint32_t first,
                                          std::uint32_t count) {
    {
        const std::lock_guard lock(g_load_mutex);
        g_recordings[commands] = {pool};
    }
    BINOSPLAT_NEXT(vkCmdResetQueryPool)(commands, pool, first, count);
}

VKAPI_ATTR void VKAPI_CALL beginLabel(VkCommandBuffer commands, const VkDebugUtilsLabelEXT* label) {
    {
        const std::lock_guard lock(g_load_mutex);
        g_recordings[commands].is_in_present = std::strcmp(label->pLabelName, "present") == 0;
    }
    const auto next = BINOSPLAT_NEXT(vkCmdBeginDebugUtilsLabelEXT);
    if (next != nullptr) { next(commands, label); }
}

VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, std::uint32_t x, std::uint32_t y,
                                    std::uint32_t z) {
    {
        const std::lock_guard lock(g_load_mutex);
        Recording& recording = g_recordings[commands];
        if (recording.is_in_present) { recording.groups += std::uint64_t{x} * y * z; }
    }
    BINOSPLAT_NEXT(vkCmdDispatch)(commands, x, y, z);
}

}  // namespace

void beginLoad(double tick_ns) { g_tick_ns = tick_ns; }

PFN_vkVoidFunction loadFunction(const char* name) {
    if (!hasLoad()) { return nullptr; }
    if (std::strcmp(name, "vkCmdResetQueryPool") == 0) { return asVoid(resetQueryPool); }
    if (std::strcmp(name, "vkCmdDispatch") == 0) { return asVoid(dispatch); }
    if (std::strcmp(name, "vkCmdBeginDebugUtilsLabelEXT") == 0) { return asVoid(beginLabel); }
    return nullptr;
}

std::optional<std::uint64_t> ticksOf(VkQueryPool pool) {
    if (!hasLoad()) { return std::nullopt; }
    const std::lock_guard lock(g_load_mutex);
    for (const auto& [commands, recording] : g_recordings) {
        if (recording.timestamps != pool || recording.groups == 0) { continue; }
        if (g_first_groups == 0) { g_first_groups = recording.groups; }
        const auto after = loads().upper_bound(g_frames++);
        if (after == loads().begin()) { return 1; }
        const double share = static_cast<double>(recording.groups) / static_cast<double>(g_first_groups);
        return static_cast<std::uint64_t>(std::llround(share * std::prev(after)->second * 1e6 / g_tick_ns));
    }
    return std::nullopt;
}

}  // namespace binosplat::faults
