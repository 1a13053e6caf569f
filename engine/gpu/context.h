// The Vulkan device: choosing and opening it, and what it can do. One queue; no descriptor sets anywhere.
#pragma once

#include "engine/gpu/foreign_device.h"
#include "engine/gpu/freed_buffers.h"
#include "engine/gpu/pipeline_cache.h"

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace binosplat {

// Creates the instance and the device and chooses the GPU in our place: an OpenXR runtime. All three
// functions, or none.
struct DeviceMaker {
    std::function<VkInstance(PFN_vkGetInstanceProcAddr, const VkInstanceCreateInfo&)> create_instance;
    std::function<VkPhysicalDevice(VkInstance)> choose_device;
    std::function<VkDevice(PFN_vkGetInstanceProcAddr, VkPhysicalDevice, const VkDeviceCreateInfo&)>
        create_device;
};

struct ContextOptions {
    // Index, or part of a name; empty: the first discrete GPU, or else the first device that will do.
    std::string device;
    // Khronos validation with synchronization checks; also BINOSPLAT_VALIDATION=1 in the environment
    bool validation = false;
    // Limit for one allocation; 0: what the device allows.
    std::uint64_t max_allocation_bytes = 0;
    // Limit for all buffers together; 0: what the device has.
    std::uint64_t memory_limit_bytes = 0;
    // Makes the device in place of Vulkan itself; `device` then has no effect.
    DeviceMaker maker = {};
    const ForeignDevice* foreign = nullptr;  // in place of everything else
    // Extensions in addition to those that the passes need; must be literals.
    std::vector<const char*> instance_extensions = {};
    std::vector<const char*> device_extensions = {};  // likewise, but only those that the device has
    void* device_features = nullptr;                  // also enable these: a chain of feature structs
};

// Shaders by name, as SPIR-V.
using ShaderWords = std::map<std::string, std::vector<std::uint32_t>, std::less<>>;

class Context {
public:
    // Throws Error with ExitCode::kNoDevice if there is no loader, no device, or none with what the passes
    // need.
    explicit Context(const ContextOptions& options = {});
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    // Prints to stderr what the validation layers find only now, above all leaks.
    ~Context();

    [[nodiscard]] const vk::raii::Instance& instance() const { return instance_; }
    [[nodiscard]] const vk::raii::Device& device() const { return device_; }
    [[nodiscard]] const vk::raii::PhysicalDevice& physicalDevice() const { return physical_device_; }
    [[nodiscard]] const vk::raii::Queue& queue() const { return queue_; }
    [[nodiscard]] std::uint32_t queueFamily() const { return queue_family_; }
    // Hold this while using the queue, directly or through OpenXR: another thread may be uploading a scene.
    [[nodiscard]] QueueMutex& queueMutex() const { return queue_mutex_; }
    void waitForQueue() const;
    [[nodiscard]] const std::string& deviceName() const { return device_name_; }
    // True if it is a CPU implementation, not a GPU.
    [[nodiscard]] bool isSoftware() const { return is_software_; }
    [[nodiscard]] std::uint64_t maxAllocationBytes() const { return max_allocation_bytes_; }
    // The device's own memory, in its largest heap.
    [[nodiscard]] std::uint64_t deviceMemoryBytes() const;
    // For memoryUse(); 0: none.
    [[nodiscard]] std::uint64_t memoryLimitBytes() const { return memory_limit_bytes_; }
    // Nanoseconds per step of a timestamp; 0 if the queue has none.
    [[nodiscard]] double timestampPeriodNs() const { return timestamp_period_ns_; }
    // The valid bits of a timestamp.
    [[nodiscard]] std::uint64_t timestampMask() const { return timestamp_mask_; }
    [[nodiscard]] std::uint32_t subgroupSize() const { return subgroup_size_; }
    [[nodiscard]] std::uint32_t minSubgroupSize() const { return min_subgroup_size_; }
    [[nodiscard]] std::uint32_t maxSubgroupSize() const { return max_subgroup_size_; }
    // What a kernel with workgroups of this width requests from the device: subgroups without idle lanes, if
    // possible. 0: nothing.
    [[nodiscard]] vk::PipelineShaderStageCreateFlags fullSubgroups(std::uint32_t local_size_x) const;
    // True if SPV_KHR_subgroup_uniform_control_flow may be used.
    [[nodiscard]] bool hasSubgroupUniformFlow() const { return has_subgroup_uniform_flow_; }
    // For a workgroup that extends along x.
    [[nodiscard]] std::uint32_t maxGroupInvocations() const { return max_group_invocations_; }
    // Per workgroup, in bytes.
    [[nodiscard]] std::uint32_t sharedMemory() const { return shared_memory_; }
    [[nodiscard]] bool validates() const { return validates_; }
    // True if names and labels go into captures and messages: VK_EXT_debug_utils.
    [[nodiscard]] bool hasLabels() const { return labels_; }
    // Throws Error if the validation layers have reported anything so far.
    void requireNoValidationMessages() const;
    // The layers' messages so far; empty is good.
    [[nodiscard]] std::vector<std::string> validationMessages() const;

    // The words of shaders/NAME.comp for kernels made from now on: a replacement, or the embedded ones.
    [[nodiscard]] std::span<const std::uint32_t> shaderWords(std::string_view name) const;
    // For work on the shaders while the program runs; otherwise empty. Existing kernels stay as they are.
    [[nodiscard]] ShaderWords& replacedShaders() const { return replaced_shaders_; }

    [[nodiscard]] const vk::raii::PipelineCache& pipelineCache() const { return pipeline_cache_.handle(); }

    [[nodiscard]] MemoryUse& memoryUse() const { return memory_use_; }
    [[nodiscard]] FreedBuffers& freedBuffers() const { return freed_buffers_; }
    // The suitable types among those allowed for a buffer or an image, preferred ones first. Throws Error if
    // there are none.
    [[nodiscard]] std::vector<std::uint32_t> memoryTypes(std::uint32_t allowed_types,
                                                         vk::MemoryPropertyFlags wanted,
                                                         vk::MemoryPropertyFlags preferred) const;
    [[nodiscard]] std::uint32_t memoryType(std::uint32_t allowed_types, vk::MemoryPropertyFlags wanted,
                                           vk::MemoryPropertyFlags preferred) const {
        return memoryTypes(allowed_types, wanted, preferred).front();
    }

    // True if a device extension was requested and is available.
    [[nodiscard]] bool hasDeviceExtension(const std::string& extension) const {
        return device_extensions_.contains(extension);
    }

    // True if the driver reports statistics of kernels; only if VK_KHR_pipeline_executable_properties was
    // requested.
    [[nodiscard]] bool hasKernelStatistics() const { return kernel_statistics_; }

    // Gives a Vulkan object its name in validation messages and captures.
    template <typename Handle>
    void name(const Handle& handle, const std::string& object_name) const {
        if (!labels_) { return; }
        using Raw = std::remove_cvref_t<decltype(*handle)>;
        nameObject(Raw::objectType,
                   reinterpret_cast<std::uint64_t>(static_cast<typename Raw::CType>(*handle)), object_name);
    }

private:
    void createInstance(const ContextOptions& options, bool validation);
    void choosePhysicalDevice(const std::string& wanted);
    void takePhysicalDevice(const DeviceMaker& maker);
    void requireFeatures(const char* which) const;
    void createDevice(const ContextOptions& options);
    void adopt(const ForeignDevice& foreign);
    void readLimits();
    void nameObject(vk::ObjectType type, std::uint64_t handle, const std::string& object_name) const;

    std::function<void(const char*)> sink_;  // where the messenger writes; it holds this address
    struct Messages {
        mutable std::mutex mutex;
        std::vector<std::string> lines;
    };

    bool validates_ = false, labels_ = false, kernel_statistics_ = false;
    Messages messages_;
    std::optional<vk::raii::Context> loader_;
    vk::raii::Instance instance_{nullptr};
    vk::raii::DebugUtilsMessengerEXT messenger_{nullptr};
    vk::raii::PhysicalDevice physical_device_{nullptr};
    vk::raii::Device device_{nullptr};
    PipelineCache pipeline_cache_;
    vk::raii::Queue queue_{nullptr};
    mutable QueueMutex queue_mutex_;
    std::uint32_t queue_family_ = 0;
    std::string device_name_;
    bool is_software_ = false, has_full_subgroups_ = false, has_subgroup_uniform_flow_ = false;
    std::set<std::string> device_extensions_;
    std::uint64_t max_allocation_bytes_ = 0, memory_limit_bytes_ = 0;
    double timestamp_period_ns_ = 0.0;
    std::uint64_t timestamp_mask_ = 0;
    std::uint32_t subgroup_size_ = 0, min_subgroup_size_ = 0, max_subgroup_size_ = 0;
    std::uint32_t max_group_invocations_ = 0, shared_memory_ = 0;
    mutable MemoryUse memory_use_;
    mutable FreedBuffers freed_buffers_{memory_use_};
    mutable ShaderWords replaced_shaders_;
};

}  // namespace binosplat
