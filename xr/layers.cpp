// Filling in the layers.
#include "xr/layers.h"

#include "xr/convert.h"
#include "xr/extensions/depth_layer.h"

namespace binosplat::xr {

void Layers::addEyes(const std::array<LayerEye, 2>& eyes, bool see_through) {
    for (std::size_t e = 0; e < 2; ++e) {
        eyes_[e] = {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, nullptr, eyes[e].view.pose, eyes[e].view.fov,
                    eyes[e].colour->subImage(eyes[e].part_px)};
        if (eyes[e].depth == nullptr) { continue; }
        depths_[e] = depthInfo(eyes[e].depth->subImage(eyes[e].part_px), eyes[e].near_m);
        eyes_[e].next = &depths_[e];
    }
    const XrCompositionLayerFlags flags = see_through ? XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT : 0;
    scene_ = {XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, flags, session_.space(), 2, eyes_.data()};
    list_.push_back(reinterpret_cast<const XrCompositionLayerBaseHeader*>(&scene_));
}

void Layers::addPanel(const Pose& room_from_panel, const glm::dvec2& size_m, const Swapchain& swapchain) {
    addQuad({room_from_panel, size_m, &swapchain, {0, 0}, swapchain.sizePx()});
}

void Layers::addQuad(const LayerQuad& quad) {
    XrSwapchainSubImage part = quad.swapchain->subImage(quad.size_px);
    part.imageRect.offset = {static_cast<std::int32_t>(quad.from_px.x), static_cast<std::int32_t>(quad.from_px.y)};
    XrCompositionLayerQuad& panel = panels_.emplace_back();
    panel = {XR_TYPE_COMPOSITION_LAYER_QUAD,
             nullptr,
             XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT,
             quad.follows_head ? session_.headSpace() : session_.space(),
             XR_EYE_VISIBILITY_BOTH,
             part,
             toXr(quad.pose),
             {static_cast<float>(quad.size_m.x), static_cast<float>(quad.size_m.y)}};
    list_.push_back(reinterpret_cast<const XrCompositionLayerBaseHeader*>(&panel));
}

}  // namespace binosplat::xr
