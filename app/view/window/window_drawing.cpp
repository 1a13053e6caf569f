// Copies that scale, between images of a window.
#include "app/view/window/window_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace binosplat {

void changeLayout(Commands& commands, vk::Image image, vk::ImageLayout from, vk::ImageLayout to) {
    const auto all = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;
    const vk::ImageMemoryBarrier barrier(all, all, from, to, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED,
                                         image, {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1});
    const auto stage = vk::PipelineStageFlagBits::eAllCommands;
    commands.buffer().pipelineBarrier(stage, stage, {}, {}, {}, barrier);
}

void clearWindow(Commands& commands, vk::Image window) {
    using Layout = vk::ImageLayout;
    changeLayout(commands, window, Layout::eUndefined, Layout::eTransferDstOptimal);
    const vk::ClearColorValue black(std::array<float, 4>{0.0f, 0.0f, 0.0f, 1.0f});
    commands.buffer().clearColorImage(window, Layout::eTransferDstOptimal, black,
                                      vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1));
    changeLayout(commands, window, Layout::eTransferDstOptimal, Layout::eTransferDstOptimal);
}

WindowPart fittedInto(glm::uvec2 from_px, const WindowPart& part) {
    const glm::dvec2 share = glm::dvec2(part.size_px) / glm::dvec2(from_px);
    const glm::ivec2 size_px =
        glm::max(glm::ivec2(std::min(share.x, share.y) * glm::dvec2(from_px)), glm::ivec2(1));
    return {part.at_px + (part.size_px - size_px) / 2, size_px};
}

void blitInto(Commands& commands, vk::Image from, glm::uvec2 from_px, vk::Image window,
              const WindowPart& part, std::uint32_t from_x) {
    if (from_x >= from_px.x) { return; }
    const glm::ivec2 high = part.at_px + part.size_px;
    const double left_px = part.size_px.x * static_cast<double>(from_x) / from_px.x;
    const glm::ivec2 low(std::min(part.at_px.x + static_cast<int>(std::lround(left_px)), high.x - 1),
                         part.at_px.y);
    const vk::ImageSubresourceLayers layers(vk::ImageAspectFlagBits::eColor, 0, 0, 1);
    const std::array source{vk::Offset3D(static_cast<int>(from_x), 0, 0),
                            vk::Offset3D(static_cast<int>(from_px.x), static_cast<int>(from_px.y), 1)};
    const std::array target{vk::Offset3D(low.x, low.y, 0), vk::Offset3D(high.x, high.y, 1)};
    commands.buffer().blitImage(from, vk::ImageLayout::eTransferSrcOptimal, window,
                                vk::ImageLayout::eTransferDstOptimal,
                                vk::ImageBlit(layers, source, layers, target), vk::Filter::eLinear);
}

}  // namespace binosplat
