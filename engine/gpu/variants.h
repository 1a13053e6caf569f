// The kernels of shaders/passes.def as types: RasterizeKernel{.depth = 1} is shaders/splat/rasterize.comp
// compiled with kDepth true.
#pragma once

#include "shaders/shared/passes.h"

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace binosplat {

// The parts of a frame: the folders of shaders/.
enum class FrameStage { kSort, kSplat, kWarp, kChoose, kPresent };

constexpr FrameStage stageOfFolder(std::string_view folder) {
    constexpr std::array<std::string_view, 5> kFolders{"sort", "splat", "warp", "choose", "present"};
    std::size_t stage = 0;
    while (kFolders.at(stage) != folder) { ++stage; }
    return static_cast<FrameStage>(stage);
}

// A constant for which a shader is specialized, and how many values it has, from 0 on; 0: the device decides.
struct ShaderConstant {
    const char* field;
    std::uint32_t count;
};

// For a PASS line: one field per constant, in the order of their ids, and nothing else.
#define CONSTANT(field, count) std::uint32_t field = 0;
#define PASS(folder, shader, Name, Struct, ...)                      \
    struct Name##Kernel {                                            \
        using Pass = gpu::Struct;                                    \
        static constexpr const char* kShader = #shader;              \
        static constexpr FrameStage kStage = stageOfFolder(#folder); \
        static constexpr auto constants();                           \
        __VA_ARGS__                                                  \
    };
#include "shaders/passes.def"
#undef PASS
#undef CONSTANT

#define CONSTANT(field, count) ShaderConstant{#field, count},
#define PASS(folder, shader, Name, Struct, ...)                                                      \
    constexpr auto Name##Kernel::constants() {                                                       \
        constexpr std::size_t kCount = std::is_empty_v<Name##Kernel> ? 0 : sizeof(Name##Kernel) / 4; \
        return std::array<ShaderConstant, kCount>{__VA_ARGS__};                                      \
    }
#include "shaders/passes.def"
#undef PASS
#undef CONSTANT

// constant_id 0, 1, 2 ...
template <typename K>
std::vector<std::uint32_t> valuesOf(const K& kernel) {
    constexpr std::size_t kCount = K::constants().size();
    if constexpr (kCount == 0) {
        return {};
    } else {
        const auto values = std::bit_cast<std::array<std::uint32_t, kCount>>(kernel);
        return {values.begin(), values.end()};
    }
}

// A kernel before it is made.
struct KernelVariant {
    std::string shader;
    std::uint32_t push_bytes;                                      // the size of the pass struct it takes
    std::vector<std::pair<std::string, std::uint32_t>> constants;  // by their names in the shader

    [[nodiscard]] std::vector<std::uint32_t> values() const;
};

// The shader's name for the constant of a field: kDepthChoice for depth_choice.
std::string nameInShader(std::string_view field);

template <typename K>
KernelVariant variantOf(const K& kernel) {
    KernelVariant variant{K::kShader, sizeof(typename K::Pass), {}};
    const std::vector<std::uint32_t> values = valuesOf(kernel);
    for (std::size_t i = 0; i < values.size(); ++i) {
        variant.constants.emplace_back(nameInShader(K::constants()[i].field), values[i]);
    }
    return variant;
}

// All kernels used in any mode: each group of passes lists its own, and `binosplat kernels` makes all of
// them.
using KernelTable = std::vector<KernelVariant>;

void append(KernelTable& table, const KernelTable& more);

// A shader in every combination of its constants that `is_used` accepts; the device must not decide any of
// them. The last changes fastest.
template <typename K>
KernelTable everyVariant(const std::function<bool(const K&)>& is_used = [](const K&) { return true; }) {
    constexpr auto kConstants = K::constants();
    KernelTable table;
    std::array<std::uint32_t, kConstants.size()> values{};
    for (bool more = true; more;) {
        K kernel;
        if constexpr (kConstants.size() > 0) { kernel = std::bit_cast<K>(values); }
        if (is_used(kernel)) { table.push_back(variantOf(kernel)); }
        more = false;
        for (std::size_t i = values.size(); i-- > 0 && !more;) {
            more = ++values[i] < kConstants[i].count;
            if (!more) { values[i] = 0; }
        }
    }
    return table;
}

template <typename... K>
KernelTable everyVariantOf() {
    KernelTable table;
    (append(table, everyVariant<K>()), ...);
    return table;
}

}  // namespace binosplat
