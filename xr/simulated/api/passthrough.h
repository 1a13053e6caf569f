// XR_FB_passthrough: what the headset's cameras see of the room, as a layer.
#pragma once

#include "xr/simulated/api/layers.h"

namespace simulated {

inline bool isPassthrough(const Session& session, XrStructureType type) {
    return type == XR_TYPE_COMPOSITION_LAYER_PASSTHROUGH_FB &&
           session.instance.extensions.contains(XR_FB_PASSTHROUGH_EXTENSION_NAME);
}
void checkPassthrough(const Session& session, const XrCompositionLayerBaseHeader& layer);
// Not shown while it, or the passthrough that it is of, is paused.
std::optional<RoomLayer> makePassthroughLayer(const Session& session,
                                              const XrCompositionLayerBaseHeader& layer);

}  // namespace simulated
