// From the options to a frame's mode and settings.
#include "app/options/modes.h"

#include "engine/error.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

constexpr std::pair<const char*, Mode> kModes[] = {
    {"mono", Mode::kMono},           {"two-pass", Mode::kTwoPass}, {"shared", Mode::kShared},
    {"reproject", Mode::kReproject}, {"paper", Mode::kPaper},      {"predicted", Mode::kPredicted},
};

}  // namespace

Mode frameMode(const std::string& name) {
    const auto* found = std::ranges::find(kModes, name, [](const auto& entry) { return entry.first; });
    check(found != std::end(kModes), "mode is {}, must be mono, two-pass, shared, reproject, paper or predicted", name);
    return found->second;
}

FrameSettings frameSettings(const CameraOptions& camera, const StereoOptions& stereo) {
    FrameSettings settings;
    settings.mode = frameMode(stereo.mode);
    settings.dominant = stereo.dominant;
    settings.near = camera.near;
    settings.background = camera.background;
    settings.order = stereo.order == "distance" ? Order::kDistance : Order::kDepth;
    settings.per_eye = stereo.per_eye;
    settings.stereo.depth_choice = stereo.depth == "sum" ? gpu::kDepthSum : stereo.depth == "mean" ? gpu::kDepthMean : gpu::kDepthInverse;
    settings.stereo.forward = stereo.resampling == "forward";
    settings.stereo.gap_px = stereo.gap_px;
    settings.stereo.margin_px = stereo.margin_px;
    settings.stereo.edge_samples = stereo.edge_samples;
    settings.stereo.tight_edges = stereo.edge_bounds == "tight";
    settings.stereo.center_rois = stereo.center_roi;
    settings.stereo.budget = stereo.budget;
    settings.stereo.move_cost = stereo.move_cost;
    settings.stereo.hole_error = stereo.hole_error;
    settings.stereo.newcomer_error = stereo.newcomer_error;
    return settings;
}

}  // namespace binosplat
