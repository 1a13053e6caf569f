// A compute pipeline: a shader of shaders/ with its specialization constants.
#pragma once

#include "engine/gpu/context.h"

#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace binosplat {

class Kernel {
public:
    Kernel() = default;
    // `shader` names shaders/NAME.comp; `constants` are the values of constant_id 0, 1, 2 ... ; `push_bytes` is the size of the
    // pass struct it takes.
    Kernel(const Context& context, std::string_view shader, std::uint32_t push_bytes, std::initializer_list<std::uint32_t> constants = {})
        : Kernel(context, shader, push_bytes, std::span(constants.begin(), constants.size())) {}
    Kernel(const Context& context, std::string_view shader, std::uint32_t push_bytes, std::span<const std::uint32_t> constants);

    [[nodiscard]] vk::Pipeline pipeline() const { return *pipeline_; }
    [[nodiscard]] vk::PipelineLayout layout() const { return *layout_; }
    [[nodiscard]] std::uint32_t pushBytes() const { return push_bytes_; }

private:
    vk::raii::PipelineLayout layout_{nullptr};
    vk::raii::Pipeline pipeline_{nullptr};
    std::uint32_t push_bytes_ = 0;
};

// Kernels, made when they are first wanted: a mode does not pay for another's.
class KernelCache {
public:
    explicit KernelCache(const Context& context) : context_(context) {}
    // The kernel of a shader and its specialization constants; the reference stays valid until rebuild().
    const Kernel& get(const char* shader, std::uint32_t push_bytes, std::initializer_list<std::uint32_t> constants = {});
    // Makes all of them anew, see Context::replacedShaders. Throws as Kernel does, and keeps the old ones then.
    void rebuild();

private:
    const Context& context_;
    std::map<std::pair<std::string, std::vector<std::uint32_t>>, Kernel> kernels_;
};

}  // namespace binosplat
