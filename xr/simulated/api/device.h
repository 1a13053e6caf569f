// The application's Vulkan device, as this runtime uses it: images are made on it, and their texels are read
// back on the application's queue in the calls in which OpenXR allows that (XR_KHR_vulkan_enable2,
// "Concurrency").
#pragma once

#include <memory>
#include <vector>

#include "xr/simulated/openxr.h"

namespace simulated {

struct SwapchainFormat {
    VkFormat format;
    const char* name;
    VkImageAspectFlags aspects;
    // Bytes of a texel of the colour or depth aspect in a buffer.
    std::uint32_t texel_bytes;
};

struct ImageInfo {
    SwapchainFormat format;
    VkExtent2D size;
    std::uint32_t layers;
    std::uint32_t mips;
    VkImageUsageFlags usage;
    VkImageCreateFlags flags;
    // 6 for a cube map, whose faces are array layers; `layers` counts them all.
    std::uint32_t faces = 1;
};

class DeviceImage;

class Device {
public:
    // XR_ERROR_GRAPHICS_DEVICE_INVALID if the queue is not one that can draw.
    Device(PFN_vkGetInstanceProcAddr loader, const XrGraphicsBindingVulkan2KHR& binding);
    ~Device();

    // The formats that this device can draw to, in order of preference.
    [[nodiscard]] const std::vector<SwapchainFormat>& formats() const;
    // XR_ERROR_FEATURE_UNSUPPORTED, XR_ERROR_VALIDATION_FAILURE beyond the device's limits.
    void checkImage(const ImageInfo& info) const;
    // XR_ERROR_OUT_OF_MEMORY.
    [[nodiscard]] std::unique_ptr<DeviceImage> createImage(const ImageInfo& info);
    // Brings a new image into the layout in which the application gets it.
    void prepare(const DeviceImage& image);
    // The colour (or depth) of all array layers at the first mip level, tightly packed. The image is in the
    // same layout before and after.
    [[nodiscard]] std::vector<std::byte> read(const DeviceImage& image);

    struct Implementation;

private:
    std::unique_ptr<Implementation> implementation_;
};

class DeviceImage {
public:
    DeviceImage(const ImageInfo& info, Device::Implementation& device);
    ~DeviceImage();
    [[nodiscard]] const ImageInfo& info() const { return info_; }
    [[nodiscard]] VkImage handle() const;

private:
    struct Implementation;
    ImageInfo info_;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace simulated
