// From the options to a frame's mode and settings.
#include "app/options/modes.h"

#include "engine/error.h"
#include "engine/places/standpoint.h"

namespace binosplat {

void requirePeriphery(const StereoOptions& stereo) {
    check(!stereo.half_periphery || stereo.foveation_deg > 0.0,
          "--periphery is half, but --foveation is 0, must be the angle within which resolution is full");
}

Order orderOf(const StereoOptions& stereo, Order usual) {
    return stereo.order.value_or(stereo.axes == Axes::kStay ? Order::kDistance : usual);
}

FrameSettings frameSettings(const CameraOptions& camera, const StereoOptions& stereo, Order usual) {
    return {.mode = stereo.mode,
            .dominant = stereo.dominant,
            .near = camera.near.value_or(kUsualNear),
            .background = camera.background,
            .order = orderOf(stereo, usual),
            .stereo = stereo.warp,
            .per_eye = stereo.per_eye,
            .half_periphery = stereo.half_periphery};
}

}  // namespace binosplat
