// Buffers that are freed while frames may use them that somebody else submits, so that nobody here could wait for these.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <set>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace binosplat {

// Bytes of device memory in use, and the most there ever were.
struct MemoryUse {
    // Any thread may make and free buffers.
    std::atomic<std::uint64_t> current_bytes = 0, peak_bytes = 0;
};

// For any thread.
class FreedBuffers {
public:
    struct Freed {
        vk::raii::DeviceMemory memory;
        vk::raii::Buffer buffer;
        std::uint64_t counted_bytes;  // in `use`
    };

    explicit FreedBuffers(MemoryUse& use) : use_(use) {}

    // From now on what is freed stays until the frame ends; its number, which is greater than those before.
    [[nodiscard]] std::uint64_t beginFrame();
    // The device is done with it, or will never get it.
    void endFrame(std::uint64_t number);
    void take(Freed freed) noexcept;

private:
    void forget(Freed& freed) noexcept;

    MemoryUse& use_;
    std::mutex mutex_;
    std::uint64_t last_ = 0;
    std::set<std::uint64_t> under_way_;
    std::vector<std::pair<std::uint64_t, Freed>> kept_;  // by the last frame that was begun
};

}  // namespace binosplat
