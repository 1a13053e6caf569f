// The shaders that the program carries along, as SPIR-V.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace binosplat {

// The words of shaders/FOLDER/NAME.comp; empty if there is no such shader.
std::span<const std::uint32_t> embeddedShader(std::string_view name);
// The folder and the name of each, in frame order.
std::vector<std::pair<std::string_view, std::string_view>> embeddedShaderNames();

}  // namespace binosplat
