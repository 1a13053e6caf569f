// Chooses from a display's offers for a window's pictures.
#pragma once

#include <vulkan/vulkan.hpp>

#include <optional>
#include <span>

namespace binosplat {

// The size of pictures: the compositor's or, if it leaves that to the program (Wayland reports 0xffffffff),
// the window's, within the allowed range. Empty while there is nothing to draw on, as when the window is
// minimized.
std::optional<vk::Extent2D> windowExtent(const vk::SurfaceCapabilitiesKHR& able, vk::Extent2D window);

// A format that shows bytes as they are; empty if there is none.
std::optional<vk::SurfaceFormatKHR> windowFormat(std::span<const vk::SurfaceFormatKHR> offered);

// Opaque if available, since the desktop behind the window must not show through.
vk::CompositeAlphaFlagBitsKHR windowAlpha(vk::CompositeAlphaFlagsKHR offered);

}  // namespace binosplat
