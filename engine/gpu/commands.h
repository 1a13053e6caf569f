// Recording a frame: one runner writes label, timestamps and barriers for every pass.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/kernel.h"
#include "shaders/shared/types.h"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// The eye or eyes that a pass is for.
enum class Role { kNone, kBoth, kDominant, kAffiliated };

// The name of a pass in reports and in captures of a frame.
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
    // kSecondary: a part of somebody else's commands, see lend.
    enum class Level { kPrimary, kSecondary };
    explicit Commands(const Context& context, Level level = Level::kPrimary);
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;
    // Waits for what is under way.
    ~Commands();

    // begin, any of the recording calls, submit, wait; then totalMs() and, if `times_passes`, times() may be asked for, and begin again.
    void begin(bool times_passes = true);
    // Everything up to the next beginPass counts as this pass.
    void beginPass(const PassLabel& label);
    void endPass();

    // Each waits for everything recorded before it, unless this call says that it runs beside the one before: then neither may write
    // what the other touches.
    void beside() { beside_ = true; }
    template <typename Pass>
    void dispatch(const Kernel& kernel, const Pass& pass, std::uint32_t groups_x, std::uint32_t groups_y = 1, std::uint32_t groups_z = 1) {
        recordKernel(kernel, &pass, sizeof(Pass));
        command_buffer_.dispatch(groups_x, groups_y, groups_z);
    }
    // As many workgroups as the size at `offset_bytes` into `sizes` says.
    template <typename Pass>
    void dispatchIndirect(const Kernel& kernel, const Pass& pass, const Buffer& sizes, std::uint64_t offset_bytes) {
        recordKernel(kernel, &pass, sizeof(Pass));
        command_buffer_.dispatchIndirect(sizes.handle(), offset_bytes);
    }
    // `groups` workgroups in rows of equal length, as lib/list.glsl has it: fewer than there are rows are left over.
    static vk::Extent2D rowsOf(std::uint32_t groups) {
        const std::uint32_t rows = (groups + gpu::kMaxGroupsX - 1) / gpu::kMaxGroupsX;
        return {(groups + rows - 1) / std::max(rows, 1u), rows};
    }
    // One workgroup for every `group_items` of `items`, folded into rows (see groupIndex in the shaders).
    template <typename Pass>
    void dispatchOver(const Kernel& kernel, const Pass& pass, std::uint64_t items, gpu::uint group_items = gpu::kGroupSize) {
        const auto groups = static_cast<std::uint32_t>((items + group_items - 1) / group_items);
        if (groups == 0) { return; }
        const vk::Extent2D rows = rowsOf(groups);
        dispatch(kernel, pass, rows.width, rows.height);
    }
    void fillZero(const Buffer& buffer);
    // Little, carried by the command buffer itself.
    void update(const Buffer& buffer, const void* data, std::uint64_t bytes, std::uint64_t to_offset = 0);
    void copy(const Buffer& from, const Buffer& to, std::uint64_t bytes, std::uint64_t from_offset = 0, std::uint64_t to_offset = 0);
    // The same for several parts, none of which may overlap.
    void copy(const Buffer& from, const Buffer& to, std::span<const vk::BufferCopy> parts);
    // Memory for copies of this recording to read, of at least this many bytes: the host may write to it until submit, and it lives until
    // begin is called again. Once per recording. Throws Error if there is not that much.
    [[nodiscard]] const Buffer& staging(std::uint64_t bytes);

    // A whole image from tightly packed rows, or in one colour. Its contents before do not matter; it is left as an attachment.
    void copyToImage(const Buffer& from, vk::Image image, glm::uvec2 size_px, vk::ImageAspectFlagBits aspect);
    // Instead of submit: nothing of what was recorded is executed. Also after lend, if nobody submits that.
    void drop();

    // Instead of submit, of the second level: what was recorded, for somebody's commands outside of render passes. Once the device is done
    // with these, wait() does not wait, and measures.
    vk::CommandBuffer lend();

    // The device starts; `signals`, if given, is signalled once it is done.
    void submit(vk::Semaphore signals = {});
    // Waits until the device is done, if anything is under way.
    void wait();
    // True once the device is done, for which it waits that long. The measurements are there after wait().
    [[nodiscard]] bool isDone(std::uint64_t most_ns = 0) const;
    void submitAndWait() {
        submit();
        wait();
    }
    [[nodiscard]] bool isUnderWay() const { return under_way_; }

    // For anything that is not a pass: pictures that leave for a headset or a window. Between begin and submit.
    [[nodiscard]] const vk::raii::CommandBuffer& buffer() const { return command_buffer_; }

    // Of the frame that wait() finished; empty if its passes were not timed, or the device has no timestamps.
    [[nodiscard]] const PassTimes& times() const { return times_; }
    [[nodiscard]] double totalMs() const { return total_ms_; }
    // Kernels, fills, updates and copies of buffers since begin.
    [[nodiscard]] std::uint32_t count() const { return count_; }

private:
    void recordKernel(const Kernel& kernel, const void* pass, std::uint32_t bytes);
    // Called before each of them.
    void waitForAll();
    void end();
    void changeLayout(vk::Image image, vk::ImageAspectFlagBits aspect, vk::ImageLayout from, vk::ImageLayout to);
    // Unless only the first and the last are wanted.
    void writeTimestamp(bool is_end_of_frame = false);

    const Context& context_;
    Level level_;
    vk::raii::CommandPool pool_{nullptr};  // its own, so that threads may record at the same time
    vk::raii::CommandBuffer command_buffer_{nullptr};
    vk::raii::Fence fence_{nullptr};
    vk::raii::QueryPool timestamps_{nullptr};
    Buffer staging_;
    std::vector<PassLabel> passes_;
    std::uint32_t timestamp_count_ = 0;
    std::uint32_t count_ = 0;
    bool in_pass_ = false, under_way_ = false, beside_ = false, staged_ = false, times_passes_ = true;
    PassTimes times_;
    double total_ms_ = 0.0;
};

}  // namespace binosplat
