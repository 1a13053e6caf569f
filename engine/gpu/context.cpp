// Opens the Vulkan device.
#include "engine/gpu/context.h"

#include "engine/error.h"
#include "engine/platform.h"
#include "shaders/embedded_shaders.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

namespace binosplat {
namespace {

constexpr std::uint32_t kApiVersion = VK_API_VERSION_1_2;
constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    // NVIDIA's driver queries a function of the instance in this way, too, which the program cannot prevent.
    if (data->pMessageIdName != nullptr &&
        std::strcmp(data->pMessageIdName, "WARNING-vkGetDeviceProcAddr-device") == 0) {
        return VK_FALSE;
    }
    const auto& sink = *static_cast<std::function<void(const char*)>*>(user);
    sink(data->pMessage);
    return VK_FALSE;
}

// The queue family for frames: one with compute and, if possible, graphics (viewers draw with it).
std::optional<std::uint32_t> queueFamilyOf(const vk::raii::PhysicalDevice& device) {
    const auto families = device.getQueueFamilyProperties();
    std::optional<std::uint32_t> found;
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        const bool compute = bool(families[i].queueFlags & vk::QueueFlagBits::eCompute);
        const bool graphics = bool(families[i].queueFlags & vk::QueueFlagBits::eGraphics);
        if (compute && graphics) { return i; }
        if (compute && !found) { found = i; }
    }
    return found;
}

// What the passes need and `device` lacks, in words; empty if the device is usable.
std::string missingFeatures(const vk::raii::PhysicalDevice& device) {
    if (device.getProperties().apiVersion < kApiVersion) { return "Vulkan 1.2"; }
    if (!queueFamilyOf(device)) { return "a compute queue"; }
    // Vulkan's guaranteed limits.
    const auto limits = device.getProperties().limits;
    if (limits.maxComputeWorkGroupInvocations < 128 || limits.maxComputeWorkGroupSize[0] < 128) {
        return "workgroups of 128 invocations";
    }
    if (limits.maxComputeSharedMemorySize < 16384) { return "16 KiB of shared memory"; }
    const auto features =
        device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
    const auto& vulkan12 = features.get<vk::PhysicalDeviceVulkan12Features>();
    if (!vulkan12.bufferDeviceAddress) { return "bufferDeviceAddress"; }
    if (!vulkan12.scalarBlockLayout) { return "scalarBlockLayout"; }
    const auto properties =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties>();
    const auto& vulkan11 = properties.get<vk::PhysicalDeviceVulkan11Properties>();
    const auto operations = vk::SubgroupFeatureFlagBits::eArithmetic | vk::SubgroupFeatureFlagBits::eBallot |
                            vk::SubgroupFeatureFlagBits::eShuffle;
    if ((vulkan11.subgroupSupportedOperations & operations) != operations) {
        return "subgroup arithmetic, ballot and shuffle";
    }
    std::uint32_t least_lanes = vulkan11.subgroupSize;
    if (device.getProperties().apiVersion >= VK_API_VERSION_1_3) {
        const auto sizes = device.getProperties2<vk::PhysicalDeviceProperties2,
                                                 vk::PhysicalDeviceSubgroupSizeControlProperties>();
        least_lanes = std::min(least_lanes,
                               sizes.get<vk::PhysicalDeviceSubgroupSizeControlProperties>().minSubgroupSize);
    }
    if (least_lanes < 4 || vulkan11.subgroupSize > 128) { return "subgroups of 4 to 128 invocations"; }
    return {};
}

bool offersExtension(const std::vector<vk::ExtensionProperties>& offered, const char* name) {
    return std::ranges::any_of(
        offered, [&](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
}

int preferenceOf(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eDiscreteGpu:
            return 0;
        case vk::PhysicalDeviceType::eIntegratedGpu:
            return 1;
        case vk::PhysicalDeviceType::eVirtualGpu:
            return 2;
        default:
            return 3;
    }
}

}  // namespace

Context::Context(const ContextOptions& options) : memory_limit_bytes_(options.memory_limit_bytes) {
    try {
        loader_.emplace();
    } catch (const std::exception& error) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("no Vulkan loader (libvulkan.so.1): {}; install libvulkan1 and a driver",
                                error.what()));
    }
    try {
        if (options.foreign != nullptr) {
            adopt(*options.foreign);
        } else {
            createInstance(options, options.validation || environment("BINOSPLAT_VALIDATION") == "1");
            if (options.maker.choose_device) {
                takePhysicalDevice(options.maker);
            } else {
                choosePhysicalDevice(options.device);
            }
            createDevice(options);
        }
    } catch (const vk::SystemError& error) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("no usable Vulkan device: {}; {}", error.what(), kVulkanHint));
    }
    if (options.max_allocation_bytes != 0) {
        max_allocation_bytes_ = std::min(max_allocation_bytes_, options.max_allocation_bytes);
    }
}

Context::~Context() {
    pipeline_cache_.save();
    pipeline_cache_ = {};
    if (!validates_) { return; }
    const std::size_t before = validationMessages().size();
    queue_ = vk::raii::Queue(nullptr);
    device_ = vk::raii::Device(nullptr);
    const std::vector<std::string> messages = validationMessages();
    for (std::size_t i = before; i < messages.size(); ++i) {
        fmt::print(stderr, "Vulkan validation at the end: {}\n", messages[i]);
    }
}

void Context::createInstance(const ContextOptions& options, bool validation) {
    const vk::ApplicationInfo application("binosplat", 1, "binosplat", 1, kApiVersion);
    std::vector<const char*> layers, extensions = options.instance_extensions;
    if (validation) {
        const auto available = loader_->enumerateInstanceLayerProperties();
        const bool found = std::any_of(available.begin(), available.end(), [](const auto& layer) {
            return std::strcmp(layer.layerName, kValidationLayer) == 0;
        });
        check(found, "BINOSPLAT_VALIDATION: {} is not installed (package vulkan-validationlayers)",
              kValidationLayer);
        layers.push_back(kValidationLayer);
    }
    // Newer layers no longer have it; with them, a settings file or the environment selects the checks.
    const bool chooses_checks =
        validation &&
        offersExtension(loader_->enumerateInstanceExtensionProperties(std::string(kValidationLayer)),
                        VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    if (chooses_checks) { extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME); }
    // The validation layer provides it, too, if no driver does.
    labels_ = validation || offersExtension(loader_->enumerateInstanceExtensionProperties(),
                                            VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (labels_) { extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME); }
    const vk::ValidationFeatureEnableEXT synchronization =
        vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    const vk::ValidationFeaturesEXT validation_features(synchronization);
    vk::InstanceCreateInfo info({}, &application, layers, extensions);
    if (chooses_checks) { info.pNext = &validation_features; }
    const DeviceMaker& maker = options.maker;
    instance_ = maker.create_instance
                    ? vk::raii::Instance(*loader_, maker.create_instance(
                                                       loader_->getDispatcher()->vkGetInstanceProcAddr, info))
                    : vk::raii::Instance(*loader_, info);
    validates_ = validation;
    if (validation) {
        sink_ = [this](const char* message) {
            const std::lock_guard lock(messages_.mutex);
            messages_.lines.emplace_back(message);
        };
        using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
        using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
        messenger_ = vk::raii::DebugUtilsMessengerEXT(
            instance_,
            vk::DebugUtilsMessengerCreateInfoEXT({}, Severity::eWarning | Severity::eError,
                                                 Type::eValidation | Type::ePerformance, onMessage, &sink_));
    }
}

void Context::choosePhysicalDevice(const std::string& wanted) {
    vk::raii::PhysicalDevices devices(instance_);
    const auto refuse = [](const std::string& message) { throw Error(ExitCode::kNoDevice, message); };
    if (devices.empty()) { refuse(fmt::format("no Vulkan device found; {}", kVulkanHint)); }
    const bool is_index = wanted.find_first_not_of("0123456789") == std::string::npos;
    std::string seen;
    std::optional<std::size_t> chosen;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const std::string name = devices[i].getProperties().deviceName, missing = missingFeatures(devices[i]);
        const auto preference = [&](std::size_t device) {
            return preferenceOf(devices[device].getProperties().deviceType);
        };
        seen += fmt::format("{}{}: {}{}", i == 0 ? "" : ", ", i, name,
                            missing.empty() ? "" : " (lacks " + missing + ")");
        const bool is_wanted =
            is_index ? std::to_string(i) == wanted : name.find(wanted) != std::string::npos;
        const bool will_do = wanted.empty()
                                 ? missing.empty() && (!chosen || preference(i) < preference(*chosen))
                                 : is_wanted && !chosen;
        if (will_do) { chosen = i; }
    }
    if (!chosen && wanted.empty()) {
        refuse(fmt::format("no usable Vulkan device; there is {}; {}", seen, kVulkanHint));
    }
    if (!chosen) { refuse(fmt::format("--device {}: no such Vulkan device; there is {}", wanted, seen)); }
    if (!missingFeatures(devices[*chosen]).empty()) {
        refuse(fmt::format("--device {}: not usable; there is {}", wanted, seen));
    }
    physical_device_ = std::move(devices[*chosen]);
}

void Context::takePhysicalDevice(const DeviceMaker& maker) {
    physical_device_ = vk::raii::PhysicalDevice(instance_, maker.choose_device(*instance_));
    requireFeatures("the device that the runtime wants");
}

void Context::requireFeatures(const char* which) const {
    const std::string missing = missingFeatures(physical_device_);
    if (missing.empty()) { return; }
    const std::string name = physical_device_.getProperties().deviceName;
    throw Error(ExitCode::kNoDevice, fmt::format("{}: {} lacks {}", name, which, missing));
}

void Context::createDevice(const ContextOptions& options) {
    queue_family_ = queueFamilyOf(physical_device_).value();
    const float priority = 1.0f;
    const vk::DeviceQueueCreateInfo queue_info({}, queue_family_, 1, &priority);
    // Not one struct for all of Vulkan 1.2, since whoever makes the device may add structs for single
    // features, which must not appear together with it.
    vk::PhysicalDeviceScalarBlockLayoutFeatures scalar_layout(VK_TRUE);
    vk::PhysicalDeviceBufferDeviceAddressFeatures addresses(VK_TRUE);
    scalar_layout.pNext = &addresses;
    addresses.pNext = options.device_features;
    void* features = &scalar_layout;
    std::vector<const char*> extensions;
    std::vector<const char*> all_wanted = options.device_extensions;
    all_wanted.push_back(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME);
    all_wanted.push_back(VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME);
    for (const vk::ExtensionProperties& offered : physical_device_.enumerateDeviceExtensionProperties()) {
        for (const char* wanted : all_wanted) {
            if (std::strcmp(offered.extensionName, wanted) != 0) { continue; }
            extensions.push_back(wanted);
            device_extensions_.insert(wanted);
        }
    }
    // What kernels request if it is available; see lib/group.glsl.
    const auto enable = [&]<typename Features>(const char* extension, Features& its) {
        if (!hasDeviceExtension(extension)) { return; }
        its = physical_device_.getFeatures2<vk::PhysicalDeviceFeatures2, Features>().template get<Features>();
        its.pNext = std::exchange(features, &its);
    };
    vk::PhysicalDeviceSubgroupSizeControlFeatures subgroups;
    enable(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME, subgroups);
    has_full_subgroups_ = subgroups.subgroupSizeControl && subgroups.computeFullSubgroups;
    vk::PhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR flow;
    enable(VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME, flow);
    has_subgroup_uniform_flow_ = flow.shaderSubgroupUniformControlFlow == VK_TRUE;
    vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics;
    enable(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME, statistics);
    kernel_statistics_ = statistics.pipelineExecutableInfo == VK_TRUE;
    const vk::DeviceCreateInfo info({}, queue_info, {}, extensions, nullptr, features);
    const DeviceMaker& maker = options.maker;
    device_ = maker.create_device
                  ? vk::raii::Device(physical_device_,
                                     maker.create_device(loader_->getDispatcher()->vkGetInstanceProcAddr,
                                                         *physical_device_, info))
                  : vk::raii::Device(physical_device_, info);
    queue_ = device_.getQueue(queue_family_, 0);
    pipeline_cache_ = PipelineCache(physical_device_, device_);
    readLimits();
}

void Context::readLimits() {
    const auto properties =
        physical_device_
            .getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties>();
    const auto& vulkan10 = properties.get<vk::PhysicalDeviceProperties2>().properties;
    const auto& vulkan11 = properties.get<vk::PhysicalDeviceVulkan11Properties>();
    device_name_ = std::string(vulkan10.deviceName.data());
    is_software_ = vulkan10.deviceType == vk::PhysicalDeviceType::eCpu;
    max_allocation_bytes_ = vulkan11.maxMemoryAllocationSize;
    subgroup_size_ = min_subgroup_size_ = max_subgroup_size_ = vulkan11.subgroupSize;
    if (vulkan10.apiVersion >= VK_API_VERSION_1_3 ||
        hasDeviceExtension(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME)) {
        const auto sizes = physical_device_.getProperties2<vk::PhysicalDeviceProperties2,
                                                           vk::PhysicalDeviceSubgroupSizeControlProperties>();
        min_subgroup_size_ = sizes.get<vk::PhysicalDeviceSubgroupSizeControlProperties>().minSubgroupSize;
        max_subgroup_size_ = sizes.get<vk::PhysicalDeviceSubgroupSizeControlProperties>().maxSubgroupSize;
    } else {  // some drivers vary the size between 8 and 32 without reporting it
        min_subgroup_size_ = std::min(8u, subgroup_size_);
        max_subgroup_size_ = std::max(32u, subgroup_size_);
    }
    if (vulkan10.apiVersion >= VK_API_VERSION_1_3) {
        const auto buffers =
            physical_device_
                .getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceMaintenance4Properties>();
        max_allocation_bytes_ = std::min(
            max_allocation_bytes_, buffers.get<vk::PhysicalDeviceMaintenance4Properties>().maxBufferSize);
    }
    const std::uint32_t bits = physical_device_.getQueueFamilyProperties()[queue_family_].timestampValidBits;
    shared_memory_ = vulkan10.limits.maxComputeSharedMemorySize;
    max_group_invocations_ =
        std::min(vulkan10.limits.maxComputeWorkGroupInvocations, vulkan10.limits.maxComputeWorkGroupSize[0]);
    timestamp_mask_ = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    if (bits > 0) { timestamp_period_ns_ = static_cast<double>(vulkan10.limits.timestampPeriod); }
}

std::span<const std::uint32_t> Context::shaderWords(std::string_view name) const {
    const auto found = replaced_shaders_.find(name);
    return found == replaced_shaders_.end() ? embeddedShader(name)
                                            : std::span<const std::uint32_t>(found->second);
}

vk::PipelineShaderStageCreateFlags Context::fullSubgroups(std::uint32_t local_size_x) const {
    using Flag = vk::PipelineShaderStageCreateFlagBits;
    if (!has_full_subgroups_ || local_size_x % max_subgroup_size_ != 0) { return {}; }
    // Of any width; otherwise some devices choose their widest, which is their slowest.
    return min_subgroup_size_ == max_subgroup_size_
               ? Flag::eRequireFullSubgroups
               : Flag::eRequireFullSubgroups | Flag::eAllowVaryingSubgroupSize;
}

void Context::waitForQueue() const {
    const std::lock_guard lock(queue_mutex_);
    queue_.waitIdle();
}

void Context::requireNoValidationMessages() const {
    const std::vector<std::string> messages = validationMessages();
    check(messages.empty(), "Vulkan validation: {} messages, the first: {}", messages.size(),
          messages.empty() ? "" : messages.front());
}

std::vector<std::string> Context::validationMessages() const {
    const std::lock_guard lock(messages_.mutex);
    return messages_.lines;
}

std::uint64_t Context::deviceMemoryBytes() const {
    const vk::PhysicalDeviceMemoryProperties memory = physical_device_.getMemoryProperties();
    std::uint64_t most = 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        const bool is_local =
            static_cast<bool>(memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal);
        if (is_local) { most = std::max<std::uint64_t>(most, memory.memoryHeaps[i].size); }
    }
    return most;
}

std::vector<std::uint32_t> Context::memoryTypes(std::uint32_t allowed_types, vk::MemoryPropertyFlags wanted,
                                                vk::MemoryPropertyFlags preferred) const {
    using Flag = vk::MemoryPropertyFlagBits;
    // These need a feature or a usage of their own.
    constexpr vk::MemoryPropertyFlags kSpecial =
        Flag::eProtected | Flag::eLazilyAllocated | Flag::eDeviceCoherentAMD | Flag::eDeviceUncachedAMD;
    const auto memory = physical_device_.getMemoryProperties();
    std::vector<std::uint32_t> found;
    for (const bool is_preferred : {true, false}) {
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
            const auto flags = memory.memoryTypes[i].propertyFlags;
            const bool will_do =
                (allowed_types & (1u << i)) != 0 && (flags & wanted) == wanted && !(flags & kSpecial);
            if (will_do && ((flags & preferred) == preferred) == is_preferred) { found.push_back(i); }
        }
    }
    if (found.empty()) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("{}: no memory of the kind {}", device_name_, vk::to_string(wanted)));
    }
    return found;
}

void Context::nameObject(vk::ObjectType type, std::uint64_t handle, const std::string& object_name) const {
    device_.setDebugUtilsObjectNameEXT(vk::DebugUtilsObjectNameInfoEXT(type, handle, object_name.c_str()));
}

}  // namespace binosplat
