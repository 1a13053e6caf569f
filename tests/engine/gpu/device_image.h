// An image on the device, of the kind in which pictures are shown, and the way back from it.
#pragma once

#include "tests/engine/gpu/gpu_fixture.h"

namespace binosplat::test {

// Four bytes per pixel.
struct DeviceImage {
    DeviceImage(const Context& context, glm::uvec2 size_px, vk::Format format = kFormat,
                std::uint32_t levels = 1)
        : image(nullptr), memory(nullptr) {
        using Usage = vk::ImageUsageFlagBits;
        image = vk::raii::Image(
            context.device(),
            vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {size_px.x, size_px.y, 1}, levels, 1,
                                vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                                Usage::eTransferDst | Usage::eTransferSrc | Usage::eColorAttachment));
        const auto needs = image.getMemoryRequirements();
        memory = vk::raii::DeviceMemory(
            context.device(),
            vk::MemoryAllocateInfo(needs.size, context.memoryType(needs.memoryTypeBits, {}, {})));
        image.bindMemory(*memory, 0);
    }
    // In the layout of an attachment.
    void copyLevel(const Commands& commands, std::uint32_t level, glm::uvec2 size_px, const Buffer& to,
                   std::uint64_t bytes) const {
        const vk::ImageMemoryBarrier barrier(
            vk::AccessFlagBits::eMemoryWrite, vk::AccessFlagBits::eTransferRead,
            vk::ImageLayout::eColorAttachmentOptimal, vk::ImageLayout::eTransferSrcOptimal,
            VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, *image,
            {vk::ImageAspectFlagBits::eColor, level, 1, 0, 1});
        commands.buffer().pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands,
                                          vk::PipelineStageFlagBits::eTransfer, {}, {}, {}, barrier);
        commands.buffer().copyImageToBuffer(
            *image, vk::ImageLayout::eTransferSrcOptimal, to.handle(),
            vk::BufferImageCopy(bytes, 0, 0, {vk::ImageAspectFlagBits::eColor, level, 0, 1}, {},
                                {size_px.x, size_px.y, 1}));
    }

    static constexpr vk::Format kFormat = vk::Format::eR8G8B8A8Srgb;
    vk::raii::Image image;
    vk::raii::DeviceMemory memory;
};

}  // namespace binosplat::test
