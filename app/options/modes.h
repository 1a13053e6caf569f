// From the options to a frame's mode and settings.
#pragma once

#include "app/options/options.h"
#include "engine/frame/stereo_frame.h"

namespace binosplat {

// Throws Error (bad input) where they ask for half the resolution of a mode that cannot give it, or do not say where. The references are
// left as they are.
void requirePeriphery(const StereoOptions& stereo);

// The settings of a frame as the options say.
FrameSettings frameSettings(const CameraOptions& camera, const StereoOptions& stereo, Order usual = Order::kDepth);

}  // namespace binosplat
