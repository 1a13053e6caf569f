// Copies from and to a program's images, with `present` in between.
#include "engine/library/targets.h"

#include "engine/error.h"
#include "engine/gpu/commands.h"
#include "engine/passes/present.h"

#include <cmath>

namespace binosplat {
namespace {

using Layout = vk::ImageLayout;

bool isFloats(VkFormat format) {
    return format == VK_FORMAT_R32G32B32A32_SFLOAT || format == VK_FORMAT_R16G16B16A16_SFLOAT;
}

struct Part {
    vk::Image image;
    vk::ImageAspectFlagBits aspect;
    std::uint32_t layer;
    glm::uvec2 size_px;

    // Waits for everything before it, and makes everything after it wait.
    void change(Commands& commands, Layout from, Layout to) const {
        const auto all = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;
        const auto stage = vk::PipelineStageFlagBits::eAllCommands;
        const vk::MemoryBarrier of_buffers(all, all);
        const vk::ImageMemoryBarrier of_image(all, all, from, to, VK_QUEUE_FAMILY_IGNORED,
                                              VK_QUEUE_FAMILY_IGNORED, image, {aspect, 0, 1, layer, 1});
        commands.buffer().pipelineBarrier(stage, stage, {}, of_buffers, {}, of_image);
    }
    [[nodiscard]] vk::BufferImageCopy region() const {
        return {0, 0, 0, {aspect, 0, layer, 1}, {}, {size_px.x, size_px.y, 1}};
    }
    void read(Commands& commands, Layout before, const Buffer& to) const {
        change(commands, before, Layout::eTransferSrcOptimal);
        commands.buffer().copyImageToBuffer(image, Layout::eTransferSrcOptimal, to.handle(), region());
    }
    void write(Commands& commands, Layout before, const Buffer& from, Layout after) const {
        change(commands, before, Layout::eTransferDstOptimal);
        commands.buffer().copyBufferToImage(from.handle(), image, Layout::eTransferDstOptimal, region());
        change(commands, Layout::eTransferDstOptimal, after);
    }
};

void growTo(Buffer& buffer, const Context& context, const char* name, glm::uvec2 size_px) {
    const std::uint64_t bytes = std::uint64_t{4} * size_px.x * size_px.y;
    if (buffer.bytes() < bytes) { buffer = Buffer(context, name, bytes); }
}

}  // namespace

void checkTarget(const bsp_target& target, bool half_floats, bool has_background) {
    const bool blends = (target.flags & BSP_TARGET_BLEND) != 0,
               tests = (target.flags & BSP_TARGET_DEPTH_TEST) != 0;
    const auto format = static_cast<vk::Format>(target.colour_format);
    check(target.colour != VK_NULL_HANDLE, "colour of a bsp_target is null");
    const bool floats_fit =
        target.colour_format == (half_floats ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT);
    check(Presenter::takes(format) || (floats_fit && !blends),
          "colour_format of a bsp_target is {}{}, must be one that its comment names", vk::to_string(format),
          blends        ? ", to be blended over"
          : half_floats ? " for half floats"
                        : "");
    check(target.colour_after != VK_IMAGE_LAYOUT_UNDEFINED &&
              (target.depth == VK_NULL_HANDLE || target.depth_after != VK_IMAGE_LAYOUT_UNDEFINED),
          "a layout after of a bsp_target is UNDEFINED, must be another");
    check(!blends || target.colour_before != VK_IMAGE_LAYOUT_UNDEFINED,
          "colour_before of a bsp_target to be blended over is UNDEFINED");
    check(!blends || !has_background, "background of a frame to be blended over is not 0");
    check(!tests ||
              (blends && target.depth != VK_NULL_HANDLE && target.depth_before != VK_IMAGE_LAYOUT_UNDEFINED),
          "BSP_TARGET_DEPTH_TEST needs BSP_TARGET_BLEND, a depth and its layout before");
    check(
        target.depth == VK_NULL_HANDLE || (std::isfinite(target.depth_scale) && target.depth_scale != 0.0f &&
                                           std::isfinite(target.depth_offset)),
        "depth_scale of a bsp_target is {}, must not be 0", target.depth_scale);
}

TargetImages::TargetImages(const Context& context) : context_(context), kernels_(context, presentKernels()) {}

Buffer& TargetImages::depthsOf(std::size_t view, glm::uvec2 size_px) {
    growTo(depths_[view], context_, "a program's depths", size_px);
    return depths_[view];
}

MeshDepths TargetImages::meshDepths(const bsp_target& target, glm::uvec2 size_px, std::size_t view) {
    return {depthsOf(view, size_px).address<float>(), target.depth_scale, target.depth_offset};
}

void TargetImages::readDepths(Commands& commands, const bsp_target& target, glm::uvec2 size_px,
                              std::size_t view) {
    const Part depth{target.depth, vk::ImageAspectFlagBits::eDepth, target.layer, size_px};
    depth.read(commands, static_cast<Layout>(target.depth_before), depthsOf(view, size_px));
}

void TargetImages::record(Commands& commands, const Picture& picture, const bsp_target& target,
                          std::size_t view, bool is_cut) {
    const Part colour{target.colour, vk::ImageAspectFlagBits::eColor, target.layer, picture.size_px};
    const Part depth{target.depth, vk::ImageAspectFlagBits::eDepth, target.layer, picture.size_px};
    const bool is_floats = isFloats(target.colour_format), blends = (target.flags & BSP_TARGET_BLEND) != 0,
               tests = (target.flags & BSP_TARGET_DEPTH_TEST) != 0,
               has_depth = target.depth != VK_NULL_HANDLE;
    commands.beginPass({Role::kNone, PresentKernel::kStage, PresentKernel::kShader});
    if (!is_floats || has_depth) {
        growTo(pixels_, context_, "a program's pixels", picture.size_px);
        if (blends) { colour.read(commands, static_cast<Layout>(target.colour_before), pixels_); }
        if (tests && !is_cut) { readDepths(commands, target, picture.size_px, view); }
        gpu::PresentPass pass{};
        pass.colours = picture.colours.address<gpu::vec4>();
        pass.half_colours = picture.colours.address<gpu::uvec2>();
        pass.depths = picture.depths.address<float>();
        pass.words = picture.words.address<gpu::uint>();
        pass.of_surface = picture.of_surface ? 1 : 0;
        pass.pixels = pixels_.address<gpu::uint>();
        if (has_depth) { pass.device_depths = depthsOf(view, picture.size_px).address<float>(); }
        if (tests) { pass.mesh_depths = pass.device_depths; }
        pass.size_px = picture.size_px;
        pass.depth_scale = target.depth_scale;
        pass.depth_offset = target.depth_offset;
        const VkFormat format = target.colour_format;
        pass.blue_first = format == VK_FORMAT_B8G8R8A8_SRGB || format == VK_FORMAT_B8G8R8A8_UNORM ? 1 : 0;
        const bool is_srgb = format == VK_FORMAT_R8G8B8A8_SRGB || format == VK_FORMAT_B8G8R8A8_SRGB;
        pass.linear = !is_srgb && (target.flags & BSP_TARGET_LIGHT) != 0 ? 1 : 0;
        pass.over = blends ? 1 : 0;
        pass.is_cut = is_cut ? 1 : 0;
        commands.dispatch(kernels_.get(PresentKernel{.half_colours = picture.half_floats}), pass,
                          (picture.size_px.x + 15) / 16, (picture.size_px.y + 7) / 8);
    }
    colour.write(commands, blends ? Layout::eTransferSrcOptimal : Layout::eUndefined,
                 is_floats ? picture.colours : pixels_, static_cast<Layout>(target.colour_after));
    if (has_depth) {
        depth.write(commands, tests ? Layout::eTransferSrcOptimal : Layout::eUndefined, depths_[view],
                    static_cast<Layout>(target.depth_after));
    }
    commands.endPass();
}

}  // namespace binosplat
