// A Vulkan program of its own: an instance under the validation layers, a device, a picture and its depth.
#pragma once

#include "tests/engine/library/library_runs.h"

#include <binosplat_vulkan.h>
#include <vulkan/vulkan_raii.hpp>

namespace binosplat::test {

class ForeignProgram {
public:
    static constexpr glm::uvec2 kSize{64, 48};

    struct Image {
        vk::Format format;
        vk::ImageLayout layout;  // when it is read
        vk::ImageAspectFlagBits aspect;
        vk::raii::Image image;
        vk::raii::DeviceMemory memory;
        vk::raii::ImageView view;
    };

    // Without `has_features` the device lacks what the library needs.
    explicit ForeignProgram(bool has_features = true) {
        const vk::ApplicationInfo application("somebody", 1, "else", 1, VK_API_VERSION_1_2);
        const auto synchronization = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
        const vk::ValidationFeaturesEXT checks(synchronization);
        const char* const layer = "VK_LAYER_KHRONOS_validation";
        const std::string_view of_checks = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
        std::vector<const char*> extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
        // A layer that is configured by a file lacks this extension.
        const bool has_checks = std::ranges::any_of(
            loader.enumerateInstanceExtensionProperties(std::string(layer)),
            [&](const auto& extension) { return extension.extensionName.data() == of_checks; });
        if (has_checks) { extensions.push_back(of_checks.data()); }
        instance = {loader, vk::InstanceCreateInfo({}, &application, layer, extensions,
                                                   has_checks ? &checks : nullptr)};
        using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
        messenger = {instance, vk::DebugUtilsMessengerCreateInfoEXT(
                                   {}, Severity::eWarning | Severity::eError,
                                   vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation, onMessage, this)};
        physical = std::move(vk::raii::PhysicalDevices(instance).at(0));
        if (has_features) {
            bsp_required_device_features(&static_cast<VkPhysicalDeviceVulkan12Features&>(features_));
        }
        const float priority = 1.0f;
        const vk::DeviceQueueCreateInfo queue_info({}, 0, 1, &priority);
        device = {physical, vk::DeviceCreateInfo({}, queue_info, {}, {}, nullptr, &features_)};
        queue = device.getQueue(0, 0);
        pool = {device, vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient, 0)};
        using Layout = vk::ImageLayout;
        using Usage = vk::ImageUsageFlagBits;
        colour =
            makeImage(vk::Format::eR8G8B8A8Unorm, Layout::eColorAttachmentOptimal, Usage::eColorAttachment);
        depth = makeImage(vk::Format::eD32Sfloat, Layout::eDepthStencilAttachmentOptimal,
                          Usage::eDepthStencilAttachment, vk::ImageAspectFlagBits::eDepth);
        floats =
            makeImage(vk::Format::eR32G32B32A32Sfloat, Layout::eTransferDstOptimal, Usage::eColorAttachment);
        makePasses();
    }
    ForeignProgram(const ForeignProgram&) = delete;
    ~ForeignProgram() {
        device.waitIdle();
        CHECK(messages == std::vector<std::string>());
    }

    [[nodiscard]] bsp::Device open() {
        auto own = bsp::make<bsp_vulkan_device>(BSP_TYPE_VULKAN_DEVICE);
        own.instance = *instance;
        own.physical_device = *physical;
        own.device = *device;
        own.queue = *queue;
        own.enabled_features = &features_;
        own.lock_queue = [](void* mutex) { static_cast<std::mutex*>(mutex)->lock(); };
        own.unlock_queue = [](void* mutex) { static_cast<std::mutex*>(mutex)->unlock(); };
        own.queue_user = &queue_mutex;
        auto info = bsp::make<bsp_device_info>(BSP_TYPE_DEVICE_INFO);
        info.next = &own;
        return bsp::Device(info);
    }
    // Clears colour and depth, and draws a wall over the left half: red, at the stored depth. Afterwards the
    // image is in the layout of an attachment.
    void drawWall(const vk::raii::CommandBuffer& commands, float wall_depth) const {
        const std::array<vk::ClearValue, 2> clears{vk::ClearColorValue(std::array{0.2f, 0.4f, 0.6f, 1.0f}),
                                                   vk::ClearDepthStencilValue(0.0f, 0)};
        commands.beginRenderPass(vk::RenderPassBeginInfo(*wall_, *of_wall_, all_, clears),
                                 vk::SubpassContents::eInline);
        const vk::ClearRect left({{0, 0}, {kSize.x / 2, kSize.y}}, 0, 1);
        commands.clearAttachments(
            {{vk::ImageAspectFlagBits::eColor, 0, vk::ClearColorValue(std::array{1.0f, 0.0f, 0.0f, 1.0f})},
             {vk::ImageAspectFlagBits::eDepth, 0, vk::ClearDepthStencilValue(wall_depth, 0)}},
            left);
        commands.endRenderPass();
    }
    // Draws a white square in the corner, over the existing picture.
    void drawSign(const vk::raii::CommandBuffer& commands) const {
        commands.beginRenderPass(vk::RenderPassBeginInfo(*sign_, *of_sign_, all_),
                                 vk::SubpassContents::eInline);
        const vk::ClearAttachment white(vk::ImageAspectFlagBits::eColor, 0,
                                        vk::ClearColorValue(std::array{1.0f, 1.0f, 1.0f, 1.0f}));
        commands.clearAttachments(white, vk::ClearRect({{0, 0}, {4, 4}}, 0, 1));
        commands.endRenderPass();
    }

    [[nodiscard]] vk::raii::CommandBuffer begin() const {
        vk::raii::CommandBuffer commands = std::move(vk::raii::CommandBuffers(
            device, vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1))[0]);
        commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
        return commands;
    }
    void submit(const vk::raii::CommandBuffer& commands, const vk::raii::Fence& fence) const {
        commands.end();
        const vk::CommandBuffer buffer = *commands;
        const std::lock_guard lock(queue_mutex);
        queue.submit(vk::SubmitInfo({}, {}, buffer), *fence);
    }
    // Submits, and waits until it is done.
    void finish(const vk::raii::CommandBuffer& commands) const {
        const vk::raii::Fence fence(device, vk::FenceCreateInfo());
        submit(commands, fence);
        (void)device.waitForFences(*fence, VK_TRUE, UINT64_MAX);
    }

    // All values of an image, `channels` to a pixel; waits for the device.
    template <typename T>
    [[nodiscard]] std::vector<T> read(const std::optional<Image>& from, std::size_t channels) const {
        std::vector<T> values(channels * kSize.x * kSize.y);
        const std::size_t bytes = values.size() * sizeof(T);
        const vk::raii::Buffer buffer(device,
                                      vk::BufferCreateInfo({}, bytes, vk::BufferUsageFlagBits::eTransferDst));
        const vk::raii::DeviceMemory memory =
            allocate(buffer.getMemoryRequirements(),
                     vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
        buffer.bindMemory(*memory, 0);
        const vk::raii::CommandBuffer commands = begin();
        const auto all = vk::PipelineStageFlagBits::eAllCommands;
        const vk::ImageMemoryBarrier barrier(
            vk::AccessFlagBits::eMemoryWrite, vk::AccessFlagBits::eTransferRead, from->layout,
            vk::ImageLayout::eTransferSrcOptimal, 0, 0, *from->image, {from->aspect, 0, 1, 0, 1});
        commands.pipelineBarrier(all, all, {}, {}, {}, barrier);
        commands.copyImageToBuffer(
            *from->image, vk::ImageLayout::eTransferSrcOptimal, *buffer,
            vk::BufferImageCopy(0, 0, 0, {from->aspect, 0, 0, 1}, {}, {kSize.x, kSize.y, 1}));
        const vk::MemoryBarrier to_host(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead);
        commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {},
                                 to_host, {}, {});
        finish(commands);
        std::memcpy(values.data(), memory.mapMemory(0, VK_WHOLE_SIZE), bytes);
        return values;
    }
    [[nodiscard]] std::vector<float> readFloats() const { return read<float>(floats, 4); }

    mutable std::mutex queue_mutex, messages_mutex;
    std::vector<std::string> messages;  // from the layers

    vk::raii::Context loader;
    vk::raii::Instance instance{nullptr};
    vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
    vk::raii::PhysicalDevice physical{nullptr};
    vk::raii::Device device{nullptr};
    vk::raii::Queue queue{nullptr};
    vk::raii::CommandPool pool{nullptr};
    std::optional<Image> colour, depth, floats;

private:
    static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                    VkDebugUtilsMessageTypeFlagsEXT,
                                                    const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                    void* user) {
        auto& program = *static_cast<ForeignProgram*>(user);
        // A layer that is configured by a file reports that file.
        const std::string_view name = data->pMessageIdName != nullptr ? data->pMessageIdName : "";
        if (name.starts_with("WARNING-Setting") || name == "VALIDATION-SETTINGS") { return VK_FALSE; }
        const std::lock_guard lock(program.messages_mutex);
        program.messages.emplace_back(data->pMessage);
        return VK_FALSE;
    }

    [[nodiscard]] vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& needs,
                                                  vk::MemoryPropertyFlags wanted) const {
        const auto memory = physical.getMemoryProperties();
        std::uint32_t type = 0;
        while ((needs.memoryTypeBits & (1u << type)) == 0 ||
               (memory.memoryTypes[type].propertyFlags & wanted) != wanted) {
            ++type;
        }
        return {device, vk::MemoryAllocateInfo(needs.size, type)};
    }

    [[nodiscard]] Image makeImage(vk::Format format, vk::ImageLayout layout, vk::ImageUsageFlags usage,
                                  vk::ImageAspectFlagBits aspect = vk::ImageAspectFlagBits::eColor) const {
        usage |= vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst;
        vk::raii::Image image(
            device, vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {kSize.x, kSize.y, 1}, 1, 1,
                                        vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal, usage));
        vk::raii::DeviceMemory memory =
            allocate(image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
        image.bindMemory(*memory, 0);
        vk::raii::ImageView view(device, vk::ImageViewCreateInfo({}, *image, vk::ImageViewType::e2D, format,
                                                                 {}, {aspect, 0, 1, 0, 1}));
        return {format, layout, aspect, std::move(image), std::move(memory), std::move(view)};
    }

    void makePasses() {
        using Layout = vk::ImageLayout;
        using Load = vk::AttachmentLoadOp;
        const auto attachment = [](vk::Format format, Load load, Layout before, Layout inside) {
            return vk::AttachmentDescription({}, format, vk::SampleCountFlagBits::e1, load,
                                             vk::AttachmentStoreOp::eStore, Load::eDontCare,
                                             vk::AttachmentStoreOp::eDontCare, before, inside);
        };
        const vk::AttachmentReference colours(0, Layout::eColorAttachmentOptimal),
            depths(1, Layout::eDepthStencilAttachmentOptimal);
        const std::array both{attachment(colour->format, Load::eClear, Layout::eUndefined, colours.layout),
                              attachment(depth->format, Load::eClear, Layout::eUndefined, depths.layout)};
        const auto one = attachment(colour->format, Load::eLoad, colours.layout, colours.layout);
        // The usual dependencies of a pass on an earlier one that writes the same images.
        using Stage = vk::PipelineStageFlagBits;
        using Access = vk::AccessFlagBits;
        const auto stages =
            Stage::eColorAttachmentOutput | Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;
        const auto writes = Access::eColorAttachmentWrite | Access::eDepthStencilAttachmentWrite;
        const vk::SubpassDependency after_others(
            VK_SUBPASS_EXTERNAL, 0, stages | Stage::eTransfer, stages, writes | Access::eTransferRead,
            writes | Access::eColorAttachmentRead | Access::eDepthStencilAttachmentRead);
        const vk::SubpassDescription with_depth({}, vk::PipelineBindPoint::eGraphics, {}, colours, {},
                                                &depths);
        const vk::SubpassDescription without({}, vk::PipelineBindPoint::eGraphics, {}, colours);
        wall_ = {device, vk::RenderPassCreateInfo({}, both, with_depth, after_others)};
        sign_ = {device, vk::RenderPassCreateInfo({}, one, without, after_others)};
        const std::array views{*colour->view, *depth->view};
        of_wall_ = {device, vk::FramebufferCreateInfo({}, *wall_, views, kSize.x, kSize.y, 1)};
        of_sign_ = {device, vk::FramebufferCreateInfo({}, *sign_, views[0], kSize.x, kSize.y, 1)};
    }

    const vk::Rect2D all_{{0, 0}, {kSize.x, kSize.y}};
    vk::PhysicalDeviceVulkan12Features features_;
    vk::raii::RenderPass wall_{nullptr}, sign_{nullptr};
    vk::raii::Framebuffer of_wall_{nullptr}, of_sign_{nullptr};
};

}  // namespace binosplat::test
