// Barriers, timestamps and labels, in one place.
#include "engine/gpu/commands.h"

#include "engine/gpu/device_error.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace binosplat {
namespace {

constexpr std::uint32_t kMaxTimestamps = 256;

}  // namespace

std::string PassLabel::text() const {
    constexpr std::array<const char*, 4> kRoles{"", "both ", "dominant ", "affiliated "};
    return kRoles[static_cast<std::size_t>(role)] + pass;
}

Commands::Commands(const Context& context, Level level) : context_(context), level_(level) {
    const bool is_whole = level == Level::kPrimary;
    pool_ = context.device().createCommandPool(
        {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, context.queueFamily()});
    vk::raii::CommandBuffers buffers(
        context.device(),
        vk::CommandBufferAllocateInfo(
            *pool_, is_whole ? vk::CommandBufferLevel::ePrimary : vk::CommandBufferLevel::eSecondary, 1));
    command_buffer_ = std::move(buffers[0]);
    fence_ = context.device().createFence({});
    if (context.timestampPeriodNs() > 0.0) {
        timestamps_ = context.device().createQueryPool(
            vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, kMaxTimestamps));
    }
}

Commands::~Commands() {
    if (!under_way_ || level_ == Level::kSecondary) { return; }
    // A lost device has nothing left to finish.
    const vk::Fence fence = *fence_;
    (void)context_.device().getDispatcher()->vkWaitForFences(
        *context_.device(), 1, reinterpret_cast<const VkFence*>(&fence), VK_TRUE, UINT64_MAX);
}

void Commands::begin(bool times_passes) {
    assert(!under_way_);
    times_passes_ = times_passes;
    in_pass_ = beside_ = staged_ = false;  // from the dropped recording
    passes_.clear();
    timestamp_count_ = 0;
    count_ = 0;
    command_buffer_.reset();
    const vk::CommandBufferInheritanceInfo outside_of_render_passes;
    command_buffer_.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit,
                                                     &outside_of_render_passes));
    if (*timestamps_) { command_buffer_.resetQueryPool(*timestamps_, 0, kMaxTimestamps); }
}

void Commands::writeTimestamp(bool is_end_of_frame) {
    if (!times_passes_ && timestamp_count_ > 0 && !is_end_of_frame) { return; }
    assert(timestamp_count_ < kMaxTimestamps);
    if (*timestamps_) {
        command_buffer_.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *timestamps_,
                                       timestamp_count_);
    }
    ++timestamp_count_;
}

void Commands::beginPass(const PassLabel& label) {
    endPass();
    if (context_.hasLabels()) {
        command_buffer_.beginDebugUtilsLabelEXT(vk::DebugUtilsLabelEXT(label.text().c_str()));
    }
    passes_.push_back(label);
    writeTimestamp();
    in_pass_ = true;
}

void Commands::endPass() {
    if (!in_pass_) { return; }
    writeTimestamp();
    if (context_.hasLabels()) { command_buffer_.endDebugUtilsLabelEXT(); }
    in_pass_ = false;
}

void Commands::waitForAll() {
    ++count_;
    if (std::exchange(beside_, false)) { return; }
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    const vk::MemoryBarrier barrier(Access::eShaderWrite | Access::eTransferWrite,
                                    Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead |
                                        Access::eTransferWrite | Access::eIndirectCommandRead);
    command_buffer_.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer,
                                    Stage::eComputeShader | Stage::eTransfer | Stage::eDrawIndirect, {},
                                    barrier, {}, {});
}

void Commands::recordKernel(const Kernel& kernel, const void* pass, std::uint32_t bytes) {
    assert(bytes == kernel.pushBytes());
    waitForAll();
    command_buffer_.bindPipeline(vk::PipelineBindPoint::eCompute, kernel.pipeline());
    command_buffer_.pushConstants<std::uint8_t>(kernel.layout(), vk::ShaderStageFlagBits::eCompute, 0,
                                                {bytes, static_cast<const std::uint8_t*>(pass)});
}

void Commands::fillZero(const Buffer& buffer) {
    if (buffer.bytes() == 0) { return; }
    waitForAll();
    command_buffer_.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 0);
}

void Commands::update(const Buffer& buffer, const void* data, std::uint64_t bytes, std::uint64_t to_offset) {
    assert(bytes % 4 == 0);
    constexpr std::uint64_t kMostBytes = 65536;  // of one command
    waitForAll();
    for (std::uint64_t from = 0; from < bytes; from += kMostBytes) {
        command_buffer_.updateBuffer<std::uint8_t>(
            buffer.handle(), to_offset + from,
            {static_cast<std::uint32_t>(std::min(bytes - from, kMostBytes)),
             static_cast<const std::uint8_t*>(data) + from});
    }
}

void Commands::copy(const Buffer& from, const Buffer& to, std::uint64_t bytes, std::uint64_t from_offset,
                    std::uint64_t to_offset) {
    if (bytes == 0) { return; }
    waitForAll();
    command_buffer_.copyBuffer(from.handle(), to.handle(), vk::BufferCopy(from_offset, to_offset, bytes));
}

void Commands::copy(const Buffer& from, const Buffer& to, std::span<const vk::BufferCopy> parts) {
    if (parts.empty()) { return; }
    waitForAll();
    command_buffer_.copyBuffer(from.handle(), to.handle(),
                               vk::ArrayProxy(static_cast<std::uint32_t>(parts.size()), parts.data()));
}

const Buffer& Commands::staging(std::uint64_t bytes) {
    assert(!staged_ && !under_way_);
    staged_ = true;
    reserveStaging(bytes);
    return staging_;
}

void Commands::reserveStaging(std::uint64_t bytes) {
    if (staging_.bytes() >= bytes) { return; }
    staging_ = {};
    constexpr std::uint64_t kStep = 1 << 20;  // large, so that it seldom grows
    const std::uint64_t rounded =
        std::min((bytes + kStep - 1) / kStep * kStep, std::max(bytes, context_.maxAllocationBytes()));
    staging_ = Buffer(context_, "staging", rounded, MemoryKind::kUpload);
}

void Commands::changeLayout(vk::Image image, vk::ImageAspectFlagBits aspect, vk::ImageLayout from,
                            vk::ImageLayout to) {
    using Access = vk::AccessFlagBits;
    const bool enters = to == vk::ImageLayout::eTransferDstOptimal;
    const auto all = Access::eMemoryRead | Access::eMemoryWrite;
    const vk::ImageMemoryBarrier barrier(
        enters ? vk::AccessFlags(all) : Access::eTransferWrite, enters ? Access::eTransferWrite : all, from,
        to, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, image, {aspect, 0, 1, 0, 1});
    const auto outside = vk::PipelineStageFlagBits::eAllCommands,
               inside = vk::PipelineStageFlagBits::eTransfer;
    command_buffer_.pipelineBarrier(enters ? outside : inside, enters ? inside : outside, {}, {}, {},
                                    barrier);
}

void Commands::copyToImage(const Buffer& from, vk::Image image, glm::uvec2 size_px,
                           vk::ImageAspectFlagBits aspect) {
    using Layout = vk::ImageLayout;
    waitForAll();
    changeLayout(image, aspect, Layout::eUndefined, Layout::eTransferDstOptimal);
    const vk::BufferImageCopy region(0, 0, 0, {aspect, 0, 0, 1}, {}, {size_px.x, size_px.y, 1});
    command_buffer_.copyBufferToImage(from.handle(), image, Layout::eTransferDstOptimal, region);
    changeLayout(image, aspect, Layout::eTransferDstOptimal,
                 aspect == vk::ImageAspectFlagBits::eDepth ? Layout::eDepthStencilAttachmentOptimal
                                                           : Layout::eColorAttachmentOptimal);
}

void Commands::drop() {
    if (std::exchange(under_way_, false)) { return; }
    endPass();
    command_buffer_.end();
}

void Commands::end() {
    endPass();
    if (!times_passes_ && timestamp_count_ > 0) { writeTimestamp(true); }
    const vk::MemoryBarrier to_host(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead);
    command_buffer_.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost,
                                    {}, to_host, {}, {});
    command_buffer_.end();
}

vk::CommandBuffer Commands::lend() {
    assert(level_ == Level::kSecondary);
    end();
    under_way_ = true;
    return *command_buffer_;
}

void Commands::submit(vk::Semaphore signals) {
    end();
    const vk::CommandBuffer commands = *command_buffer_;
    const auto signalled = signals ? vk::ArrayProxyNoTemporaries<const vk::Semaphore>(signals) : nullptr;
    try {
        const std::lock_guard lock(context_.queueMutex());
        context_.queue().submit(vk::SubmitInfo({}, {}, commands, signalled), *fence_);
    } catch (const vk::SystemError& error) { throw deviceError(context_.deviceName(), error); }
    under_way_ = true;
}

bool Commands::isDone(std::uint64_t most_ns) const {
    if (!under_way_ || level_ == Level::kSecondary) { return true; }
    try {
        return context_.device().waitForFences(*fence_, VK_TRUE, most_ns) == vk::Result::eSuccess;
    } catch (const vk::SystemError& error) { throw deviceError(context_.deviceName(), error); }
}

void Commands::wait() {
    if (!under_way_) { return; }
    check(isDone(UINT64_MAX), "{}: the frame did not finish", context_.deviceName());
    under_way_ = false;
    if (level_ == Level::kPrimary) { context_.device().resetFences(*fence_); }

    times_.clear();
    total_ms_ = 0.0;
    if (!*timestamps_ || timestamp_count_ == 0) { return; }
    using Flag = vk::QueryResultFlagBits;
    const auto [status, ticks] = timestamps_.getResults<std::uint64_t>(
        0, timestamp_count_, timestamp_count_ * sizeof(std::uint64_t), sizeof(std::uint64_t),
        level_ == Level::kPrimary ? Flag::e64 | Flag::eWait : Flag::e64);
    if (status == vk::Result::eNotReady) { return; }  // the caller said that it was done too early
    check(status == vk::Result::eSuccess, "{}: no timestamps: {}", context_.deviceName(),
          vk::to_string(status));
    const std::uint64_t mask = context_.timestampMask();
    const double ms_per_tick = context_.timestampPeriodNs() * 1e-6;
    for (std::size_t i = 0; times_passes_ && i < passes_.size(); ++i) {
        times_.push_back(
            {passes_[i], static_cast<double>((ticks[2 * i + 1] - ticks[2 * i]) & mask) * ms_per_tick});
    }
    total_ms_ = static_cast<double>((ticks.back() - ticks.front()) & mask) * ms_per_tick;
}

}  // namespace binosplat
