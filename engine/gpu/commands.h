// Records a frame: one place writes labels, timestamps and barriers for every pass.
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
    // kSecondary: part of a program's own commands, see lend.
    enum class Level { kPrimary, kSecondary };
    explicit Commands(const Context& context, Level level = Level::kPrimary);
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;
    // Waits for work in flight.
    ~Commands();

    // Call begin, recording calls, submit, wait; then totalMs() and, if `times_passes`, times() are valid
    // until the next begin.
    void begin(bool times_passes = true);
    // Everything up to the next beginPass counts as this pass.
    void beginPass(const PassLabel& label);
    void endPass();

    // Each waits for everything recorded before it, unless this call says that it runs beside the one before:
    // then neither may write what the other touches.
    void beside() { beside_ = true; }
    template <typename Pass>
    void dispatch(const Kernel& kernel, const Pass& pass, std::uint32_t groups_x, std::uint32_t groups_y = 1,
                  std::uint32_t groups_z = 1) {
        recordKernel(kernel, &pass, sizeof(Pass));
        command_buffer_.dispatch(groups_x, groups_y, groups_z);
    }
    // As many workgroups as the size at `offset_bytes` in `sizes` says.
    template <typename Pass>
    void dispatchIndirect(const Kernel& kernel, const Pass& pass, const Buffer& sizes,
                          std::uint64_t offset_bytes) {
        recordKernel(kernel, &pass, sizeof(Pass));
        command_buffer_.dispatchIndirect(sizes.handle(), offset_bytes);
    }
    // `groups` workgroups in rows of equal length, as in lib/list.glsl: at most one row's worth does nothing.
    static vk::Extent2D rowsOf(std::uint32_t groups) {
        const std::uint32_t rows = (groups + gpu::kMaxGroupsX - 1) / gpu::kMaxGroupsX;
        return {(groups + rows - 1) / std::max(rows, 1u), rows};
    }
    // One workgroup for every `group_items` of `items`, folded into rows (see groupIndex in the shaders).
    template <typename Pass>
    void dispatchOver(const Kernel& kernel, const Pass& pass, std::uint64_t items,
                      gpu::uint group_items = gpu::kGroupSize) {
        const auto groups = static_cast<std::uint32_t>((items + group_items - 1) / group_items);
        if (groups == 0) { return; }
        const vk::Extent2D rows = rowsOf(groups);
        dispatch(kernel, pass, rows.width, rows.height);
    }
    void fillZero(const Buffer& buffer);
    // A few bytes, carried by the command buffer itself.
    void update(const Buffer& buffer, const void* data, std::uint64_t bytes, std::uint64_t to_offset = 0);
    void copy(const Buffer& from, const Buffer& to, std::uint64_t bytes, std::uint64_t from_offset = 0,
              std::uint64_t to_offset = 0);
    // The same for several parts, none of which may overlap.
    void copy(const Buffer& from, const Buffer& to, std::span<const vk::BufferCopy> parts);
    // Memory from which copies of this recording read, at least this many bytes: the host may write to it
    // until submit, and it exists until the next begin. Once per recording. Throws Error if there is not
    // enough memory.
    [[nodiscard]] const Buffer& staging(std::uint64_t bytes);
    // That much memory is there already when a recording asks for it.
    void reserveStaging(std::uint64_t bytes);
    [[nodiscard]] std::uint64_t stagingBytes() const { return staging_.bytes(); }

    // A whole image from tightly packed rows, or in one colour. Its old content is lost; it is left as an
    // attachment.
    void copyToImage(const Buffer& from, vk::Image image, glm::uvec2 size_px, vk::ImageAspectFlagBits aspect);
    // Call this instead of submit to execute nothing of what was recorded; also after lend, if nobody submits
    // that.
    void drop();

    // Call this instead of submit, for a secondary buffer: what was recorded, for a program's commands
    // outside of render passes. Once the device has finished these, wait() returns at once, with the
    // measurements.
    vk::CommandBuffer lend();

    // Starts the device; `signals`, if given, is signalled at the end.
    void submit(vk::Semaphore signals = {});
    // Waits for work in flight, if there is any.
    void wait();
    // True once the device is done; waits this long for it. The measurements are valid after wait().
    [[nodiscard]] bool isDone(std::uint64_t most_ns = 0) const;
    void submitAndWait() {
        submit();
        wait();
    }
    [[nodiscard]] bool isUnderWay() const { return under_way_; }

    // For anything that is not a pass: pictures for a headset or a window. Between begin and submit.
    [[nodiscard]] const vk::raii::CommandBuffer& buffer() const { return command_buffer_; }

    // For the frame that wait() finished; empty if its passes were not timed, or the device has no
    // timestamps.
    [[nodiscard]] const PassTimes& times() const { return times_; }
    [[nodiscard]] double totalMs() const { return total_ms_; }
    // Kernels, fills, updates and copies of buffers since begin.
    [[nodiscard]] std::uint32_t count() const { return count_; }

private:
    void recordKernel(const Kernel& kernel, const void* pass, std::uint32_t bytes);
    // Called before each of them.
    void waitForAll();
    void end();
    void changeLayout(vk::Image image, vk::ImageAspectFlagBits aspect, vk::ImageLayout from,
                      vk::ImageLayout to);
    // Unless only the first and the last are wanted.
    void writeTimestamp(bool is_end_of_frame = false);

    const Context& context_;
    Level level_;
    vk::raii::CommandPool pool_{nullptr};  // a pool of its own, so that threads may record at the same time
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
