// What a display offers for a window's pictures, and what is taken of it.
#pragma once

#include <vulkan/vulkan.hpp>

#include <optional>
#include <span>

namespace binosplat {

// How large pictures are: as the compositor says, or where it leaves that to the program (Wayland says 0xffffffff) as the window is, within
// what it allows. Empty while there is nothing to draw on, as of a window that is put away.
std::optional<vk::Extent2D> windowExtent(const vk::SurfaceCapabilitiesKHR& able, vk::Extent2D window);

// A format that shows bytes as they are; empty where there is none.
std::optional<vk::SurfaceFormatKHR> windowFormat(std::span<const vk::SurfaceFormatKHR> offered);

// Opaque where it can be had, since what lies behind the window is not to be seen.
vk::CompositeAlphaFlagBitsKHR windowAlpha(vk::CompositeAlphaFlagsKHR offered);

}  // namespace binosplat
