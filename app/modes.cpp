// Which stereo modes this build can render, and the frame's settings out of the options.
#include "app/modes.h"

#include "engine/error.h"

namespace binosplat {

Mode frameMode(const std::string& name) {
    if (name == "mono") { return Mode::kMono; }
    if (name == "two-pass") { return Mode::kTwoPass; }
    if (name == "shared") { return Mode::kShared; }
    fail("mode {} is not available in this build yet; use mono, two-pass or shared", name);
}

FrameSettings frameSettings(const RunOptions& options, const std::string& mode) {
    const StereoOptions& stereo = options.stereo;
    FrameSettings settings;
    settings.mode = frameMode(mode);
    settings.dominant = stereo.dominant;
    settings.near = options.camera.near;
    settings.background = options.camera.background;
    settings.stereo.depth_choice = stereo.depth == "sum" ? gpu::kDepthSum : stereo.depth == "mean" ? gpu::kDepthMean : gpu::kDepthInverse;
    settings.stereo.margin_px = stereo.margin_px;
    settings.stereo.center_rois = stereo.center_roi;
    settings.stereo.budget = stereo.budget;
    return settings;
}

}  // namespace binosplat
