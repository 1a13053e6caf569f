// One eye from the other: reprojection, and the tiles that must be rendered.
//
//   weigh         predicted: which tiles are cheaper to render than to warp, and whether warping pays
//   depth_bounds  paper: how deep the picture is
//   edge_rois     paper: the borders that the source does not see
//   reproject     the source's pixels go to where the target sees them; resample does this itself if they
//                 stay in their rows
//   resample      every pixel's place in the source, its colour, and the error to expect
//   newcomers     predicted: splats that only the target sees, nearer than the middle of their tile
//   components    paper, on request: connected holes inside the picture
//   price         predicted: what it costs to mend each tile's error
//   select        the tiles to render
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/passes/pass_kernels.h"
#include "engine/passes/shown_tiles.h"
#include "engine/passes/warp_buffers.h"
#include "engine/passes/warp_view.h"

namespace binosplat {

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
    bool target_gaze;  // its eye's gaze is known; otherwise all tiles count equally
};

// True if resample moves the source's pixels itself, row by row; reproject then does not run, and arrivals
// are not kept in memory.
inline bool movesRows(bool rectified, const WarpBuffers& warp) { return rectified && warp.sharesRows(); }

// Runs all of them: writes the target's colours, except in the tiles that are listed at the end, and its
// depths, if it has memory for them. Hidden tiles become background.
void recordWarp(PassKernels& kernels, Commands& commands, const WarpInputs& in);

}  // namespace binosplat
