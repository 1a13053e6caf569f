// Plain Vulkan, as in any program.
#include "tests/engine/library/foreign_program.h"

namespace binosplat::test {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& program = *static_cast<ForeignProgram*>(user);
    // A layer that is configured by a file reports that file.
    const std::string_view name = data->pMessageIdName != nullptr ? data->pMessageIdName : "";
    if (name.starts_with("WARNING-Setting") || name == "VALIDATION-SETTINGS") { return VK_FALSE; }
    const std::lock_guard lock(program.messages_mutex);
    program.messages.emplace_back(data->pMessage);
    return VK_FALSE;
}

vk::raii::DeviceMemory allocate(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                                const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) {
    const auto memory = physical.getMemoryProperties();
    std::uint32_t type = 0;
    while ((needs.memoryTypeBits & (1u << type)) == 0 ||
           (memory.memoryTypes[type].propertyFlags & wanted) != wanted) {
        ++type;
    }
    return {device, vk::MemoryAllocateInfo(needs.size, type)};
}

}  // namespace

ForeignImage::ForeignImage(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                           vk::Format its_format, glm::uvec2 size_px, vk::ImageUsageFlags usage,
                           vk::ImageAspectFlagBits aspect)
    : format(its_format),
      image(device, vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {size_px.x, size_px.y, 1}, 1, 1,
                                        vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                                        usage | vk::ImageUsageFlagBits::eTransferSrc |
                                            vk::ImageUsageFlagBits::eTransferDst)) {
    memory =
        allocate(physical, device, image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
    image.bindMemory(*memory, 0);
    view = vk::raii::ImageView(device, vk::ImageViewCreateInfo({}, *image, vk::ImageViewType::e2D, format, {},
                                                               {aspect, 0, 1, 0, 1}));
}

ForeignProgram::ForeignProgram(bool has_features) {
    const vk::ApplicationInfo application("somebody", 1, "else", 1, VK_API_VERSION_1_2);
    const vk::ValidationFeatureEnableEXT synchronization =
        vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    const vk::ValidationFeaturesEXT checks(synchronization);
    const char* const layer = "VK_LAYER_KHRONOS_validation";
    std::vector<const char*> extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    // A layer that is configured by a file lacks this extension.
    const bool has_checks = std::ranges::any_of(
        loader.enumerateInstanceExtensionProperties(std::string(layer)), [](const auto& extension) {
            return std::string_view(extension.extensionName.data()) ==
                   VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
        });
    if (has_checks) { extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME); }
    instance = vk::raii::Instance(
        loader, vk::InstanceCreateInfo({}, &application, layer, extensions, has_checks ? &checks : nullptr));
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
    device = vk::raii::Device(physical, vk::DeviceCreateInfo({}, queue_info, {}, {}, nullptr, &features_));
    queue = device.getQueue(0, 0);
    pool = vk::raii::CommandPool(device,
                                 vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient, 0));
    using Usage = vk::ImageUsageFlagBits;
    colour.emplace(physical, device, vk::Format::eR8G8B8A8Unorm, kSize, Usage::eColorAttachment,
                   vk::ImageAspectFlagBits::eColor);
    depth.emplace(physical, device, vk::Format::eD32Sfloat, kSize, Usage::eDepthStencilAttachment,
                  vk::ImageAspectFlagBits::eDepth);
    floats.emplace(physical, device, vk::Format::eR32G32B32A32Sfloat, kSize, Usage::eColorAttachment,
                   vk::ImageAspectFlagBits::eColor);
    makePasses();
}

ForeignProgram::~ForeignProgram() {
    device.waitIdle();
    CHECK(messages == std::vector<std::string>());
}

void ForeignProgram::makePasses() {
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
    const std::array one{attachment(colour->format, Load::eLoad, colours.layout, colours.layout)};
    // The usual dependencies of a pass on an earlier one that writes the same images.
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    const auto stages =
        Stage::eColorAttachmentOutput | Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;
    const auto writes = Access::eColorAttachmentWrite | Access::eDepthStencilAttachmentWrite;
    const vk::SubpassDependency after_others(
        VK_SUBPASS_EXTERNAL, 0, stages | Stage::eTransfer, stages, writes | Access::eTransferRead,
        writes | Access::eColorAttachmentRead | Access::eDepthStencilAttachmentRead);
    const vk::SubpassDescription with_depth({}, vk::PipelineBindPoint::eGraphics, {}, colours, {}, &depths);
    const vk::SubpassDescription without({}, vk::PipelineBindPoint::eGraphics, {}, colours);
    wall_ = {device, vk::RenderPassCreateInfo({}, both, with_depth, after_others)};
    sign_ = {device, vk::RenderPassCreateInfo({}, one, without, after_others)};
    const std::array views{*colour->view, *depth->view};
    of_wall_ = {device, vk::FramebufferCreateInfo({}, *wall_, views, kSize.x, kSize.y, 1)};
    of_sign_ = {device, vk::FramebufferCreateInfo({}, *sign_, views[0], kSize.x, kSize.y, 1)};
}

bsp::Device ForeignProgram::open() {
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

void ForeignProgram::drawWall(const vk::raii::CommandBuffer& commands, float wall_depth) const {
    const std::array<vk::ClearValue, 2> clears{vk::ClearColorValue(std::array{0.2f, 0.4f, 0.6f, 1.0f}),
                                               vk::ClearDepthStencilValue(0.0f, 0)};
    const vk::Rect2D all({0, 0}, {kSize.x, kSize.y});
    commands.beginRenderPass(vk::RenderPassBeginInfo(*wall_, *of_wall_, all, clears),
                             vk::SubpassContents::eInline);
    const vk::ClearRect left({{0, 0}, {kSize.x / 2, kSize.y}}, 0, 1);
    commands.clearAttachments(
        {{vk::ImageAspectFlagBits::eColor, 0, vk::ClearColorValue(std::array{1.0f, 0.0f, 0.0f, 1.0f})},
         {vk::ImageAspectFlagBits::eDepth, 0, vk::ClearDepthStencilValue(wall_depth, 0)}},
        left);
    commands.endRenderPass();
}

void ForeignProgram::drawSign(const vk::raii::CommandBuffer& commands) const {
    const vk::Rect2D all({0, 0}, {kSize.x, kSize.y});
    commands.beginRenderPass(vk::RenderPassBeginInfo(*sign_, *of_sign_, all), vk::SubpassContents::eInline);
    const vk::ClearAttachment white(vk::ImageAspectFlagBits::eColor, 0,
                                    vk::ClearColorValue(std::array{1.0f, 1.0f, 1.0f, 1.0f}));
    commands.clearAttachments(white, vk::ClearRect({{0, 0}, {4, 4}}, 0, 1));
    commands.endRenderPass();
}

vk::raii::CommandBuffer ForeignProgram::begin() const {
    vk::raii::CommandBuffer commands = std::move(vk::raii::CommandBuffers(
        device, vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1))[0]);
    commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    return commands;
}

void ForeignProgram::submit(const vk::raii::CommandBuffer& commands, const vk::raii::Fence& fence) const {
    commands.end();
    const vk::CommandBuffer buffer = *commands;
    const std::lock_guard lock(queue_mutex);
    queue.submit(vk::SubmitInfo({}, {}, buffer), *fence);
}

void ForeignProgram::finish(const vk::raii::CommandBuffer& commands) const {
    const vk::raii::Fence fence(device, vk::FenceCreateInfo());
    submit(commands, fence);
    (void)device.waitForFences(*fence, VK_TRUE, UINT64_MAX);
}

std::vector<std::byte> ForeignProgram::read(const ForeignImage& image, vk::ImageLayout layout,
                                            std::uint64_t bytes) const {
    const vk::raii::Buffer buffer(device,
                                  vk::BufferCreateInfo({}, bytes, vk::BufferUsageFlagBits::eTransferDst));
    const vk::raii::DeviceMemory memory =
        allocate(physical, device, buffer.getMemoryRequirements(),
                 vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    buffer.bindMemory(*memory, 0);
    const vk::raii::CommandBuffer commands = begin();
    const auto aspect = image.format == vk::Format::eD32Sfloat ? vk::ImageAspectFlagBits::eDepth
                                                               : vk::ImageAspectFlagBits::eColor;
    const auto all = vk::PipelineStageFlagBits::eAllCommands;
    const vk::ImageMemoryBarrier barrier(vk::AccessFlagBits::eMemoryWrite, vk::AccessFlagBits::eTransferRead,
                                         layout, vk::ImageLayout::eTransferSrcOptimal, 0, 0, *image.image,
                                         {aspect, 0, 1, 0, 1});
    commands.pipelineBarrier(all, all, {}, {}, {}, barrier);
    commands.copyImageToBuffer(*image.image, vk::ImageLayout::eTransferSrcOptimal, *buffer,
                               vk::BufferImageCopy(0, 0, 0, {aspect, 0, 0, 1}, {}, {kSize.x, kSize.y, 1}));
    const vk::MemoryBarrier to_host(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {},
                             to_host, {}, {});
    finish(commands);
    const auto* mapped = static_cast<const std::byte*>(memory.mapMemory(0, VK_WHOLE_SIZE));
    return {mapped, mapped + bytes};
}

std::vector<float> ForeignProgram::readFloats(const ForeignImage& image, vk::ImageLayout layout,
                                              std::uint32_t floats_per_pixel) const {
    std::vector<float> values(std::size_t{floats_per_pixel} * kSize.x * kSize.y);
    std::memcpy(values.data(), read(image, layout, values.size() * sizeof(float)).data(),
                values.size() * sizeof(float));
    return values;
}

std::vector<std::uint32_t> ForeignProgram::readWords(const ForeignImage& image,
                                                     vk::ImageLayout layout) const {
    std::vector<std::uint32_t> words(std::size_t{kSize.x} * kSize.y);
    std::memcpy(words.data(), read(image, layout, words.size() * 4).data(), words.size() * 4);
    return words;
}

}  // namespace binosplat::test
