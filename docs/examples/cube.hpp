// A mesh of the program's own for both examples: its pass clears an image and its depth, and draws a cube.
// Depth is reversed, with the far plane at infinity: near / z.
#pragma once

#include <cube.frag.h>
#include <cube.vert.h>
#include <vulkan/vulkan_raii.hpp>

#include <array>

constexpr float kNear = 0.05f;

// In the middle of the room; `view` is the binosplat camera that looks at it.
inline std::array<float, 16> clipFromCube(const bsp_view& view, const double (&cube)[3], double size) {
    const auto& [w, x, y, z] = view.orientation;
    const double world_from_camera[3][3]{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                                         {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                                         {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    const double l = std::tan(view.left_rad), r = std::tan(view.right_rad), u = std::tan(view.up_rad),
                 d = std::tan(view.down_rad);
    std::array<float, 16> matrix{};  // columns
    for (int column = 0; column < 4; ++column) {
        double
            camera[3]{};  // the cube's axis, or its middle, as the camera has it: x right, y down, z forward
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) {
                const double world = column < 3 ? (k == column ? size : 0.0) : cube[k] - view.position[k];
                camera[i] += world_from_camera[k][i] * world;
            }
        }
        matrix[4 * column + 0] = static_cast<float>((2 * camera[0] - (r + l) * camera[2]) / (r - l));
        matrix[4 * column + 1] = static_cast<float>((2 * camera[1] + (u + d) * camera[2]) / (u - d));
        matrix[4 * column + 2] = column == 3 ? kNear : 0.0f;
        matrix[4 * column + 3] = static_cast<float>(camera[2]);
    }
    return matrix;
}

struct Cube {
    // Both images are left as attachments.
    Cube(const vk::raii::Device& device, vk::Format colour, vk::Format depth) {
        using Layout = vk::ImageLayout;
        const auto attachment = [](vk::Format format, Layout layout) {
            return vk::AttachmentDescription({}, format, vk::SampleCountFlagBits::e1,
                                             vk::AttachmentLoadOp::eClear, vk::AttachmentStoreOp::eStore,
                                             vk::AttachmentLoadOp::eDontCare,
                                             vk::AttachmentStoreOp::eDontCare, Layout::eUndefined, layout);
        };
        const std::array attachments{attachment(colour, Layout::eColorAttachmentOptimal),
                                     attachment(depth, Layout::eDepthStencilAttachmentOptimal)};
        const vk::AttachmentReference colours(0, Layout::eColorAttachmentOptimal),
            depths(1, Layout::eDepthStencilAttachmentOptimal);
        const vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics, {}, colours, {}, &depths);
        const auto stages = vk::PipelineStageFlagBits::eColorAttachmentOutput |
                            vk::PipelineStageFlagBits::eEarlyFragmentTests |
                            vk::PipelineStageFlagBits::eLateFragmentTests;
        const auto writes =
            vk::AccessFlagBits::eColorAttachmentWrite | vk::AccessFlagBits::eDepthStencilAttachmentWrite;
        const vk::SubpassDependency after_others(VK_SUBPASS_EXTERNAL, 0, stages, stages, writes,
                                                 writes | vk::AccessFlagBits::eDepthStencilAttachmentRead);
        pass = {device, vk::RenderPassCreateInfo({}, attachments, subpass, after_others)};

        const vk::PushConstantRange push(vk::ShaderStageFlagBits::eVertex, 0, 64);
        layout = {device, vk::PipelineLayoutCreateInfo({}, {}, push)};
        const vk::raii::ShaderModule vertices(device,
                                              vk::ShaderModuleCreateInfo({}, sizeof(cube_vert), cube_vert));
        const vk::raii::ShaderModule pixels(device,
                                            vk::ShaderModuleCreateInfo({}, sizeof(cube_frag), cube_frag));
        const std::array shaders{
            vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eVertex, *vertices, "main"),
            vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eFragment, *pixels, "main")};
        const vk::PipelineVertexInputStateCreateInfo no_buffers;
        const vk::PipelineInputAssemblyStateCreateInfo triangles({}, vk::PrimitiveTopology::eTriangleList);
        const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
        vk::PipelineRasterizationStateCreateInfo raster;
        raster.lineWidth = 1.0f;
        const vk::PipelineMultisampleStateCreateInfo samples({}, vk::SampleCountFlagBits::e1);
        const vk::PipelineDepthStencilStateCreateInfo nearer({}, VK_TRUE, VK_TRUE, vk::CompareOp::eGreater);
        vk::PipelineColorBlendAttachmentState opaque;
        opaque.colorWriteMask = vk::ColorComponentFlags(0xf);
        const vk::PipelineColorBlendStateCreateInfo blend({}, VK_FALSE, {}, opaque);
        const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
        const vk::PipelineDynamicStateCreateInfo dynamics({}, dynamic);
        pipeline = {
            device, nullptr,
            vk::GraphicsPipelineCreateInfo({}, shaders, &no_buffers, &triangles, nullptr, &viewport, &raster,
                                           &samples, &nearer, &blend, &dynamics, *layout, *pass)};
    }

    void draw(const vk::raii::CommandBuffer& commands, vk::Framebuffer framebuffer, const bsp_view& view,
              const std::array<float, 16>& clip_from_cube) const {
        const vk::Rect2D all({0, 0}, {view.width, view.height});
        const std::array<vk::ClearValue, 2> clears{vk::ClearColorValue(std::array{0.1f, 0.1f, 0.15f, 1.0f}),
                                                   vk::ClearDepthStencilValue(0.0f, 0)};
        commands.beginRenderPass(vk::RenderPassBeginInfo(*pass, framebuffer, all, clears),
                                 vk::SubpassContents::eInline);
        commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
        commands.setViewport(
            0, vk::Viewport(0, 0, static_cast<float>(view.width), static_cast<float>(view.height), 0, 1));
        commands.setScissor(0, all);
        commands.pushConstants<float>(*layout, vk::ShaderStageFlagBits::eVertex, 0, clip_from_cube);
        commands.draw(36, 1, 0, 0);
        commands.endRenderPass();
    }

    vk::raii::RenderPass pass{nullptr};
    vk::raii::PipelineLayout layout{nullptr};
    vk::raii::Pipeline pipeline{nullptr};
};

// A target over what the cube's pass left there.
inline bsp_target overCube(VkImage colour, VkFormat format, VkImage depth) {
    auto target = bsp::make<bsp_target>(BSP_TYPE_TARGET);
    target.colour = colour;
    target.colour_format = format;
    target.colour_before = target.colour_after = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    target.depth = depth;
    target.depth_before = target.depth_after = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    target.depth_scale = kNear;
    target.flags = BSP_TARGET_BLEND | BSP_TARGET_DEPTH_TEST;
    return target;
}
