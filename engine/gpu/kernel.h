// A compute pipeline: a shader of shaders/ with its specialization constants.
#pragma once

#include "engine/gpu/context.h"
#include "engine/gpu/variants.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

class Kernel {
public:
    // Statistics come from VK_KHR_pipeline_executable_properties, only if Context::hasKernelStatistics.
    enum class Keep { kNothing, kStatistics };

    Kernel() = default;
    // Throws Error (ExitCode::kNoDevice) if the driver rejects it.
    Kernel(const Context& context, const KernelVariant& variant, Keep keep = Keep::kNothing)
        : Kernel(context, variant.shader, variant.push_bytes, variant.values(), keep) {}
    // `constants` are the values of constant_id 0, 1, 2 ...
    Kernel(const Context& context, const std::string& shader, std::uint32_t push_bytes,
           const std::vector<std::uint32_t>& constants = {}, Keep keep = Keep::kNothing);

    [[nodiscard]] vk::Pipeline pipeline() const { return *pipeline_; }
    [[nodiscard]] vk::PipelineLayout layout() const { return *layout_; }
    [[nodiscard]] std::uint32_t pushBytes() const { return push_bytes_; }
    // What it requests of its subgroups; see Context::fullSubgroups.
    [[nodiscard]] vk::PipelineShaderStageCreateFlags subgroups() const { return subgroups_; }

private:
    vk::raii::PipelineLayout layout_{nullptr};
    vk::raii::Pipeline pipeline_{nullptr};
    std::uint32_t push_bytes_ = 0;
    vk::PipelineShaderStageCreateFlags subgroups_;
};

// Kernels, made when they are first needed: a mode does not pay for another's. For any thread.
class KernelCache {
public:
    // `table`: all kernels that will ever be requested.
    KernelCache(const Context& context, KernelTable table) : context_(context), table_(std::move(table)) {}
    // One of the table; the reference stays valid until rebuild().
    template <typename K>
    const Kernel& get(const K& kernel) {
        return find(K::kShader, sizeof(typename K::Pass), valuesOf(kernel));
    }
    [[nodiscard]] const KernelTable& table() const { return table_; }
    [[nodiscard]] std::size_t size() const {
        const std::lock_guard lock(mutex_);
        return kernels_.size();
    }
    // Makes all of them again, see Context::replacedShaders, while nobody uses any. Throws as Kernel does,
    // and then keeps the old ones.
    void rebuild();

private:
    const Kernel& find(const std::string& shader, std::uint32_t push_bytes,
                       const std::vector<std::uint32_t>& constants);

    const Context& context_;
    KernelTable table_;
    mutable std::mutex mutex_;  // guards the map, not what it holds
    std::map<std::pair<std::string, std::vector<std::uint32_t>>, Kernel> kernels_;
};

}  // namespace binosplat
