// Chooses size, format and alpha.
#include "app/view/window/window_surface.h"

#include <algorithm>
#include <array>

namespace binosplat {

std::optional<vk::Extent2D> windowExtent(const vk::SurfaceCapabilitiesKHR& able, vk::Extent2D window) {
    vk::Extent2D extent = able.currentExtent;
    if (extent.width == UINT32_MAX || extent.height == UINT32_MAX) {
        extent.width = std::clamp(window.width, able.minImageExtent.width,
                                  std::max(able.minImageExtent.width, able.maxImageExtent.width));
        extent.height = std::clamp(window.height, able.minImageExtent.height,
                                   std::max(able.minImageExtent.height, able.maxImageExtent.height));
    }
    const bool is_there = extent.width > 0 && extent.height > 0 && window.width > 0 && window.height > 0;
    return is_there ? std::optional(extent) : std::nullopt;
}

std::optional<vk::SurfaceFormatKHR> windowFormat(std::span<const vk::SurfaceFormatKHR> offered) {
    using Format = vk::Format;
    // UNORM formats, which show encoded values as they are, of eight bits or more.
    static constexpr std::array kWanted{Format::eB8G8R8A8Unorm,          Format::eR8G8B8A8Unorm,
                                        Format::eA8B8G8R8UnormPack32,    Format::eA2B10G10R10UnormPack32,
                                        Format::eA2R10G10B10UnormPack32, Format::eR16G16B16A16Unorm};
    for (const Format wanted : kWanted) {
        const auto found =
            std::ranges::find(offered, vk::SurfaceFormatKHR(wanted, vk::ColorSpaceKHR::eSrgbNonlinear));
        if (found != offered.end()) { return *found; }
    }
    // The old way of saying that any format will do.
    if (offered.size() == 1 && offered[0].format == Format::eUndefined) {
        return vk::SurfaceFormatKHR{kWanted[0], offered[0].colorSpace};
    }
    return std::nullopt;
}

vk::CompositeAlphaFlagBitsKHR windowAlpha(vk::CompositeAlphaFlagsKHR offered) {
    using Alpha = vk::CompositeAlphaFlagBitsKHR;
    for (const Alpha wanted : {Alpha::eOpaque, Alpha::eInherit, Alpha::ePreMultiplied}) {
        if (offered & wanted) { return wanted; }
    }
    return Alpha::ePostMultiplied;
}

}  // namespace binosplat
