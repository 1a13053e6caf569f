// One eye from the other: reprojection, and the tiles that must be rendered.
//
//   weigh         predicted: which tiles are cheaper to render than to warp, and whether warping pays
//   depth_bounds  paper: how deep the picture is
//   edge_rois     paper: the borders that the source does not see
//   reproject     the source's pixels go to where the target sees them; resample does this itself if they stay in their rows
//   resample      every pixel's place in the source, its colour, and the error to expect
//   newcomers     predicted: splats that only the target sees, nearer than the middle of their tile
//   components    paper, on request: connected holes inside the picture
//   price         predicted: what it costs to mend each tile's error
//   select        the tiles to render
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/passes/eye_relation.h"
#include "engine/passes/pass_kernels.h"
#include "engine/passes/shown_tiles.h"
#include "engine/passes/stereo_settings.h"
#include "engine/passes/warp_buffers.h"
#include "shaders/shared/passes.h"

#include <optional>

namespace binosplat {

// Where an eye looks, for TileChoice::kPredicted: errors that it does not see are not worth rendering again.
struct Gaze {
    glm::dvec3 direction{0.0, 0.0, 1.0};  // in the eye's axes, of any length
    double clear_rad = 0.0;               // how far around it everything counts in full: the eye may look there, too
};

// `settings` and the eyes, for the device. `row_words`: of a row of moving pixels, see WarpBuffers.
gpu::WarpView warpViewOf(const EyeRelation& relation, glm::uvec2 size_px, gpu::uint row_words, const StereoSettings& settings);
// Initial counters of a frame: modes that do not weigh warp everything.
gpu::WarpCounters firstCountersOf(const StereoSettings& settings, glm::uvec2 size_px);

// Where the source leaves its pixels to be warped, and where they arrive: one word each; and the number of words from a row to the next.
struct MovingWords {
    gpu::DeviceAddress<gpu::uint> moving, arrivals;
    gpu::uint row_words;
};

// The inputs of one frame's passes.
struct WarpInputs {
    const GpuScene& scene;
    const FrameBuffers& buffers;
    const WarpBuffers& warp;
    const StereoSettings& settings;
    bool rectified;
    bool may_move;  // otherwise only weigh runs, for the next frame
    int list;       // of visible splats, the target's
    int index;      // of FrameState::targets and views
    Role role;
    const Picture& source;
    const Picture& target;
    const ShownTiles& source_shown;
    const ShownTiles& target_shown;
    MovingWords words;
    glm::vec3 background;
    bool target_gaze;  // it is known where its eye looks; otherwise all tiles count alike
};

// True if resample moves the source's pixels itself, row by row: then reproject does not run, and no arrivals lie in memory.
inline bool movesRows(bool rectified, const WarpBuffers& warp) { return rectified && warp.sharesRows(); }

// `gaze` for the device.
gpu::EyeGaze eyeGazeOf(const Gaze& gaze, const Intrinsics& lens);

// Runs all of them: writes the target's colours, except in the tiles that are finally listed, and its depths, if it has room for them.
// Hidden tiles become background.
void recordWarp(PassKernels& kernels, Commands& commands, const WarpInputs& in);

}  // namespace binosplat
