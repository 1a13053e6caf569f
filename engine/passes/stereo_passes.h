// One eye from the other: reprojection, and the tiles that must be rendered again.
//
//   8a_reproject     the dominant eye's pixels go to where the affiliated eye sees them
//   8b_resolve       every pixel of the affiliated eye gets a place in the dominant picture; its expected error
//   8c_depth_bounds  paper: how deep the picture is
//   8d_edge_rois     paper: the borders that the dominant eye does not see
//   8e_components    paper, on request: connected holes inside the picture
//   8f_newcomers     predicted: splats that only the affiliated eye sees
//   8g_select        the tiles that are rendered again
//   9_resample       the colour of all other pixels
#pragma once

#include "engine/geometry.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/passes/frame_buffers.h"
#include "engine/passes/shown_tiles.h"
#include "shaders/shared/passes.h"

#include <array>

namespace binosplat {

// Who makes the affiliated picture's tiles.
enum class Patching {
    kNone,       // nobody: reprojection and interpolation alone
    kPaper,      // edge ROIs, and centre ROIs if asked for
    kPredicted,  // the tiles of the greatest expected error
};

// What the stereo passes are told beside the two cameras.
struct StereoSettings {
    Patching patching = Patching::kPredicted;
    gpu::uint depth_choice = gpu::kDepthInverse;
    gpu::uint gap_px = 2;
    gpu::uint margin_px = 32;
    gpu::uint edge_samples = 64;
    bool tight_edges = false;
    bool center_rois = false;
    double budget = 0.15;        // share of the tiles that are not hidden
    gpu::uint hidden_tiles = 0;  // of the affiliated eye
    double hole_error = 1.0;
    double newcomer_error = 0.3;
};

// How `settings` and the cameras look to the device.
gpu::StereoView stereoViewOf(const Eye& dominant, const Eye& affiliated, const StereoSettings& settings);
// Whether pixels move along their row alone and keep their depth: the eyes are parallel, side by side, and share cy and fy.
bool isRectified(const gpu::StereoView& view);
// Whether besides the eyes share fx: then a splat's projection for one follows from that for the other.
bool isShifted(const gpu::StereoView& view);

class StereoPasses {
public:
    explicit StereoPasses(const Context& context) : kernels_(context) {}
    // See Context::replacedShaders. Throws Error where one cannot be made, and keeps the old ones then.
    void rebuildKernels() { kernels_.rebuild(); }

    // Passes 8. `dominant` holds the dominant eye's colours (and D, if the choice of depth reads it); `affiliated` its stereo pixels;
    // `shown` what the lenses show, by eye.
    void record(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const StereoBuffers& stereo,
                const StereoSettings& settings, bool rectified, int dominant_eye, const EyeImage& dominant, const EyeImage& affiliated,
                const std::array<ShownTiles, 2>& shown);
    // Pass 9: the affiliated eye's colours take the place of its stereo pixels but in the tiles that are masked; its depths, too, where
    // it has room for them. Tiles that are hidden become background.
    void recordResample(Commands& commands, const FrameBuffers& buffers, const StereoBuffers& stereo, bool rectified,
                        const EyeImage& dominant, const EyeImage& affiliated, const glm::vec3& background);

private:
    KernelCache kernels_;
};

}  // namespace binosplat
