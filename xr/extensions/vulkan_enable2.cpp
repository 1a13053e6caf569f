// Reads the runtime's Vulkan requirements, and makes the instance and device through it.
#include "xr/extensions/vulkan_enable2.h"

namespace binosplat::xr {
namespace {

// Both must be asked again for each headset.
XrVersion leastVulkan(const Instance& instance) {
    auto needs = structure<XrGraphicsRequirementsVulkan2KHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR);
    BINOSPLAT_XR(instance.function<PFN_xrGetVulkanGraphicsRequirements2KHR>(
        "xrGetVulkanGraphicsRequirements2KHR")(instance.handle(), instance.system(), &needs));
    return needs.minApiVersionSupported;
}

VkPhysicalDevice graphicsDevice(const Instance& instance, VkInstance vulkan_instance) {
    auto info = structure<XrVulkanGraphicsDeviceGetInfoKHR>(XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR);
    info.systemId = instance.system();
    info.vulkanInstance = vulkan_instance;
    VkPhysicalDevice chosen = VK_NULL_HANDLE;
    BINOSPLAT_XR(instance.function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR")(
        instance.handle(), &info, &chosen));
    return chosen;
}

// Calls the runtime's `function`, which returns Vulkan's result in addition to its own.
template <typename Function, typename Made, typename Info>
Made create(const Instance& instance, PFN_vkGetInstanceProcAddr get_address, Info info,
            const char* function) {
    info.systemId = instance.system();
    info.pfnGetInstanceProcAddr = get_address;
    Made made = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    checkResult(instance.function<Function>(function)(instance.handle(), &info, &made, &result), function);
    if (result != VK_SUCCESS) {
        throw Error(ExitCode::kNoDevice, fmt::format("{}: {}", function, vk::to_string(vk::Result(result))));
    }
    return made;
}

VkInstance createInstance(const Instance& instance, PFN_vkGetInstanceProcAddr get_address,
                          const VkInstanceCreateInfo& vulkan_info) {
    const XrVersion least = leastVulkan(instance);
    const std::uint32_t wanted = vulkan_info.pApplicationInfo->apiVersion;
    const XrVersion version = XR_MAKE_VERSION(VK_API_VERSION_MAJOR(wanted), VK_API_VERSION_MINOR(wanted), 0);
    if (version < least) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("{} needs Vulkan {}.{} or newer, this program uses {}.{}",
                                instance.description(), XR_VERSION_MAJOR(least), XR_VERSION_MINOR(least),
                                VK_API_VERSION_MAJOR(wanted), VK_API_VERSION_MINOR(wanted)));
    }
    auto info = structure<XrVulkanInstanceCreateInfoKHR>(XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR);
    info.vulkanCreateInfo = &vulkan_info;
    return create<PFN_xrCreateVulkanInstanceKHR, VkInstance>(instance, get_address, info,
                                                             "xrCreateVulkanInstanceKHR");
}

VkDevice createDevice(const Instance& instance, PFN_vkGetInstanceProcAddr get_address,
                      VkPhysicalDevice physical_device, const VkDeviceCreateInfo& vulkan_info) {
    auto info = structure<XrVulkanDeviceCreateInfoKHR>(XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR);
    info.vulkanPhysicalDevice = physical_device;
    info.vulkanCreateInfo = &vulkan_info;
    return create<PFN_xrCreateVulkanDeviceKHR, VkDevice>(instance, get_address, info,
                                                         "xrCreateVulkanDeviceKHR");
}

}  // namespace

DeviceMaker deviceMaker(const Instance& instance) {
    DeviceMaker maker;
    maker.create_instance = [&instance](PFN_vkGetInstanceProcAddr get_address,
                                        const VkInstanceCreateInfo& info) {
        return createInstance(instance, get_address, info);
    };
    maker.choose_device = [&instance](VkInstance vulkan_instance) {
        return graphicsDevice(instance, vulkan_instance);
    };
    maker.create_device = [&instance](PFN_vkGetInstanceProcAddr get_address, VkPhysicalDevice device,
                                      const VkDeviceCreateInfo& info) {
        return createDevice(instance, get_address, device, info);
    };
    return maker;
}

void requireSameDevice(const Instance& instance, const Context& context) {
    static_cast<void>(leastVulkan(instance));  // required before a session
    if (vk::PhysicalDevice(graphicsDevice(instance, *context.instance())) != *context.physicalDevice()) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("{} is on another graphics device than before: start the program again",
                                instance.description()));
    }
}

XrGraphicsBindingVulkan2KHR graphicsBinding(const Context& context) {
    auto binding = structure<XrGraphicsBindingVulkan2KHR>(XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR);
    binding.instance = *context.instance();
    binding.physicalDevice = *context.physicalDevice();
    binding.device = *context.device();
    binding.queueFamilyIndex = context.queueFamily();
    binding.queueIndex = 0;
    return binding;
}

}  // namespace binosplat::xr
