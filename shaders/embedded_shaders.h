// The shaders that the program carries along, as SPIR-V.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace binosplat {

// The words of shaders/NAME.comp; empty if there is no such shader.
std::span<const std::uint32_t> embeddedShader(std::string_view name);
// All of them, in frame order.
std::vector<std::string_view> embeddedShaderNames();

}  // namespace binosplat
