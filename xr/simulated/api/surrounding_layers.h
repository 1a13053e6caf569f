// XR_KHR_composition_layer_cylinder, _equirect2 and _cube: layers that surround the wearer. Also what all
// layers with one picture share.
#pragma once

#include "xr/simulated/api/layers.h"
#include "xr/simulated/api/swapchains.h"

namespace simulated {

// True if this is one of these layers, and its extension is enabled.
bool isSurrounding(const Session& session, XrStructureType type);
void checkSurrounding(const Session& session, const XrCompositionLayerBaseHeader& layer);
Layer makeSurroundingLayer(const Session& session, const XrCompositionLayerBaseHeader& layer,
                           const Pose& stage_from_space);
void logSurrounding(const Session& session, const XrCompositionLayerBaseHeader& layer, LoggedLayer& entry);

// XR_ERROR_VALIDATION_FAILURE.
void checkEyeVisibility(XrEyeVisibility visibility);
Visibility visibilityOf(XrEyeVisibility visibility);
const char* nameOf(XrEyeVisibility visibility);
// XR_ERROR_LAYER_INVALID, XR_ERROR_SWAPCHAIN_RECT_INVALID ...: must be a colour picture, not a cube map.
void checkPicture(const Session& session, const XrSwapchainSubImage& image);
// One array layer (or face) of the image on show.
Picture pictureOf(Swapchain& swapchain, std::uint32_t array_layer);
Rect rectOf(const XrRect2Di& rect);
Blending blendingOf(XrCompositionLayerFlags flags);
LoggedView loggedImage(const Session& session, const XrSwapchainSubImage& image);

template <class T>
const T& as(const XrCompositionLayerBaseHeader& layer) {
    return reinterpret_cast<const T&>(layer);
}

}  // namespace simulated
