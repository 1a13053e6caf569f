// Copies, blits and the layouts around them.
#include "xr/images.h"

#include <algorithm>
#include <array>

namespace binosplat {
namespace {

using Layout = vk::ImageLayout;
constexpr auto kColour = vk::ImageAspectFlagBits::eColor;

// Waits for everything before it, and makes everything after it wait.
void changeLayout(const vk::raii::CommandBuffer& commands, vk::Image image, Layout from, Layout to,
                  std::uint32_t level = 0) {
    const auto all = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;
    const auto stage = vk::PipelineStageFlagBits::eAllCommands;
    const vk::ImageMemoryBarrier barrier(all, all, from, to, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED,
                                         image, {kColour, level, 1, 0, 1});
    commands.pipelineBarrier(stage, stage, {}, {}, {}, barrier);
}

void blit(const vk::raii::CommandBuffer& commands, vk::Image from, std::uint32_t from_level,
          glm::uvec2 from_px, vk::Image to, std::uint32_t to_level, glm::uvec2 to_px, vk::Filter filter) {
    const auto box = [](glm::uvec2 size_px) {
        return std::array{vk::Offset3D(0, 0, 0),
                          vk::Offset3D(static_cast<int>(size_px.x), static_cast<int>(size_px.y), 1)};
    };
    commands.blitImage(
        from, Layout::eTransferSrcOptimal, to, Layout::eTransferDstOptimal,
        vk::ImageBlit({kColour, from_level, 0, 1}, box(from_px), {kColour, to_level, 0, 1}, box(to_px)),
        filter);
}

// Leaves `to` as the target of a copy.
void copy(const vk::raii::CommandBuffer& commands, vk::Image from, vk::Image to, glm::uvec2 size_px) {
    changeLayout(commands, to, Layout::eUndefined, Layout::eTransferDstOptimal);
    const vk::ImageSubresourceLayers layers(kColour, 0, 0, 1);
    commands.copyImage(from, Layout::eTransferSrcOptimal, to, Layout::eTransferDstOptimal,
                       vk::ImageCopy(layers, {}, layers, {}, {size_px.x, size_px.y, 1}));
}

}  // namespace

void copyImage(const vk::raii::CommandBuffer& commands, vk::Image from, vk::Image to, glm::uvec2 size_px) {
    copy(commands, from, to, size_px);
    changeLayout(commands, to, Layout::eTransferDstOptimal, Layout::eColorAttachmentOptimal);
}

void copyToTexture(const vk::raii::CommandBuffer& commands, vk::Buffer texels, vk::Image texture,
                   glm::uvec2 size_px) {
    changeLayout(commands, texture, Layout::eShaderReadOnlyOptimal, Layout::eTransferDstOptimal);
    commands.copyBufferToImage(
        texels, texture, Layout::eTransferDstOptimal,
        vk::BufferImageCopy(0, 0, 0, {kColour, 0, 0, 1}, {}, {size_px.x, size_px.y, 1}));
    changeLayout(commands, texture, Layout::eTransferDstOptimal, Layout::eShaderReadOnlyOptimal);
}

void decodeImage(const vk::raii::CommandBuffer& commands, vk::Image from, vk::Image encoded, vk::Image to,
                 glm::uvec2 size_px) {
    copy(commands, from, encoded, size_px);
    changeLayout(commands, encoded, Layout::eTransferDstOptimal, Layout::eTransferSrcOptimal);
    changeLayout(commands, to, Layout::eUndefined, Layout::eTransferDstOptimal);
    blit(commands, encoded, 0, size_px, to, 0, size_px, vk::Filter::eNearest);
    changeLayout(commands, to, Layout::eTransferDstOptimal, Layout::eColorAttachmentOptimal);
}

void clearImage(const vk::raii::CommandBuffer& commands, vk::Image image, const glm::vec4& colour) {
    changeLayout(commands, image, Layout::eUndefined, Layout::eTransferDstOptimal);
    const vk::ClearColorValue value(std::array<float, 4>{colour.r, colour.g, colour.b, colour.a});
    commands.clearColorImage(image, Layout::eTransferDstOptimal, value,
                             vk::ImageSubresourceRange(kColour, 0, 1, 0, 1));
    changeLayout(commands, image, Layout::eTransferDstOptimal, Layout::eColorAttachmentOptimal);
}

void makeMips(const vk::raii::CommandBuffer& commands, vk::Image image, glm::uvec2 size_px,
              std::uint32_t levels) {
    const auto sizeOf = [&](std::uint32_t level) {
        return glm::max(glm::uvec2(size_px.x >> level, size_px.y >> level), 1u);
    };
    for (std::uint32_t level = 1; level < levels; ++level) {
        changeLayout(commands, image, Layout::eColorAttachmentOptimal, Layout::eTransferSrcOptimal,
                     level - 1);
        changeLayout(commands, image, Layout::eUndefined, Layout::eTransferDstOptimal, level);
        blit(commands, image, level - 1, sizeOf(level - 1), image, level, sizeOf(level), vk::Filter::eLinear);
        changeLayout(commands, image, Layout::eTransferSrcOptimal, Layout::eColorAttachmentOptimal,
                     level - 1);
        changeLayout(commands, image, Layout::eTransferDstOptimal, Layout::eColorAttachmentOptimal, level);
    }
}

bool canMakeMips(const Context& context, vk::Format format) {
    using Feature = vk::FormatFeatureFlagBits;
    const auto needs = Feature::eBlitSrc | Feature::eBlitDst | Feature::eSampledImageFilterLinear;
    return (context.physicalDevice().getFormatProperties(format).optimalTilingFeatures & needs) == needs;
}

}  // namespace binosplat
