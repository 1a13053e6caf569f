// When freed buffers are destroyed.
#include "engine/gpu/freed_buffers.h"

#include <utility>

namespace binosplat {

std::uint64_t FreedBuffers::beginFrame() {
    const std::lock_guard lock(mutex_);
    under_way_.insert(++last_);
    return last_;
}

void FreedBuffers::endFrame(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    under_way_.erase(number);
    const std::uint64_t first = under_way_.empty() ? last_ + 1 : *under_way_.begin();
    std::erase_if(kept_, [&](auto& kept) {
        if (kept.first >= first) { return false; }
        forget(kept.second);
        return true;
    });
}

void FreedBuffers::take(Freed freed) noexcept {
    const std::lock_guard lock(mutex_);
    if (under_way_.empty()) {
        forget(freed);
    } else {
        kept_.emplace_back(last_, std::move(freed));
    }
}

void FreedBuffers::forget(Freed& freed) noexcept {
    use_.current_bytes -= freed.counted_bytes;
    freed.buffer = vk::raii::Buffer(nullptr);
    freed.memory = vk::raii::DeviceMemory(nullptr);
}

}  // namespace binosplat
