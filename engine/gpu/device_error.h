// A failure of Vulkan as an Error.
#pragma once

#include "engine/error.h"

#include <string>
#include <vulkan/vulkan.hpp>

namespace binosplat {

// A lack of memory is the input's fault (exit code 1), anything else the device's (3). `device` is its name.
Error deviceError(const std::string& device, const vk::SystemError& error);

}  // namespace binosplat
