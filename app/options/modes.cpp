// From the options to a frame's mode and settings.
#include "app/options/modes.h"

#include "engine/error.h"
#include "engine/setup/values.h"

#include <algorithm>

namespace binosplat {

Mode readMode(const Setting& setting) {
    const std::string name = readChoice(setting, {kModeNames.begin(), kModeNames.end()});
    return static_cast<Mode>(std::ranges::find(kModeNames, name) - kModeNames.begin());
}

void requirePeriphery(const StereoOptions& stereo) {
    if (!stereo.half_periphery) { return; }
    check(stereo.foveation_deg > 0.0, "--periphery is half, but --foveation is 0, must be the angle within which resolution is full");
}

FrameSettings frameSettings(const CameraOptions& camera, const StereoOptions& stereo, Order usual) {
    FrameSettings settings;
    settings.mode = stereo.mode;
    settings.dominant = stereo.dominant;
    settings.near = camera.near;
    settings.background = camera.background;
    settings.order = stereo.order.value_or(usual);
    settings.per_eye = stereo.per_eye;
    settings.stereo = stereo.warp;
    settings.half_periphery = stereo.half_periphery;
    return settings;
}

}  // namespace binosplat
