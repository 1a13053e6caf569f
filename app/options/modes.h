// Turns the options into a frame's mode and settings.
#pragma once

#include "app/options/options.h"
#include "engine/frame/stereo_frame.h"

namespace binosplat {

// Throws Error (bad input) if the options ask for half resolution in the periphery without an angle of
// foveation. Modes without a periphery just ignore it.
void requirePeriphery(const StereoOptions& stereo);

// In a headset, unless the options say otherwise: turning the head does not swap splats, and canted eyes
// share one order.
inline constexpr Order kWearersOrder = Order::kDistance;

// The order of splats. If axes stay, one that does not change when they move.
Order orderOf(const StereoOptions& stereo, Order usual);

// A frame's settings from the options.
FrameSettings frameSettings(const CameraOptions& camera, const StereoOptions& stereo, Order usual);

}  // namespace binosplat
