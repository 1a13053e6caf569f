// Uses a device that belongs to the program.
#include "engine/gpu/context.h"

#include "engine/error.h"

#include <algorithm>

namespace binosplat {
namespace {

VKAPI_ATTR void VKAPI_CALL keepInstance(VkInstance, const VkAllocationCallbacks*) {}
VKAPI_ATTR void VKAPI_CALL keepDevice(VkDevice, const VkAllocationCallbacks*) {}

// Which of its enabled features kernels use.
struct Enabled {
    bool addresses = false, scalar_layout = false, full_subgroups = false, uniform_flow = false;
};

Enabled enabledIn(const void* chain) {
    Enabled enabled;
    for (const auto* at = static_cast<const VkBaseInStructure*>(chain); at != nullptr; at = at->pNext) {
        if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) {
            const auto& features = *reinterpret_cast<const VkPhysicalDeviceVulkan12Features*>(at);
            enabled.addresses = enabled.addresses || features.bufferDeviceAddress != 0;
            enabled.scalar_layout = enabled.scalar_layout || features.scalarBlockLayout != 0;
        } else if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES) {
            enabled.addresses = reinterpret_cast<const VkPhysicalDeviceBufferDeviceAddressFeatures*>(at)
                                    ->bufferDeviceAddress != 0;
        } else if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES) {
            enabled.scalar_layout =
                reinterpret_cast<const VkPhysicalDeviceScalarBlockLayoutFeatures*>(at)->scalarBlockLayout !=
                0;
        } else if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) {
            const auto& features = *reinterpret_cast<const VkPhysicalDeviceVulkan13Features*>(at);
            enabled.full_subgroups = features.subgroupSizeControl != 0 && features.computeFullSubgroups != 0;
        } else if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES) {
            const auto& features = *reinterpret_cast<const VkPhysicalDeviceSubgroupSizeControlFeatures*>(at);
            enabled.full_subgroups = features.subgroupSizeControl != 0 && features.computeFullSubgroups != 0;
        } else if (at->sType ==
                   VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_FEATURES_KHR) {
            using Flow = VkPhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR;
            enabled.uniform_flow = reinterpret_cast<const Flow*>(at)->shaderSubgroupUniformControlFlow != 0;
        }
    }
    return enabled;
}

}  // namespace

void Context::adopt(const ForeignDevice& foreign) {
    const bool is_whole = foreign.instance != VK_NULL_HANDLE && foreign.physical_device != VK_NULL_HANDLE &&
                          foreign.device != VK_NULL_HANDLE && foreign.queue != VK_NULL_HANDLE;
    check(is_whole, "the program's Vulkan instance, physical device, device or queue is null");
    const Enabled enabled = enabledIn(foreign.enabled_features);
    if (!enabled.addresses || !enabled.scalar_layout) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("the program's Vulkan device was made without {}{}{}, must be enabled",
                                enabled.addresses ? "" : "bufferDeviceAddress",
                                enabled.addresses || enabled.scalar_layout ? "" : " and ",
                                enabled.scalar_layout ? "" : "scalarBlockLayout"));
    }
    // They remain when these owners are destroyed.
    instance_ = vk::raii::Instance(*loader_, foreign.instance);
    const_cast<vk::raii::InstanceDispatcher*>(instance_.getDispatcher())->vkDestroyInstance = keepInstance;
    physical_device_ = vk::raii::PhysicalDevice(instance_, foreign.physical_device);
    requireFeatures("the program's device");
    const auto families = physical_device_.getQueueFamilyProperties();
    const bool computes = foreign.queue_family < families.size() &&
                          bool(families[foreign.queue_family].queueFlags & vk::QueueFlagBits::eCompute);
    check(computes, "queue family {} of the program's Vulkan device cannot compute, must be one that can",
          foreign.queue_family);
    device_ = vk::raii::Device(physical_device_, foreign.device);
    const_cast<vk::raii::DeviceDispatcher*>(device_.getDispatcher())->vkDestroyDevice = keepDevice;
    queue_ = vk::raii::Queue(device_, foreign.queue);
    queue_family_ = foreign.queue_family;
    queue_mutex_.shareWith(foreign.lock_queue, foreign.unlock_queue);
    device_extensions_.insert(foreign.enabled_extensions.begin(), foreign.enabled_extensions.end());
    has_full_subgroups_ = enabled.full_subgroups;
    has_subgroup_uniform_flow_ =
        enabled.uniform_flow &&
        hasDeviceExtension(VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME);
    pipeline_cache_ = PipelineCache(physical_device_, device_);
    readLimits();
}

}  // namespace binosplat
