// Allocating buffers, and keeping the count of device memory.
#include "engine/gpu/buffer.h"

#include "engine/error.h"

#include <algorithm>

namespace binosplat {

Buffer::Buffer(const Context& context, const std::string& name, std::uint64_t bytes, MemoryKind kind) {
    if (bytes == 0) { return; }
    using Usage = vk::BufferUsageFlagBits;
    using Property = vk::MemoryPropertyFlagBits;
    const vk::Device device = *context.device();
    const std::string what =
        fmt::format("{}: {} needs {:.1f} MiB of device memory", context.deviceName(), name, static_cast<double>(bytes) / 1048576.0);
    check(bytes <= context.maxAllocationBytes(), "{}, one allocation holds at most {:.1f} MiB", what,
          static_cast<double>(context.maxAllocationBytes()) / 1048576.0);
    try {
        const auto usage =
            Usage::eStorageBuffer | Usage::eShaderDeviceAddress | Usage::eIndirectBuffer | Usage::eTransferSrc | Usage::eTransferDst;
        buffer_ = vk::raii::Buffer(
            context.device(),
            vk::BufferCreateInfo({}, bytes, kind == MemoryKind::kDevice ? usage : Usage::eTransferSrc | Usage::eTransferDst));
        const auto needs = buffer_.getMemoryRequirements();
        std::uint32_t type = 0;
        switch (kind) {
            case MemoryKind::kDevice:
                type = context.memoryType(needs.memoryTypeBits, {}, Property::eDeviceLocal);
                break;
            case MemoryKind::kUpload:
                type = context.memoryType(needs.memoryTypeBits, Property::eHostVisible | Property::eHostCoherent, {});
                break;
            case MemoryKind::kReadback:
                type = context.memoryType(needs.memoryTypeBits, Property::eHostVisible | Property::eHostCoherent, Property::eHostCached);
                break;
        }
        const vk::MemoryAllocateFlagsInfo flags(vk::MemoryAllocateFlagBits::eDeviceAddress);
        memory_ = vk::raii::DeviceMemory(context.device(),
                                         vk::MemoryAllocateInfo(needs.size, type, kind == MemoryKind::kDevice ? &flags : nullptr));
        buffer_.bindMemory(*memory_, 0);
        allocated_bytes_ = needs.size;
    } catch (const vk::OutOfDeviceMemoryError&) { fail("{}, which it has not free", what); } catch (const vk::OutOfHostMemoryError&) {
        fail("{}, which it has not free", what);
    }
    context.name(buffer_, name);
    bytes_ = bytes;
    if (kind == MemoryKind::kDevice) {
        address_ = device.getBufferAddress(vk::BufferDeviceAddressInfo(*buffer_), *context.device().getDispatcher());
        use_ = &context.memoryUse();
        use_->current_bytes += allocated_bytes_;
        use_->peak_bytes = std::max(use_->peak_bytes, use_->current_bytes);
    } else {
        mapped_ = memory_.mapMemory(0, VK_WHOLE_SIZE);
    }
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    release();
    buffer_ = std::move(other.buffer_);
    memory_ = std::move(other.memory_);
    use_ = std::exchange(other.use_, nullptr);
    bytes_ = std::exchange(other.bytes_, 0);
    allocated_bytes_ = std::exchange(other.allocated_bytes_, 0);
    address_ = std::exchange(other.address_, 0);
    mapped_ = std::exchange(other.mapped_, nullptr);
    return *this;
}

void Buffer::release() {
    if (use_ != nullptr) { use_->current_bytes -= allocated_bytes_; }
    use_ = nullptr;
    buffer_ = vk::raii::Buffer(nullptr);
    memory_ = vk::raii::DeviceMemory(nullptr);
    bytes_ = allocated_bytes_ = address_ = 0;
    mapped_ = nullptr;
}

}  // namespace binosplat
