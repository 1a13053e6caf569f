// The extensions that this runtime offers, by name: instances enable them, scripts take them away.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace simulated {

struct Extension {
    const char* name;
    std::uint32_t version;
};

inline constexpr Extension kExtensions[] = {
    {"XR_KHR_vulkan_enable2", 2},
    {"XR_KHR_vulkan_enable", 8},
    {"XR_KHR_composition_layer_depth", 5},
    {"XR_KHR_visibility_mask", 2},
};

[[nodiscard]] constexpr bool isExtension(std::string_view name) {
    for (const Extension& extension : kExtensions) {
        if (name == extension.name) { return true; }
    }
    return false;
}

}  // namespace simulated
