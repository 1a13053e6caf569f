// Looking for the inset.
#include "xr/extensions/foveated_inset.h"

#include <algorithm>
#include <array>

namespace binosplat::xr {

bool findsMovingInset(const Instance& instance) {
    if (!instance.hasExtension(XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME)) { return false; }
    auto insets = structure<XrSystemFoveatedRenderingPropertiesVARJO>(
        XR_TYPE_SYSTEM_FOVEATED_RENDERING_PROPERTIES_VARJO);
    instance.troubles().tryFor("insets that follow the gaze", [&] { instance.readProperties(&insets); });
    return insets.supportsFoveatedRendering == XR_TRUE;
}

std::optional<InsetSizes> findInset(const Instance& instance) {
    if (!instance.hasExtension(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME)) { return std::nullopt; }
    const auto types = listAll<XrViewConfigurationType>([&](auto... step) {
        BINOSPLAT_XR(xrEnumerateViewConfigurations(instance.handle(), instance.system(), step...));
    });
    if (std::ranges::find(types, kStereoWithInset) == types.end()) { return std::nullopt; }
    std::array<XrViewConfigurationView, 4> views;
    std::uint32_t count = 0;
    // Insets that follow the gaze may be of another size.
    auto moving =
        structure<XrFoveatedViewConfigurationViewVARJO>(XR_TYPE_FOVEATED_VIEW_CONFIGURATION_VIEW_VARJO);
    moving.foveatedRenderingActive = XR_TRUE;
    std::array<XrFoveatedViewConfigurationViewVARJO, 4> moves;
    moves.fill(moving);
    for (std::size_t v = 0; v < 4; ++v) {
        views[v] = {
            XR_TYPE_VIEW_CONFIGURATION_VIEW, instance.movesInsets() ? &moves[v] : nullptr, 0, 0, 0, 0, 0, 0};
    }
    BINOSPLAT_XR(xrEnumerateViewConfigurationViews(instance.handle(), instance.system(), kStereoWithInset, 4,
                                                   &count, views.data()));
    const auto sizeOf = [&](std::size_t v) {
        return glm::uvec2(views[v].recommendedImageRectWidth, views[v].recommendedImageRectHeight);
    };
    return InsetSizes{glm::max(sizeOf(0), sizeOf(1)), glm::max(sizeOf(2), sizeOf(3))};
}

}  // namespace binosplat::xr
