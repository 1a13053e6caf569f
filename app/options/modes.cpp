// From the options to a frame's mode and settings.
#include "app/options/modes.h"

#include "engine/error.h"
#include "engine/setup/values.h"

#include <algorithm>

namespace binosplat {

namespace {

gpu::uint depthChoice(PixelDepth depth) {
    switch (depth) {
        case PixelDepth::kSum:
            return gpu::kDepthSum;
        case PixelDepth::kMean:
            return gpu::kDepthMean;
        case PixelDepth::kInverse:
            break;
    }
    return gpu::kDepthInverse;
}

}  // namespace

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
    settings.stereo.depth_choice = depthChoice(stereo.depth);
    settings.stereo.forward = stereo.resampling == Resampling::kForward;
    settings.stereo.gap_px = stereo.gap_px;
    settings.stereo.margin_px = stereo.margin_px;
    settings.stereo.edge_samples = stereo.edge_samples;
    settings.stereo.tight_edges = stereo.edge_bounds == EdgeBounds::kTight;
    settings.stereo.center_rois = stereo.center_roi;
    settings.stereo.budget = stereo.budget;
    settings.stereo.move_cost = stereo.move_cost;
    settings.stereo.hole_error = stereo.hole_error;
    settings.stereo.newcomer_error = stereo.newcomer_error;
    settings.half_periphery = stereo.half_periphery;
    return settings;
}

}  // namespace binosplat
