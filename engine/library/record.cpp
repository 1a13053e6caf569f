// Frames in a program's own images, recorded into its command buffers or submitted here.
#include "engine/gpu/device_error.h"
#include "engine/library/objects.h"
#include "engine/library/structures.h"

#include <algorithm>

using namespace binosplat;

namespace {

constexpr std::size_t kMostUncollected = 8;

}  // namespace

Submission::Submission(const Context& context)
    : pool(context.device(), vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                                       context.queueFamily())),
      fence(context.device(), vk::FenceCreateInfo()) {
    commands = std::move(vk::raii::CommandBuffers(
        context.device(), vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1))[0]);
}

void bsp_renderer_t::prepare(AskedFrame& asked) {
    begin(asked);
    for (std::size_t p = 0; 2 * p < asked.eyes.size(); ++p) {
        if (!isCut(asked, p)) { continue; }
        FrameSettings settings = settingsOf(asked, p);
        settings.mesh_depths = {MeshDepths{}, MeshDepths{}};  // selects the kernels; nothing is drawn
        part(p).makeKernels(eyesOf(asked, p), settings);
    }
    render(asked, nullptr);
    views_read_ = 0;
    targets_.makeKernels(asked.settings.half_floats);
}

bool bsp_renderer_t::isCut(const AskedFrame& asked, std::size_t index) {
    const std::span<const Eye> eyes = eyesOf(asked, index);
    const auto targets = std::span(asked.targets).subspan(2 * index, eyes.size());
    return (eyes.size() == 1 || rendersBothInFull(asked.settings.mode)) &&
           std::ranges::all_of(targets, [](const bsp_target& target) {
               return (target.flags & (BSP_TARGET_DEPTH_TEST | BSP_TARGET_DEPTH_BY_PIXEL)) ==
                      BSP_TARGET_DEPTH_TEST;
           });
}

std::vector<vk::CommandBuffer> bsp_renderer_t::lend(AskedFrame& asked, Lent& lent) {
    check(lent_.size() < kMostUncollected, "{} frames are recorded and not collected, must be less than {}",
          lent_.size(), kMostUncollected);
    begin(asked);
    lent.share_there = share_there_;
    std::vector<vk::CommandBuffer> commands;
    try {
        for (std::size_t p = 0; 2 * p < asked.eyes.size(); ++p) {
            StereoFrame& frame = part(p);
            const std::span<const Eye> eyes = eyesOf(asked, p);
            const bool is_cut = isCut(asked, p);
            FrameSettings settings = settingsOf(asked, p);
            for (std::size_t e = 0; is_cut && e < eyes.size(); ++e) {
                settings.mesh_depths[e] =
                    targets_.meshDepths(asked.targets[2 * p + e], eyes[e].size_px, 2 * p + e);
            }
            if (is_cut) {
                settings.before = [&](Commands& before) {
                    for (std::size_t e = 0; e < eyes.size(); ++e) {
                        targets_.readDepths(before, asked.targets[2 * p + e], eyes[e].size_px, 2 * p + e);
                    }
                };
            }
            const StereoFrame::Lent its = frame.lend(eyes, settings, [&](Commands& after) {
                for (std::size_t e = 0; e < eyes.size(); ++e) {
                    targets_.record(after, frame.picture(static_cast<int>(e)), asked.targets[2 * p + e],
                                    2 * p + e, is_cut);
                }
            });
            lent.numbers.push_back(its.number);
            commands.push_back(its.commands);
        }
    } catch (...) {
        drop(lent);
        throw;
    }
    return commands;
}

void bsp_renderer_t::drop(Lent& lent) {
    for (std::size_t p = 0; p < lent.numbers.size(); ++p) { parts_[p]->takeBackUnused(lent.numbers[p]); }
    lent.numbers.clear();
}

std::uint64_t bsp_renderer_t::record(AskedFrame& asked, VkCommandBuffer commands) {
    check(commands != VK_NULL_HANDLE, "commands is null");
    Lent lent;
    const std::vector<vk::CommandBuffer> parts = lend(asked, lent);
    vk::CommandBuffer(commands).executeCommands(parts, *device.context.device().getDispatcher());
    lent_.emplace(++last_number_, std::move(lent));
    return last_number_;
}

std::uint64_t bsp_renderer_t::submit(AskedFrame& asked, const bsp_submit_info& info) {
    const Context& context = device.context;
    Lent lent;
    lent.submission = idle_submission_ ? std::move(idle_submission_) : std::make_unique<Submission>(context);
    const std::vector<vk::CommandBuffer> parts = lend(asked, lent);
    try {
        const vk::raii::CommandBuffer& commands = lent.submission->commands;
        commands.reset();
        commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
        commands.executeCommands(parts);
        commands.end();
        const std::uint32_t waits = info.wait != VK_NULL_HANDLE ? 1 : 0,
                            signals = info.signal != VK_NULL_HANDLE ? 1 : 0;
        const bool has_values = info.wait_value != 0 || info.signal_value != 0;
        const vk::TimelineSemaphoreSubmitInfo values(waits, &info.wait_value, signals, &info.signal_value);
        const vk::Semaphore wait(info.wait), signal(info.signal);
        const vk::PipelineStageFlags stage = vk::PipelineStageFlagBits::eAllCommands;
        const vk::CommandBuffer buffer = *commands;
        const vk::SubmitInfo submission(waits, &wait, &stage, 1, &buffer, signals, &signal,
                                        has_values ? &values : nullptr);
        const std::lock_guard lock(context.queueMutex());
        context.queue().submit(submission, *lent.submission->fence);
    } catch (const vk::SystemError& error) {
        drop(lent);
        throw deviceError(context.deviceName(), error);
    }
    lent_.emplace(++last_number_, std::move(lent));
    return last_number_;
}

bool bsp_renderer_t::collect(std::uint64_t number, bsp_frame_result* result) {
    const auto found = lent_.find(number);
    check(found != lent_.end(), "frame {} is none that is recorded and not collected", number);
    if (found->second.submission) {
        const vk::raii::Fence& fence = found->second.submission->fence;
        const vk::Result status = fence.getStatus();
        if (status == vk::Result::eNotReady) { return false; }
        device.context.device().resetFences(*fence);
    }
    Lent lent = std::move(found->second);
    lent_.erase(found);
    for (std::size_t p = 0; p < lent.numbers.size(); ++p) {
        const FrameResult done = parts_[p]->takeBack(lent.numbers[p]);
        if (p == 0 && result != nullptr) { writeStructure(result, resultOf(done, lent.share_there)); }
    }
    if (lent.submission) { idle_submission_ = std::move(lent.submission); }
    return true;
}

void bsp_renderer_t::discard(std::uint64_t number) {
    const auto found = lent_.find(number);
    check(found != lent_.end() && !found->second.submission,
          "frame {} is none that is recorded and not collected", number);
    drop(found->second);
    lent_.erase(found);
}

void bsp_required_device_features(VkPhysicalDeviceVulkan12Features* features) {
    features->bufferDeviceAddress = features->scalarBlockLayout = VK_TRUE;
}

std::uint32_t bsp_required_device_extensions(const char* const** names) {
    if (names != nullptr) { *names = nullptr; }
    return 0;
}

bsp_result bsp_prepare(bsp_renderer renderer, const bsp_frame_info* frame) {
    return guarded([&] {
        check(renderer != nullptr, "renderer is null");
        AskedFrame asked = renderer->ask(readFrame(frame), true);
        renderer->prepare(asked);
        return BSP_SUCCESS;
    });
}

bsp_result bsp_record(bsp_renderer renderer, const bsp_frame_info* frame, VkCommandBuffer commands,
                      std::uint64_t* number) {
    return guarded([&] {
        check(renderer != nullptr && number != nullptr, "{} is null",
              renderer == nullptr ? "renderer" : "number");
        AskedFrame asked = renderer->ask(readFrame(frame), true);
        *number = renderer->record(asked, commands);
        return BSP_SUCCESS;
    });
}

bsp_result bsp_submit(bsp_renderer renderer, const bsp_frame_info* frame, const bsp_submit_info* info,
                      std::uint64_t* number) {
    return guarded([&] {
        check(renderer != nullptr && number != nullptr, "{} is null",
              renderer == nullptr ? "renderer" : "number");
        const auto known =
            info != nullptr ? readStructure(info, BSP_TYPE_SUBMIT_INFO, sizeof(bsp_header), "bsp_submit_info")
                            : bsp_submit_info{};
        AskedFrame asked = renderer->ask(readFrame(frame), true);
        *number = renderer->submit(asked, known);
        return BSP_SUCCESS;
    });
}

bsp_result bsp_collect(bsp_renderer renderer, std::uint64_t number, bsp_frame_result* result) {
    return guarded([&] {
        check(renderer != nullptr, "renderer is null");
        if (result != nullptr) {
            checkHeader(result, BSP_TYPE_FRAME_RESULT, sizeof(bsp_header), "bsp_frame_result");
        }
        return renderer->collect(number, result) ? BSP_SUCCESS : BSP_NOT_READY;
    });
}

bsp_result bsp_discard(bsp_renderer renderer, std::uint64_t number) {
    return guarded([&] {
        check(renderer != nullptr, "renderer is null");
        renderer->discard(number);
        return BSP_SUCCESS;
    });
}
