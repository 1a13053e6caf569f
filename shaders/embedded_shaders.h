// The shaders that the program carries along, as SPIR-V.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace binosplat {

// The words of shaders/NAME.comp; empty if there is no such shader.
std::span<const std::uint32_t> embeddedShader(std::string_view name);

}  // namespace binosplat
