// Filling in the layers.
#include "xr/layers.h"

#include "xr/convert.h"
#include "xr/extensions/depth_layer.h"

namespace binosplat::xr {

void Layers::addViews(std::span<const LayerEye> views, bool see_through) {
    for (std::size_t v = 0; v < views.size(); ++v) {
        const LayerEye& eye = views[v];
        views_[v] = {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, nullptr, eye.view.pose, eye.view.fov,
                     eye.colour->subImage(eye.part_px)};
        if (eye.depth == nullptr) { continue; }
        depths_[v] = depthInfo(eye.depth->subImage(eye.part_px), eye.near_m);
        views_[v].next = &depths_[v];
    }
    const XrCompositionLayerFlags flags =
        see_through ? XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT : 0;
    const auto count = static_cast<std::uint32_t>(views.size());
    scene_ = {XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, flags, session_.space(), count, views_.data()};
    if (const auto* const room = see_through ? session_.roomLayer() : nullptr) { list_.push_back(room); }
    list_.push_back(reinterpret_cast<const XrCompositionLayerBaseHeader*>(&scene_));
}

void Layers::addPanel(const Pose& room_from_panel, const glm::dvec2& size_m, const Swapchain& swapchain) {
    hang({room_from_panel, size_m, &swapchain, {0, 0}, swapchain.sizePx()});
}

void Layers::addQuad(const LayerQuad& quad) {
    quad_names_.push_back(quad.name);
    if (quad_names_.size() <= most_quads_) { hang(quad); }
}

void Layers::hang(const LayerQuad& quad) {
    XrSwapchainSubImage part = quad.swapchain->subImage(quad.size_px);
    part.imageRect.offset = {static_cast<std::int32_t>(quad.from_px.x),
                             static_cast<std::int32_t>(quad.from_px.y)};
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
