// What Vulkan says when it fails, as an error of ours.
#pragma once

#include "engine/error.h"

#include <string>
#include <vulkan/vulkan.hpp>

namespace binosplat {

// Memory that is not there is the input's fault (exit code 1), all else the device's (3). `device` is its name.
Error deviceError(const std::string& device, const vk::SystemError& error);

}  // namespace binosplat
