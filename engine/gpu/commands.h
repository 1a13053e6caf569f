// Recording a frame: one runner writes label, timestamps and barriers for every pass.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/contents.h"
#include "engine/gpu/kernel.h"
#include "shaders/shared/types.h"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// Whom a pass is for.
enum class Role { kNone, kBoth, kDominant, kAffiliated };

// What a pass is called in reports and in captures of a frame.
struct PassLabel {
    Role role = Role::kNone;
    FrameStage stage = FrameStage::kSplat;
    std::string pass;

    [[nodiscard]] std::string text() const;  // "dominant rasterize"
    bool operator==(const PassLabel&) const = default;
};

struct PassTime {
    PassLabel label;
    double ms = 0.0;
    bool operator==(const PassTime&) const = default;
};

// In the order of the frame; a pass that ran for both eyes has an entry for each.
using PassTimes = std::vector<PassTime>;

class Commands {
public:
    explicit Commands(const Context& context);
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;
    // Waits for what is under way.
    ~Commands();

    // begin, any of the recording calls, submit, wait; then times() may be asked for, and begin again.
    void begin();
    // Everything up to the next beginPass counts as this pass.
    void beginPass(const PassLabel& label);
    void endPass();

    // Each waits for all that was recorded before it, unless it is said of it that it runs beside the one before: then neither may write
    // what the other touches.
    void beside() { beside_ = true; }
    template <typename Pass>
    void dispatch(const Kernel& kernel, const Pass& pass, std::uint32_t groups_x, std::uint32_t groups_y = 1) {
        recordKernel(kernel, &pass, sizeof(Pass));
        command_buffer_.dispatch(groups_x, groups_y, 1);
    }
    // As many workgroups as `size_bytes_offset` into `sizes` says.
    template <typename Pass>
    void dispatchIndirect(const Kernel& kernel, const Pass& pass, const Buffer& sizes, std::uint64_t offset_bytes) {
        recordKernel(kernel, &pass, sizeof(Pass));
        command_buffer_.dispatchIndirect(sizes.handle(), offset_bytes);
    }
    // A workgroup for every `group_items` of `items`, folded into rows (see groupIndex in the shaders).
    template <typename Pass>
    void dispatchOver(const Kernel& kernel, const Pass& pass, std::uint64_t items, gpu::uint group_items = gpu::kGroupSize) {
        const auto groups = static_cast<std::uint32_t>((items + group_items - 1) / group_items);
        if (groups == 0) { return; }
        dispatch(kernel, pass, std::min(groups, gpu::kMaxGroupsX), (groups + gpu::kMaxGroupsX - 1) / gpu::kMaxGroupsX);
    }
    void fillZero(const Buffer& buffer);
    // At most 64 KiB, carried by the command buffer itself.
    void update(const Buffer& buffer, const void* data, std::uint64_t bytes);
    void copy(const Buffer& from, const Buffer& to, std::uint64_t bytes, std::uint64_t from_offset = 0, std::uint64_t to_offset = 0);
    // Likewise several parts, of which none may lie over another.
    void copy(const Buffer& from, const Buffer& to, std::span<const vk::BufferCopy> parts);
    // Memory for copies of this recording to read, of at least so many bytes: the host's to write until submit, and there until begin is
    // called again. Once a recording. Throws Error if there is not that much.
    [[nodiscard]] const Buffer& staging(std::uint64_t bytes);

    // A whole image out of tightly packed rows, or in one colour. It comes with anything in it and leaves as an attachment.
    void copyToImage(const Buffer& from, vk::Image image, glm::uvec2 size_px, vk::ImageAspectFlagBits aspect);
    // From an image that a copy may read (eTransferSrcOptimal).
    void copyImage(vk::Image from, vk::Image to, glm::uvec2 size_px);
    // Likewise, as light: what `from` holds is sRGB. On the way it lies in `encoded`, an image of the sRGB format with its bytes.
    void decodeImage(vk::Image from, vk::Image encoded, vk::Image to, glm::uvec2 size_px);
    // Smaller copies of what is in level 0 into the others of `levels`, each of the one before. All are attachments before and after.
    void makeMips(vk::Image image, glm::uvec2 size_px, std::uint32_t levels);
    // Whether the device can do that with images of this format.
    [[nodiscard]] static bool canMakeMips(const Context& context, vk::Format format);
    void clearImage(vk::Image image, const glm::vec4& colour);

    // Instead of submit: nothing of what was recorded is done.
    void drop();

    // The device begins; `signals`, where given, is signalled once it is done.
    void submit(vk::Semaphore signals = {});
    // Until the device is done, if anything is under way.
    void wait();
    // The same for who only wants memory back: what was measured is there after wait().
    void waitForDevice() const;
    void submitAndWait() {
        submit();
        wait();
    }
    [[nodiscard]] bool isUnderWay() const { return under_way_; }

    // What the kernel recorded next leaves in memory, or finds there, that serves other purposes before and after. Both give the address
    // back; where asserts are compiled in, one fails if something else came to lie there in between.
    template <typename T>
    gpu::DeviceAddress<T> fills(gpu::DeviceAddress<T> array, std::uint64_t count, Content content) {
#ifndef NDEBUG
        if (array.value != 0) { contents_.fill(array.value, count * sizeof(T), content); }
#endif
        static_cast<void>(count);
        static_cast<void>(content);
        return array;
    }
    template <typename T>
    gpu::DeviceAddress<T> reads(gpu::DeviceAddress<T> array, std::uint64_t count, Content content) const {
        assert(array.value == 0 || contents_.hold(array.value, count * sizeof(T), content));
        static_cast<void>(count);
        static_cast<void>(content);
        return array;
    }

    // For what is not a pass: pictures that leave for a headset or a window. Between begin and submit.
    [[nodiscard]] const vk::raii::CommandBuffer& buffer() const { return command_buffer_; }

    // Of the frame that wait() finished; empty where the device has no timestamps.
    [[nodiscard]] const PassTimes& times() const { return times_; }
    [[nodiscard]] double totalMs() const { return total_ms_; }
    // Kernels, fills, updates and copies of buffers since begin.
    [[nodiscard]] std::uint32_t count() const { return count_; }

private:
    void recordKernel(const Kernel& kernel, const void* pass, std::uint32_t bytes);
    // Before each of them.
    void waitForAll();
    void changeLayout(vk::Image image, vk::ImageAspectFlagBits aspect, vk::ImageLayout from, vk::ImageLayout to);
    void writeTimestamp();

    const Context& context_;
    vk::raii::CommandPool pool_{nullptr};  // its own, so that threads may record at the same time
    vk::raii::CommandBuffer command_buffer_{nullptr};
    vk::raii::Fence fence_{nullptr};
    vk::raii::QueryPool timestamps_{nullptr};
    Buffer staging_;
    Contents contents_;
    std::vector<PassLabel> passes_;
    std::uint32_t timestamp_count_ = 0;
    std::uint32_t count_ = 0;
    bool in_pass_ = false, under_way_ = false, beside_ = false, staged_ = false;
    PassTimes times_;
    double total_ms_ = 0.0;
};

}  // namespace binosplat
