// Builds compute pipelines.
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

void append(KernelTable& table, const KernelTable& more) {
    table.insert(table.end(), more.begin(), more.end());
}

namespace {

// Of SPIR-V, chapter 3.
constexpr std::uint32_t kExtension = 10, kExecutionMode = 16, kConstantTrue = 41, kConstantFalse = 42,
                        kConstant = 43, kConstantComposite = 44, kSpecConstantTrue = 48,
                        kSpecConstantFalse = 49, kSpecConstant = 50, kSpecConstantComposite = 51,
                        kDecorate = 71;
constexpr std::uint32_t kSpecId = 1, kBuiltIn = 11, kLocalSize = 17, kWorkgroupSize = 25,
                        kSubgroupUniformFlow = 4421;
constexpr std::string_view kUniformFlowExtension = "SPV_KHR_subgroup_uniform_control_flow";
constexpr std::size_t kHeaderWords = 5;

// Calls `take` with each instruction and its opcode.
template <typename Take>
void eachInstruction(std::span<const std::uint32_t> words, const Take& take) {
    check(words.size() >= kHeaderWords, "a shader of {} words, too few for one", words.size());
    for (std::size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16) {
        const bool is_whole = words[at] >> 16 > 0 && (words[at] >> 16) <= words.size() - at;
        check(is_whole, "a shader of {} words that breaks off at word {}", words.size(), at);
        take(words.subspan(at, words[at] >> 16), words[at] & 0xffff);
    }
}

// A shader with these values of constant_id 0, 1, 2 ..., as plain constants. VkSpecializationInfo will not
// do, since some drivers do their slow work before they remove what a value rules out: SwiftShader then takes
// a minute for a variant of resample. Without `has_uniform_flow` the shader does not ask for subgroup-uniform
// control flow.
std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> words,
                                      const std::vector<std::uint32_t>& values, bool has_uniform_flow) {
    std::map<std::uint32_t, std::uint32_t> value_of;  // by the constant's id
    std::vector<std::uint32_t> specialized(words.begin(),
                                           words.begin() + std::min(words.size(), kHeaderWords));
    eachInstruction(words, [&](std::span<const std::uint32_t> instruction, std::uint32_t opcode) {
        if (opcode == kDecorate && instruction[2] == kSpecId) {
            if (instruction[3] < values.size()) { value_of[instruction[1]] = values[instruction[3]]; }
            return;  // decorations come before what they decorate
        }
        const bool is_of_flow =
            opcode == kExtension
                ? std::string_view(reinterpret_cast<const char*>(&instruction[1])) == kUniformFlowExtension
                : opcode == kExecutionMode && instruction[2] == kSubgroupUniformFlow;
        if (is_of_flow && !has_uniform_flow) { return; }
        const auto put = [&](std::uint32_t other) {
            specialized.push_back((instruction[0] & 0xffff0000) | other);
        };
        const auto found = opcode >= kSpecConstantTrue && opcode <= kSpecConstant
                               ? value_of.find(instruction[2])
                               : value_of.end();
        switch (opcode) {
            case kSpecConstantTrue:
            case kSpecConstantFalse:
                put((found != value_of.end() ? found->second != 0 : opcode == kSpecConstantTrue)
                        ? kConstantTrue
                        : kConstantFalse);
                break;
            case kSpecConstant:
                put(kConstant);
                break;
            default:
                put(opcode);
        }
        specialized.insert(specialized.end(), instruction.begin() + 1, instruction.end());
        if (opcode == kSpecConstant && found != value_of.end()) { specialized.back() = found->second; }
    });
    return specialized;
}

// The width of its workgroups: a literal, or the first part of the constant that stands for all three.
std::uint32_t localSizeX(std::span<const std::uint32_t> words) {
    std::uint32_t size = 0, id_of_sizes = 0;
    std::map<std::uint32_t, std::uint32_t> value_of;
    eachInstruction(words, [&](std::span<const std::uint32_t> instruction, std::uint32_t opcode) {
        if (opcode == kExecutionMode && instruction[2] == kLocalSize) { size = instruction[3]; }
        if (opcode == kDecorate && instruction[2] == kBuiltIn && instruction[3] == kWorkgroupSize) {
            id_of_sizes = instruction[1];
        }
        if (opcode == kConstant) { value_of[instruction[2]] = instruction[3]; }
        const bool is_composite = opcode == kConstantComposite || opcode == kSpecConstantComposite;
        if (is_composite && instruction[2] == id_of_sizes) { size = value_of[instruction[3]]; }
    });
    return size;
}

}  // namespace

Kernel::Kernel(const Context& context, const std::string& shader, std::uint32_t push_bytes,
               const std::vector<std::uint32_t>& constants, Keep keep)
    : push_bytes_(push_bytes) {
    const auto general = context.shaderWords(shader);
    assert(!general.empty() && push_bytes <= 128);
    assert(keep == Keep::kNothing || context.hasKernelStatistics());
    const std::vector<std::uint32_t> words = specialize(general, constants, context.hasSubgroupUniformFlow());
    subgroups_ = context.fullSubgroups(localSizeX(words));
    const vk::raii::ShaderModule module(
        context.device(), vk::ShaderModuleCreateInfo({}, words.size() * sizeof(words[0]), words.data()));
    const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, push_bytes);
    layout_ = vk::raii::PipelineLayout(context.device(), vk::PipelineLayoutCreateInfo({}, {}, range));
    const vk::PipelineShaderStageCreateInfo stage(subgroups_, vk::ShaderStageFlagBits::eCompute, *module,
                                                  "main");
    const auto flags = keep == Keep::kStatistics
                           ? vk::PipelineCreateFlags(vk::PipelineCreateFlagBits::eCaptureStatisticsKHR)
                           : vk::PipelineCreateFlags();
    // A driver may have no statistics of a kernel that it did not just compile.
    const vk::raii::PipelineCache* cache = keep == Keep::kNothing ? &context.pipelineCache() : nullptr;
    try {
        pipeline_ = vk::raii::Pipeline(context.device(), cache,
                                       vk::ComputePipelineCreateInfo(flags, stage, *layout_));
    } catch (const vk::SystemError& error) {
        throw Error(ExitCode::kNoDevice, fmt::format("{}: the driver does not accept the shader {}: {}",
                                                     context.deviceName(), shader, error.what()));
    }
    context.name(pipeline_, shader);
}

const Kernel& KernelCache::find(const std::string& shader, std::uint32_t push_bytes,
                                const std::vector<std::uint32_t>& constants) {
    auto key = std::make_pair(shader, constants);
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = kernels_.find(key); found != kernels_.end()) { return found->second; }
    }
    assert(std::ranges::any_of(table_, [&](const KernelVariant& variant) {
        return variant.shader == shader && variant.push_bytes == push_bytes && variant.values() == constants;
    }));
    // Unlocked, since a compiler takes long: of two threads that make the same one, the first keeps it.
    Kernel made(context_, shader, push_bytes, constants);
    const std::lock_guard lock(mutex_);
    return kernels_.try_emplace(std::move(key), std::move(made)).first->second;
}

void KernelCache::rebuild() {
    const std::lock_guard lock(mutex_);
    decltype(kernels_) anew;
    for (const auto& [key, kernel] : kernels_) {
        anew.emplace(key, Kernel(context_, key.first, kernel.pushBytes(), key.second));
    }
    kernels_ = std::move(anew);
}

}  // namespace binosplat
