// XR_KHR_composition_layer_depth: an eye's depth along with its picture.
#pragma once

#include "xr/swapchain.h"

#include <limits>

namespace binosplat::xr {

// Reversed, with an infinite far plane: 0 is infinitely far, 1 is `near_m`, the near plane.
inline XrCompositionLayerDepthInfoKHR depthInfo(const XrSwapchainSubImage& depth, double near_m) {
    auto info = structure<XrCompositionLayerDepthInfoKHR>(XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR);
    info.subImage = depth;
    info.minDepth = 0.0f;
    info.maxDepth = 1.0f;
    info.nearZ = std::numeric_limits<float>::infinity();
    info.farZ = static_cast<float>(near_m);
    return info;
}

}  // namespace binosplat::xr
