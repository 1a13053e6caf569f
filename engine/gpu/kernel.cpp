// Building compute pipelines.
#include "engine/gpu/kernel.h"

#include "engine/error.h"

#include <cassert>

namespace binosplat {

Kernel::Kernel(const Context& context, std::string_view shader, std::uint32_t push_bytes, std::span<const std::uint32_t> constants)
    : push_bytes_(push_bytes) {
    const auto words = context.shaderWords(shader);
    assert(!words.empty() && push_bytes <= 128);
    const vk::raii::ShaderModule module(context.device(), vk::ShaderModuleCreateInfo({}, words.size_bytes(), words.data()));
    const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, push_bytes);
    layout_ = vk::raii::PipelineLayout(context.device(), vk::PipelineLayoutCreateInfo({}, {}, range));
    std::vector<vk::SpecializationMapEntry> entries;
    for (std::uint32_t id = 0; id < constants.size(); ++id) { entries.emplace_back(id, id * sizeof(std::uint32_t), sizeof(std::uint32_t)); }
    const vk::SpecializationInfo specialization(static_cast<std::uint32_t>(entries.size()), entries.data(), constants.size_bytes(),
                                                constants.data());
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &specialization);
    try {
        pipeline_ = vk::raii::Pipeline(context.device(), nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout_));
    } catch (const vk::SystemError& error) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("{}: the driver does not take the shader {}: {}", context.deviceName(), shader, error.what()));
    }
    context.name(pipeline_, std::string(shader));
}

const Kernel& KernelCache::get(const char* shader, std::uint32_t push_bytes, std::initializer_list<std::uint32_t> constants) {
    auto key = std::make_pair(std::string(shader), std::vector<std::uint32_t>(constants));
    auto found = kernels_.find(key);
    if (found == kernels_.end()) { found = kernels_.emplace(std::move(key), Kernel(context_, shader, push_bytes, constants)).first; }
    return found->second;
}

void KernelCache::rebuild() {
    decltype(kernels_) anew;
    for (const auto& [key, kernel] : kernels_) {
        anew.emplace(key, Kernel(context_, key.first, kernel.pushBytes(), std::span<const std::uint32_t>(key.second)));
    }
    kernels_ = std::move(anew);
}

}  // namespace binosplat
