// Building compute pipelines.
#include "engine/gpu/kernel.h"

#include "engine/error.h"

#include <algorithm>
#include <cassert>

namespace binosplat {

std::vector<std::uint32_t> KernelVariant::values() const {
    std::vector<std::uint32_t> values;
    for (const auto& [name, value] : constants) { values.push_back(value); }
    return values;
}

std::string nameInShader(std::string_view field) {
    if (field == "local_size_x") { return std::string(field); }
    std::string name = "k";
    bool begins_word = true;
    for (const char c : field) {
        if (c != '_') { name += begins_word ? static_cast<char>(c - 'a' + 'A') : c; }
        begins_word = c == '_';
    }
    return name;
}

void append(KernelTable& table, const KernelTable& more) { table.insert(table.end(), more.begin(), more.end()); }

Kernel::Kernel(const Context& context, const std::string& shader, std::uint32_t push_bytes, const std::vector<std::uint32_t>& constants,
               Keep keep)
    : push_bytes_(push_bytes) {
    const auto words = context.shaderWords(shader);
    assert(!words.empty() && push_bytes <= 128);
    assert(keep == Keep::kNothing || context.hasKernelStatistics());
    const vk::raii::ShaderModule module(context.device(), vk::ShaderModuleCreateInfo({}, words.size_bytes(), words.data()));
    const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, push_bytes);
    layout_ = vk::raii::PipelineLayout(context.device(), vk::PipelineLayoutCreateInfo({}, {}, range));
    std::vector<vk::SpecializationMapEntry> entries;
    for (std::uint32_t id = 0; id < constants.size(); ++id) { entries.emplace_back(id, id * sizeof(std::uint32_t), sizeof(std::uint32_t)); }
    const vk::SpecializationInfo specialization(static_cast<std::uint32_t>(entries.size()), entries.data(),
                                                constants.size() * sizeof(std::uint32_t), constants.data());
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &specialization);
    const auto flags =
        keep == Keep::kStatistics ? vk::PipelineCreateFlags(vk::PipelineCreateFlagBits::eCaptureStatisticsKHR) : vk::PipelineCreateFlags();
    // A driver may have no statistics of what it did not compile just now.
    const vk::raii::PipelineCache* cache = keep == Keep::kNothing ? &context.pipelineCache() : nullptr;
    try {
        pipeline_ = vk::raii::Pipeline(context.device(), cache, vk::ComputePipelineCreateInfo(flags, stage, *layout_));
    } catch (const vk::SystemError& error) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("{}: the driver does not take the shader {}: {}", context.deviceName(), shader, error.what()));
    }
    context.name(pipeline_, shader);
}

KernelStatistics Kernel::statistics(const Context& context) const {
    KernelStatistics statistics;
    const auto executables = context.device().getPipelineExecutablePropertiesKHR(vk::PipelineInfoKHR(*pipeline_));
    for (std::uint32_t i = 0; i < executables.size(); ++i) {
        for (const auto& one : context.device().getPipelineExecutableStatisticsKHR(vk::PipelineExecutableInfoKHR(*pipeline_, i))) {
            const std::string name(one.name.data());
            switch (one.format) {
                case vk::PipelineExecutableStatisticFormatKHR::eBool32:
                    statistics.emplace_back(name, one.value.b32 == VK_TRUE);
                    break;
                case vk::PipelineExecutableStatisticFormatKHR::eInt64:
                    statistics.emplace_back(name, std::int64_t{one.value.i64});
                    break;
                case vk::PipelineExecutableStatisticFormatKHR::eUint64:
                    statistics.emplace_back(name, std::uint64_t{one.value.u64});
                    break;
                case vk::PipelineExecutableStatisticFormatKHR::eFloat64:
                    statistics.emplace_back(name, one.value.f64);
                    break;
            }
        }
    }
    return statistics;
}

const Kernel& KernelCache::find(const std::string& shader, std::uint32_t push_bytes, const std::vector<std::uint32_t>& constants) {
    auto key = std::make_pair(shader, constants);
    auto found = kernels_.find(key);
    if (found == kernels_.end()) {
        assert(std::ranges::any_of(table_, [&](const KernelVariant& variant) {
            return variant.shader == shader && variant.push_bytes == push_bytes && variant.values() == constants;
        }));
        found = kernels_.emplace(std::move(key), Kernel(context_, shader, push_bytes, constants)).first;
    }
    return found->second;
}

void KernelCache::rebuild() {
    decltype(kernels_) anew;
    for (const auto& [key, kernel] : kernels_) { anew.emplace(key, Kernel(context_, key.first, kernel.pushBytes(), key.second)); }
    kernels_ = std::move(anew);
}

}  // namespace binosplat
