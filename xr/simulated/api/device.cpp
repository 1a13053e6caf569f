// The runtime's own Vulkan calls: images and their memory, layouts, and texels copied back.
#include "xr/simulated/api/device.h"

#include <array>
#include <cstring>
#include <vulkan/vulkan.hpp>

#include "xr/simulated/api/answer.h"

namespace simulated {
namespace {

using Dispatch = vk::DispatchLoaderDynamic;
template <class Handle>
using Unique = vk::UniqueHandle<Handle, Dispatch>;

constexpr auto kColour = VK_IMAGE_ASPECT_COLOR_BIT;
constexpr auto kDepth = VK_IMAGE_ASPECT_DEPTH_BIT;
constexpr VkImageAspectFlags kDepthStencil = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;

constexpr SwapchainFormat kFormats[] = {
    {VK_FORMAT_R8G8B8A8_SRGB, "VK_FORMAT_R8G8B8A8_SRGB", kColour, 4},
    {VK_FORMAT_B8G8R8A8_SRGB, "VK_FORMAT_B8G8R8A8_SRGB", kColour, 4},
    {VK_FORMAT_R16G16B16A16_SFLOAT, "VK_FORMAT_R16G16B16A16_SFLOAT", kColour, 8},
    {VK_FORMAT_R8G8B8A8_UNORM, "VK_FORMAT_R8G8B8A8_UNORM", kColour, 4},
    {VK_FORMAT_B8G8R8A8_UNORM, "VK_FORMAT_B8G8R8A8_UNORM", kColour, 4},
    {VK_FORMAT_D32_SFLOAT, "VK_FORMAT_D32_SFLOAT", kDepth, 4},
    {VK_FORMAT_D16_UNORM, "VK_FORMAT_D16_UNORM", kDepth, 2},
    {VK_FORMAT_D24_UNORM_S8_UINT, "VK_FORMAT_D24_UNORM_S8_UINT", kDepthStencil, 4},
};

vk::ImageCreateInfo createInfoOf(const ImageInfo& info) {
    return {vk::ImageCreateFlags(info.flags),
            vk::ImageType::e2D,
            vk::Format(info.format.format),
            {info.size.width, info.size.height, 1},
            info.mips,
            info.layers,
            vk::SampleCountFlagBits::e1,
            vk::ImageTiling::eOptimal,
            vk::ImageUsageFlags(info.usage)};
}

// The layout in which images are handed over in XR_KHR_vulkan_enable2, in both directions.
vk::ImageLayout layoutOf(const ImageInfo& info) {
    return info.format.aspects == kColour ? vk::ImageLayout::eColorAttachmentOptimal
                                          : vk::ImageLayout::eDepthStencilAttachmentOptimal;
}

}  // namespace

struct Device::Implementation {
    Dispatch dispatch;
    vk::PhysicalDevice physical_device;
    vk::Device device;
    vk::Queue queue;
    std::vector<SwapchainFormat> formats;
    Unique<vk::CommandPool> pool;
    vk::CommandBuffer commands;
    Unique<vk::Fence> done;

    Implementation(PFN_vkGetInstanceProcAddr loader, const XrGraphicsBindingVulkan2KHR& binding);
    std::uint32_t findMemory(std::uint32_t allowed, vk::MemoryPropertyFlags wanted) const;
    Unique<vk::DeviceMemory> allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted);
    void transition(const DeviceImage& image, vk::ImageLayout from, vk::ImageLayout to) const;
    void begin();
    // Submits and waits: results are available when this returns, and every run does the same in the same
    // order.
    void finish();
};

struct DeviceImage::Implementation {
    Unique<vk::Image> image;
    Unique<vk::DeviceMemory> memory;
};

Device::Implementation::Implementation(PFN_vkGetInstanceProcAddr loader,
                                       const XrGraphicsBindingVulkan2KHR& binding)
    : dispatch(binding.instance, loader), physical_device(binding.physicalDevice), device(binding.device) {
    dispatch.init(device);
    const auto families = physical_device.getQueueFamilyProperties(dispatch);
    const bool can_draw = binding.queueFamilyIndex < families.size() &&
                          binding.queueIndex < families[binding.queueFamilyIndex].queueCount &&
                          (families[binding.queueFamilyIndex].queueFlags & vk::QueueFlagBits::eGraphics);
    require(can_draw, XR_ERROR_GRAPHICS_DEVICE_INVALID, "queue ", binding.queueIndex, " of family ",
            binding.queueFamilyIndex, " cannot draw, or is not there");
    queue = device.getQueue(binding.queueFamilyIndex, binding.queueIndex, dispatch);
    for (const SwapchainFormat& format : kFormats) {
        const auto features =
            physical_device.getFormatProperties(vk::Format(format.format), dispatch).optimalTilingFeatures;
        const auto needed = format.aspects == kColour ? vk::FormatFeatureFlagBits::eColorAttachment
                                                      : vk::FormatFeatureFlagBits::eDepthStencilAttachment;
        if (features & needed) { formats.push_back(format); }
    }
    pool = device.createCommandPoolUnique(
        {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, binding.queueFamilyIndex}, nullptr, dispatch);
    commands = device.allocateCommandBuffers({*pool, vk::CommandBufferLevel::ePrimary, 1}, dispatch).front();
    done = device.createFenceUnique({}, nullptr, dispatch);
}

std::uint32_t Device::Implementation::findMemory(std::uint32_t allowed,
                                                 vk::MemoryPropertyFlags wanted) const {
    const auto memory = physical_device.getMemoryProperties(dispatch);
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        if ((allowed >> i & 1) != 0 && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) { return i; }
    }
    throw Refusal{XR_ERROR_RUNTIME_FAILURE, "the device has no such memory"};
}

Unique<vk::DeviceMemory> Device::Implementation::allocate(const vk::MemoryRequirements& needs,
                                                          vk::MemoryPropertyFlags wanted) {
    return device.allocateMemoryUnique({needs.size, findMemory(needs.memoryTypeBits, wanted)}, nullptr,
                                       dispatch);
}

void Device::Implementation::transition(const DeviceImage& image, vk::ImageLayout from,
                                        vk::ImageLayout to) const {
    // Waits for everything that the application did before, and makes everything after wait; speed does not
    // matter here.
    const auto everything = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;
    const vk::ImageMemoryBarrier barrier(
        everything, everything, from, to, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, image.handle(),
        {vk::ImageAspectFlags(image.info().format.aspects), 0, image.info().mips, 0, image.info().layers});
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands, vk::PipelineStageFlagBits::eAllCommands,
                             {}, {}, {}, barrier, dispatch);
}

void Device::Implementation::begin() {
    commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit), dispatch);
}

void Device::Implementation::finish() {
    commands.end(dispatch);
    queue.submit(vk::SubmitInfo({}, {}, commands), *done, dispatch);
    if (device.waitForFences(*done, VK_TRUE, UINT64_MAX, dispatch) != vk::Result::eSuccess) {
        throw Refusal{XR_ERROR_RUNTIME_FAILURE, "the application's queue does not finish"};
    }
    device.resetFences(*done, dispatch);
}

Device::Device(PFN_vkGetInstanceProcAddr loader, const XrGraphicsBindingVulkan2KHR& binding)
    : implementation_(std::make_unique<Implementation>(loader, binding)) {}
Device::~Device() = default;

const std::vector<SwapchainFormat>& Device::formats() const { return implementation_->formats; }

void Device::checkImage(const ImageInfo& info) const {
    const auto& [dispatch, physical_device, device, queue, formats, pool, commands, done] = *implementation_;
    const vk::ImageCreateInfo wanted = createInfoOf(info);
    vk::ImageFormatProperties limits;
    const vk::Result result = physical_device.getImageFormatProperties(
        wanted.format, wanted.imageType, wanted.tiling, wanted.usage, wanted.flags, &limits, dispatch);
    require(result == vk::Result::eSuccess, XR_ERROR_FEATURE_UNSUPPORTED, "the device cannot use ",
            info.format.name, " in this way");
    require(info.size.width <= limits.maxExtent.width && info.size.height <= limits.maxExtent.height &&
                info.layers <= limits.maxArrayLayers && info.mips <= limits.maxMipLevels,
            XR_ERROR_VALIDATION_FAILURE, "an image of ", info.size.width, "x", info.size.height, " with ",
            info.layers, " layers and ", info.mips, " mips is beyond the device's limits");
}

std::unique_ptr<DeviceImage> Device::createImage(const ImageInfo& info) {
    try {
        return std::make_unique<DeviceImage>(info, *implementation_);
    } catch (const vk::OutOfDeviceMemoryError&) {
        throw Refusal{XR_ERROR_OUT_OF_MEMORY, "the device has no memory left for an image"};
    } catch (const vk::OutOfHostMemoryError&) {
        throw Refusal{XR_ERROR_OUT_OF_MEMORY, "there is no memory left for an image"};
    }
}

DeviceImage::DeviceImage(const ImageInfo& info, Device::Implementation& device)
    : info_(info), implementation_(std::make_unique<Implementation>()) {
    auto& [image, memory] = *implementation_;
    image = device.device.createImageUnique(createInfoOf(info), nullptr, device.dispatch);
    memory = device.allocate(device.device.getImageMemoryRequirements(*image, device.dispatch),
                             vk::MemoryPropertyFlagBits::eDeviceLocal);
    device.device.bindImageMemory(*image, *memory, 0, device.dispatch);
}

DeviceImage::~DeviceImage() = default;
VkImage DeviceImage::handle() const { return *implementation_->image; }

void Device::prepare(const DeviceImage& image) {
    implementation_->begin();
    implementation_->transition(image, vk::ImageLayout::eUndefined, layoutOf(image.info()));
    implementation_->finish();
}

std::vector<std::byte> Device::read(const DeviceImage& image) {
    Implementation& my = *implementation_;
    const auto& [format, size, layers, mips, usage, flags, faces] = image.info();
    std::vector<std::byte> texels(std::size_t{size.width} * size.height * layers * format.texel_bytes);

    const auto buffer = my.device.createBufferUnique(
        {{}, texels.size(), vk::BufferUsageFlagBits::eTransferDst}, nullptr, my.dispatch);
    const auto memory =
        my.allocate(my.device.getBufferMemoryRequirements(*buffer, my.dispatch),
                    vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    my.device.bindBufferMemory(*buffer, *memory, 0, my.dispatch);

    const auto aspect =
        format.aspects == kColour ? vk::ImageAspectFlagBits::eColor : vk::ImageAspectFlagBits::eDepth;
    const vk::BufferImageCopy whole(0, 0, 0, {aspect, 0, 0, layers}, {}, {size.width, size.height, 1});
    my.begin();
    my.transition(image, layoutOf(image.info()), vk::ImageLayout::eTransferSrcOptimal);
    my.commands.copyImageToBuffer(image.handle(), vk::ImageLayout::eTransferSrcOptimal, *buffer, whole,
                                  my.dispatch);
    const vk::MemoryBarrier for_the_host(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead);
    my.commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {},
                                for_the_host, {}, {}, my.dispatch);
    my.transition(image, vk::ImageLayout::eTransferSrcOptimal, layoutOf(image.info()));
    my.finish();

    const void* const mapped = my.device.mapMemory(*memory, 0, VK_WHOLE_SIZE, {}, my.dispatch);
    std::memcpy(texels.data(), mapped, texels.size());
    my.device.unmapMemory(*memory, my.dispatch);
    return texels;
}

}  // namespace simulated
