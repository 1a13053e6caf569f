// A program's own Vulkan device, used as it is and left as it is; and a mutex that also locks the program's
// own.
#pragma once

#include <vulkan/vulkan.h>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

class QueueMutex {
public:
    QueueMutex() = default;
    void shareWith(std::function<void()> lock, std::function<void()> unlock) {
        lock_theirs_ = std::move(lock);
        unlock_theirs_ = std::move(unlock);
    }
    void lock() {
        mutex_.lock();
        if (lock_theirs_) { lock_theirs_(); }
    }
    void unlock() {
        if (unlock_theirs_) { unlock_theirs_(); }
        mutex_.unlock();
    }

private:
    std::mutex mutex_;
    std::function<void()> lock_theirs_, unlock_theirs_;
};

struct ForeignDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    VkQueue queue = VK_NULL_HANDLE;
    const void* enabled_features = nullptr;          // the chain of structs that the device was made with
    std::vector<std::string> enabled_extensions;     // the device's
    std::function<void()> lock_queue, unlock_queue;  // around each use of the queue; may be empty
};

}  // namespace binosplat
