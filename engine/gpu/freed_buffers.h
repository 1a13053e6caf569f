// Buffers that are freed while frames may use them that the program submits, so that nothing here could wait
// for those frames.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <set>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace binosplat {

// Bytes of device memory in use, and the most ever.
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

    // From now on freed buffers stay until the frame ends; returns its number, which is greater than earlier
    // ones.
    [[nodiscard]] std::uint64_t beginFrame();
    // The device has finished the frame, or will never get it.
    void endFrame(std::uint64_t number);
    void take(Freed freed) noexcept;

private:
    void forget(Freed& freed) noexcept;

    MemoryUse& use_;
    std::mutex mutex_;
    std::uint64_t last_ = 0;
    std::set<std::uint64_t> under_way_;
    std::vector<std::pair<std::uint64_t, Freed>> kept_;  // with the number of the last frame begun before
};

}  // namespace binosplat
