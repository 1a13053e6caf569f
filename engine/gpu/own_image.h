// Images that are no swapchain's.
#pragma once

#include "engine/gpu/context.h"

#include <glm/glm.hpp>

namespace binosplat {

// An image of one level, in memory of its own.
struct OwnImage {
    OwnImage(const Context& context, const char* name, glm::uvec2 size_px, vk::Format format,
             vk::ImageUsageFlags usage);
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::Image image{nullptr};
};

}  // namespace binosplat
