// Device memory: one allocation per buffer, identified by its address.
#pragma once

#include "engine/gpu/context.h"
#include "shaders/shared/language.h"

#include <cassert>
#include <cstdint>
#include <span>
#include <string>

namespace binosplat {

enum class MemoryKind {
    kDevice,    // the GPU's own
    kUpload,    // written by the host once, read by a copy
    kReadback,  // written by a copy, read by the host
};

// Move-only owner. A buffer of zero bytes owns nothing and has the address 0.
class Buffer {
public:
    Buffer() = default;
    // Throws Error if the device does not have that much memory; the message calls it `name`.
    Buffer(const Context& context, const std::string& name, std::uint64_t bytes,
           MemoryKind kind = MemoryKind::kDevice);
    // A part of `whole`, which must exist for as long. It begins at a multiple of alignmentOf.
    Buffer(const Context& context, const std::string& name, std::uint64_t bytes, const Buffer& whole,
           std::uint64_t offset_bytes);
    static std::uint64_t alignmentOf(const Context& context);
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;
    ~Buffer() { release(); }

    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    // From now on only so many of its bytes count, at most those that it was made with.
    void use(std::uint64_t bytes) {
        assert(bytes <= made_bytes_);
        bytes_ = bytes;
    }
    [[nodiscard]] std::uint64_t madeBytes() const { return made_bytes_; }
    [[nodiscard]] vk::Buffer handle() const { return *buffer_; }
    // The address of an array of T that begins `offset_bytes` into the buffer.
    template <typename T>
    [[nodiscard]] gpu::DeviceAddress<T> address(std::uint64_t offset_bytes = 0) const {
        assert(address_ == 0 || offset_bytes % gpu::kArrayAlignment<T> == 0);
        return {address_ + offset_bytes};
    }
    // Host view of an upload or read-back buffer.
    template <typename T>
    [[nodiscard]] std::span<T> mapped() const {
        return {static_cast<T*>(mapped_), bytes_ / sizeof(T)};
    }

private:
    void release();

    vk::raii::DeviceMemory memory_{nullptr};  // freed after the buffer
    vk::raii::Buffer buffer_{nullptr};
    const Context* context_ = nullptr;
    std::uint64_t bytes_ = 0, made_bytes_ = 0, address_ = 0;
    std::uint64_t counted_bytes_ = 0;  // see MemoryUse
    void* mapped_ = nullptr;
};

}  // namespace binosplat
