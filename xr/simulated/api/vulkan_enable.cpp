// XR_KHR_vulkan_enable2 and its predecessor: the application's Vulkan instance and device are made through
// the runtime, which needs nothing beyond what the application asks for.
#include <algorithm>
#include <cstring>
#include <vector>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/instance.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/environment.h"
#include "xr/simulated/files/file_words.h"

namespace simulated {
namespace {

template <class Function>
Function resolve(PFN_vkGetInstanceProcAddr loader, VkInstance instance, const char* name) {
    const auto function = reinterpret_cast<Function>(loader(instance, name));
    require(function != nullptr, XR_ERROR_RUNTIME_FAILURE, "Vulkan has no ", name);
    return function;
}

bool canDraw(PFN_vkGetInstanceProcAddr loader, VkInstance instance, VkPhysicalDevice device) {
    const auto getFamilies = resolve<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
        loader, instance, "vkGetPhysicalDeviceQueueFamilyProperties");
    std::uint32_t count = 0;
    getFamilies(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    getFamilies(device, &count, families.data());
    return std::ranges::any_of(
        families, [](const auto& family) { return (family.queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0; });
}

// SIMULATED_OPENXR_GPU counts the devices that can draw, from 0.
std::size_t findWantedDevice() {
    const Setting setting = settingOf("GPU");
    if (!setting.isSet()) { return 0; }
    const auto index = files::parseWhole<std::size_t>(setting.value);
    require(index.has_value(), XR_ERROR_RUNTIME_FAILURE, setting.variable, " is '", setting.value,
            "', must be a whole number from 0 on");
    return *index;
}

VkPhysicalDevice chooseDevice(PFN_vkGetInstanceProcAddr loader, VkInstance instance) {
    const auto enumerate =
        resolve<PFN_vkEnumeratePhysicalDevices>(loader, instance, "vkEnumeratePhysicalDevices");
    std::uint32_t count = 0;
    require(enumerate(instance, &count, nullptr) == VK_SUCCESS, XR_ERROR_RUNTIME_FAILURE,
            "Vulkan's devices cannot be listed");
    std::vector<VkPhysicalDevice> devices(count);
    require(enumerate(instance, &count, devices.data()) == VK_SUCCESS, XR_ERROR_RUNTIME_FAILURE,
            "Vulkan's devices cannot be listed");
    std::erase_if(devices, [&](VkPhysicalDevice device) { return !canDraw(loader, instance, device); });
    const std::size_t index = findWantedDevice();
    require(!devices.empty(), XR_ERROR_RUNTIME_FAILURE,
            "no GPU: Vulkan has no device that can draw, not even a software one (Mesa's lavapipe)");
    require(index < devices.size(), XR_ERROR_RUNTIME_FAILURE, settingOf("GPU").variable, " is ", index,
            ", there are ", devices.size(), " devices that can draw");
    return devices[index];
}

template <class Requirements>
XrResult answerRequirements(const char* function, XrInstance instance, XrSystemId system,
                            Requirements* requirements) {
    return answerFor<Instance>(function, instance, [&](Instance& owner) {
        checkSystem(system);
        // Both extensions share the structure and its type.
        Requirements& output = checkStruct(requirements, XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR);
        output.minApiVersionSupported = XR_MAKE_VERSION(1, 0, 0);
        output.maxApiVersionSupported = XR_MAKE_VERSION(1, 3, 0);
        owner.has_asked_requirements = true;
    });
}

// No extension is needed, so the string is empty.
XrResult answerNoExtensions(const char* function, XrInstance instance, XrSystemId system, uint32_t capacity,
                            uint32_t* count, char* buffer) {
    return answerFor<Instance>(function, instance, [&](const Instance&) {
        checkSystem(system);
        fillString(capacity, count, buffer, "");
    });
}

// For a VkInstance or a VkDevice.
template <typename Info>
void checkCreation(const Info& info, const char* made_from) {
    checkSystem(info.systemId);
    require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "createFlags is ", info.createFlags,
            ", no flags are known");
    require(info.pfnGetInstanceProcAddr != nullptr && info.vulkanCreateInfo != nullptr,
            XR_ERROR_VALIDATION_FAILURE, "vkGetInstanceProcAddr or the ", made_from, " is missing");
}

VkPhysicalDevice giveDevice(Instance& owner, VkInstance instance) {
    require(instance != VK_NULL_HANDLE, XR_ERROR_VALIDATION_FAILURE, "the VkInstance is null");
    owner.graphics_device = chooseDevice(owner.vulkanLoaderOf(instance), instance);
    owner.graphics_instance = instance;
    return owner.graphics_device;
}

}  // namespace

PFN_vkGetInstanceProcAddr Instance::vulkanLoaderOf(VkInstance vulkan_instance) const {
    const auto found = vulkan_loaders.find(vulkan_instance);
    if (found != vulkan_loaders.end()) { return found->second; }
    void* const function = findVulkanFunction("vkGetInstanceProcAddr");
    require(function != nullptr, XR_ERROR_RUNTIME_FAILURE, "there is no ", kVulkanLoader);
    return reinterpret_cast<PFN_vkGetInstanceProcAddr>(function);
}

XrResult xrGetVulkanGraphicsRequirements2KHR(XrInstance instance, XrSystemId systemId,
                                             XrGraphicsRequirementsVulkan2KHR* graphicsRequirements) {
    return answerRequirements(__func__, instance, systemId, graphicsRequirements);
}

XrResult xrGetVulkanGraphicsRequirementsKHR(XrInstance instance, XrSystemId systemId,
                                            XrGraphicsRequirementsVulkanKHR* graphicsRequirements) {
    return answerRequirements(__func__, instance, systemId, graphicsRequirements);
}

XrResult xrGetVulkanInstanceExtensionsKHR(XrInstance instance, XrSystemId systemId,
                                          uint32_t bufferCapacityInput, uint32_t* bufferCountOutput,
                                          char* buffer) {
    return answerNoExtensions(__func__, instance, systemId, bufferCapacityInput, bufferCountOutput, buffer);
}

XrResult xrGetVulkanDeviceExtensionsKHR(XrInstance instance, XrSystemId systemId,
                                        uint32_t bufferCapacityInput, uint32_t* bufferCountOutput,
                                        char* buffer) {
    return answerNoExtensions(__func__, instance, systemId, bufferCapacityInput, bufferCountOutput, buffer);
}

XrResult xrCreateVulkanInstanceKHR(XrInstance instance, const XrVulkanInstanceCreateInfoKHR* createInfo,
                                   VkInstance* vulkanInstance, VkResult* vulkanResult) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        const XrVulkanInstanceCreateInfoKHR& info =
            checkStruct(createInfo, XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR);
        VkInstance& output = checkOutput(vulkanInstance);
        VkResult& result = checkOutput(vulkanResult);
        checkCreation(info, "VkInstanceCreateInfo");
        const auto create =
            resolve<PFN_vkCreateInstance>(info.pfnGetInstanceProcAddr, VK_NULL_HANDLE, "vkCreateInstance");
        result = create(info.vulkanCreateInfo, info.vulkanAllocator, &output);
        if (result == VK_SUCCESS) { owner.vulkan_loaders[output] = info.pfnGetInstanceProcAddr; }
        // Vulkan's result is in vulkanResult; this call itself succeeded. A machine without a driver is
        // reported all the same.
        if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
            explainFailure("xrCreateVulkanInstanceKHR",
                           "no GPU: Vulkan has no driver, not even a software one (Mesa's lavapipe)");
        }
    });
}

XrResult xrGetVulkanGraphicsDevice2KHR(XrInstance instance, const XrVulkanGraphicsDeviceGetInfoKHR* getInfo,
                                       VkPhysicalDevice* vulkanPhysicalDevice) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        const XrVulkanGraphicsDeviceGetInfoKHR& info =
            checkStruct(getInfo, XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR);
        VkPhysicalDevice& output = checkOutput(vulkanPhysicalDevice);
        checkSystem(info.systemId);
        output = giveDevice(owner, info.vulkanInstance);
    });
}

XrResult xrGetVulkanGraphicsDeviceKHR(XrInstance instance, XrSystemId systemId, VkInstance vkInstance,
                                      VkPhysicalDevice* vkPhysicalDevice) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        checkSystem(systemId);
        VkPhysicalDevice& output = checkOutput(vkPhysicalDevice);
        output = giveDevice(owner, vkInstance);
    });
}

XrResult xrCreateVulkanDeviceKHR(XrInstance instance, const XrVulkanDeviceCreateInfoKHR* createInfo,
                                 VkDevice* vulkanDevice, VkResult* vulkanResult) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        const XrVulkanDeviceCreateInfoKHR& info =
            checkStruct(createInfo, XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR);
        VkDevice& output = checkOutput(vulkanDevice);
        VkResult& result = checkOutput(vulkanResult);
        checkCreation(info, "VkDeviceCreateInfo");
        require(
            info.vulkanPhysicalDevice != VK_NULL_HANDLE && info.vulkanPhysicalDevice == owner.graphics_device,
            XR_ERROR_HANDLE_INVALID, "not the device that xrGetVulkanGraphicsDevice2KHR gave");
        const auto create = resolve<PFN_vkCreateDevice>(info.pfnGetInstanceProcAddr, owner.graphics_instance,
                                                        "vkCreateDevice");
        // As Monado does: a feature of the runtime's own, in a struct of its own.
        VkPhysicalDeviceTimelineSemaphoreFeatures timeline{
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES,
            const_cast<void*>(info.vulkanCreateInfo->pNext), VK_TRUE};
        VkDeviceCreateInfo with_additions = *info.vulkanCreateInfo;
        with_additions.pNext = &timeline;
        const bool adds = owner.simulation->script.adds_vulkan_features;
        result = create(info.vulkanPhysicalDevice, adds ? &with_additions : info.vulkanCreateInfo,
                        info.vulkanAllocator, &output);
    });
}

}  // namespace simulated
