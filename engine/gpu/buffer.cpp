// Allocates buffers, and counts device memory.
#include "engine/gpu/buffer.h"

#include "engine/gpu/device_error.h"

#include <algorithm>

namespace binosplat {

namespace {

// From the first of these types whose heap has that much left.
vk::raii::DeviceMemory allocate(const Context& context, const vk::MemoryRequirements& needs,
                                const std::vector<std::uint32_t>& types, bool has_address) {
    const vk::MemoryAllocateFlagsInfo flags(vk::MemoryAllocateFlagBits::eDeviceAddress);
    for (std::size_t i = 0;; ++i) {
        try {
            return {context.device(),
                    vk::MemoryAllocateInfo(needs.size, types[i], has_address ? &flags : nullptr)};
        } catch (const vk::OutOfDeviceMemoryError&) {
            if (i + 1 == types.size()) { throw; }
        }
    }
}

vk::raii::Buffer makeBuffer(const Context& context, std::uint64_t bytes, MemoryKind kind) {
    using Usage = vk::BufferUsageFlagBits;
    const auto copied = Usage::eTransferSrc | Usage::eTransferDst,
               used = Usage::eStorageBuffer | Usage::eShaderDeviceAddress | Usage::eIndirectBuffer | copied;
    return {context.device(), vk::BufferCreateInfo({}, bytes, kind == MemoryKind::kDevice ? used : copied)};
}

std::uint64_t addressOf(const Context& context, const vk::raii::Buffer& buffer) {
    const vk::Device device = *context.device();
    return device.getBufferAddress(vk::BufferDeviceAddressInfo(*buffer), *context.device().getDispatcher());
}

}  // namespace

Buffer::Buffer(const Context& context, const std::string& name, std::uint64_t bytes, const Buffer& whole,
               std::uint64_t offset_bytes)
    : buffer_(makeBuffer(context, bytes, MemoryKind::kDevice)),
      context_(&context),
      bytes_(bytes),
      made_bytes_(bytes) {
    buffer_.bindMemory(*whole.memory_, offset_bytes);
    context.name(buffer_, name);
    address_ = addressOf(context, buffer_);
}

std::uint64_t Buffer::alignmentOf(const Context& context) {
    return makeBuffer(context, 1, MemoryKind::kDevice).getMemoryRequirements().alignment;
}

Buffer::Buffer(const Context& context, const std::string& name, std::uint64_t bytes, MemoryKind kind) {
    if (bytes == 0) { return; }
    using Property = vk::MemoryPropertyFlagBits;
    const auto mebibytes = [](std::uint64_t count) { return static_cast<double>(count) / 1048576.0; };
    const std::string what =
        fmt::format("{}: {} needs {:.1f} MiB of device memory", context.deviceName(), name, mebibytes(bytes));
    const auto refuse = [](const std::string& message) {
        throw DeviceError(DeviceError::Kind::kMemory, message);
    };
    const std::uint64_t most_bytes = context.maxAllocationBytes();
    if (bytes > most_bytes) {
        refuse(fmt::format("{}, one allocation holds at most {:.1f} MiB", what, mebibytes(most_bytes)));
    }
    const std::uint64_t used_bytes = context.memoryUse().current_bytes,
                        limit_bytes = context.memoryLimitBytes();
    const bool fits = kind != MemoryKind::kDevice || limit_bytes == 0 || used_bytes + bytes <= limit_bytes;
    if (!fits) {
        refuse(fmt::format("{} in addition to {:.1f} MiB in use, the limit is {:.1f} MiB (memory-limit)",
                           what, mebibytes(used_bytes), mebibytes(limit_bytes)));
    }
    try {
        buffer_ = makeBuffer(context, bytes, kind);
        const auto needs = buffer_.getMemoryRequirements();
        const bool is_mapped = kind != MemoryKind::kDevice;
        const vk::MemoryPropertyFlags wanted =
            is_mapped ? Property::eHostVisible | Property::eHostCoherent : vk::MemoryPropertyFlags();
        const vk::MemoryPropertyFlags preferred = kind == MemoryKind::kDevice     ? Property::eDeviceLocal
                                                  : kind == MemoryKind::kReadback ? Property::eHostCached
                                                                                  : vk::MemoryPropertyFlags();
        memory_ = allocate(context, needs, context.memoryTypes(needs.memoryTypeBits, wanted, preferred),
                           !is_mapped);
        buffer_.bindMemory(*memory_, 0);
        if (kind == MemoryKind::kDevice) { counted_bytes_ = needs.size; }
    } catch (const vk::OutOfDeviceMemoryError&) {
        refuse(what + ", which is more than it has free");
    } catch (const vk::OutOfHostMemoryError&) { refuse(what + ", which is more than it has free"); }
    context.name(buffer_, name);
    context_ = &context;
    bytes_ = made_bytes_ = bytes;
    if (kind == MemoryKind::kDevice) {
        address_ = addressOf(context, buffer_);
        MemoryUse& use = context.memoryUse();
        const std::uint64_t now = use.current_bytes += counted_bytes_;
        for (std::uint64_t peak = use.peak_bytes;
             peak < now && !use.peak_bytes.compare_exchange_weak(peak, now);) {}
    } else {
        mapped_ = memory_.mapMemory(0, VK_WHOLE_SIZE);
    }
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    release();
    buffer_ = std::move(other.buffer_);
    memory_ = std::move(other.memory_);
    context_ = std::exchange(other.context_, nullptr);
    bytes_ = std::exchange(other.bytes_, 0);
    made_bytes_ = std::exchange(other.made_bytes_, 0);
    counted_bytes_ = std::exchange(other.counted_bytes_, 0);
    address_ = std::exchange(other.address_, 0);
    mapped_ = std::exchange(other.mapped_, nullptr);
    return *this;
}

void Buffer::release() {
    if (context_ != nullptr) {
        context_->freedBuffers().take({std::move(memory_), std::move(buffer_), counted_bytes_});
    }
    context_ = nullptr;
    buffer_ = vk::raii::Buffer(nullptr);
    memory_ = vk::raii::DeviceMemory(nullptr);
    bytes_ = made_bytes_ = counted_bytes_ = address_ = 0;
    mapped_ = nullptr;
}

}  // namespace binosplat
