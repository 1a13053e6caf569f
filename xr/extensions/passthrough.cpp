// Starting and pausing the cameras.
#include "xr/extensions/passthrough.h"

#include <utility>

namespace binosplat::xr {

bool findsPassthrough(const Instance& instance) {
    if (!instance.hasExtension(XR_FB_PASSTHROUGH_EXTENSION_NAME)) { return false; }
    auto found = structure<XrSystemPassthroughPropertiesFB>(XR_TYPE_SYSTEM_PASSTHROUGH_PROPERTIES_FB);
    instance.readProperties(&found);
    return found.supportsPassthrough == XR_TRUE;
}

void Passthrough::make() {
    auto info = structure<XrPassthroughCreateInfoFB>(XR_TYPE_PASSTHROUGH_CREATE_INFO_FB);
    info.flags = XR_PASSTHROUGH_IS_RUNNING_AT_CREATION_BIT_FB;
    const auto create = instance_.function<PFN_xrCreatePassthroughFB>("xrCreatePassthroughFB");
    checkResult(create(session_, &info, &passthrough_), "xrCreatePassthroughFB");
    auto of_layer = structure<XrPassthroughLayerCreateInfoFB>(XR_TYPE_PASSTHROUGH_LAYER_CREATE_INFO_FB);
    of_layer.passthrough = passthrough_;
    of_layer.flags = XR_PASSTHROUGH_IS_RUNNING_AT_CREATION_BIT_FB;
    of_layer.purpose = XR_PASSTHROUGH_LAYER_PURPOSE_RECONSTRUCTION_FB;
    layer_ = structure<XrCompositionLayerPassthroughFB>(XR_TYPE_COMPOSITION_LAYER_PASSTHROUGH_FB);
    const auto create_layer =
        instance_.function<PFN_xrCreatePassthroughLayerFB>("xrCreatePassthroughLayerFB");
    checkResult(create_layer(session_, &of_layer, &layer_.layerHandle), "xrCreatePassthroughLayerFB");
    layer_.flags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
}

void Passthrough::run(bool runs) const {
    const char* const name = runs ? "xrPassthroughStartFB" : "xrPassthroughPauseFB";
    checkResult(instance_.function<PFN_xrPassthroughStartFB>(name)(passthrough_), name);
}

void Passthrough::show(bool shown) {
    if (fails_ || std::exchange(is_shown_, shown) == shown) { return; }
    fails_ = !instance_.troubles().tryFor("passthrough", [&] {
        if (passthrough_ == XR_NULL_HANDLE) {
            make();
        } else {
            run(shown);
        }
    });
    is_shown_ = shown && !fails_;
}

const XrCompositionLayerBaseHeader* Passthrough::layer() const {
    return is_shown_ ? reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer_) : nullptr;
}

}  // namespace binosplat::xr
