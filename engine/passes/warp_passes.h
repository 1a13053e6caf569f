// One eye from the other: reprojection, and the tiles that must be rendered.
//
//   weigh         predicted: which tiles are cheaper to render than to move, and whether moving pays
//   depth_bounds  paper: how deep the picture is
//   edge_rois     paper: the borders that the source does not see
//   reproject     the source's pixels go to where the target sees them; resample does so itself where that is in their row
//   resample      every pixel's place in the source, its colour, and the error to expect
//   newcomers     predicted: splats that only the target sees, nearer than the middle of their tile
//   components    paper, on request: connected holes inside the picture
//   price         predicted: what it costs to mend each tile's error
//   select        the tiles that are rendered
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/gpu/kernel.h"
#include "engine/passes/eye_relation.h"
#include "engine/passes/shown_tiles.h"
#include "engine/passes/stereo_settings.h"
#include "engine/passes/warp_buffers.h"
#include "shaders/shared/passes.h"

#include <optional>

namespace binosplat {

// Where an eye looks, for TileChoice::kPredicted: what it does not see there is not worth rendering again.
struct Gaze {
    glm::dvec3 direction{0.0, 0.0, 1.0};  // in the eye's axes, of any length
    double clear_rad = 0.0;               // how far about it everything counts in full: the eye may look there, too
};

// How `settings` and the eyes look to the device. `row_words`: of a row of moving pixels, see WarpBuffers.
gpu::WarpView warpViewOf(const EyeRelation& relation, glm::uvec2 size_px, gpu::uint row_words, const StereoSettings& settings);
// What the counters start a frame with: modes that do not weigh move everything.
gpu::WarpCounters firstCountersOf(const StereoSettings& settings, glm::uvec2 size_px);

// Where the source leaves its pixels to be moved, and where they arrive: a word each, and the words from a row to the next.
struct MovingWords {
    gpu::DeviceAddress<gpu::uint> moving, arrivals;
    gpu::uint row_words;
};

// What the passes of one frame work on.
struct WarpInputs {
    const GpuScene& scene;
    const FrameBuffers& buffers;
    const WarpBuffers& warp;
    const StereoSettings& settings;
    bool rectified;
    bool may_move;  // otherwise only weigh runs, for the next frame's sake
    int list;       // of visible splats, the target's
    int index;      // of FrameState::targets and views
    Role role;
    const Picture& source;
    const Picture& target;
    const ShownTiles& source_shown;
    const ShownTiles& target_shown;
    MovingWords words;
    bool leaves_past;  // later pictures are made from the target
    glm::vec3 background;
    const Intrinsics& target_lens;
    std::optional<Gaze> target_gaze;  // empty: all tiles are seen alike
};

// Whether resample moves the source's pixels itself, row by row: then there is no reproject, and no arrivals in memory.
inline bool movesRows(bool rectified, const WarpBuffers& warp) { return rectified && warp.sharesRows(); }

// How `gaze` looks to the device.
gpu::EyeGaze eyeGazeOf(const Gaze& gaze, const Intrinsics& lens);

// Their kernels.
KernelTable warpKernels(const Context& context);

class WarpPasses {
public:
    explicit WarpPasses(const Context& context) : kernels_(context, warpKernels(context)) {}
    // See Context::replacedShaders. Throws Error where one cannot be made, and keeps the old ones then.
    void rebuildKernels() { kernels_.rebuild(); }
    [[nodiscard]] std::size_t kernelCount() const { return kernels_.size(); }
    // Goes on with the kernels of others on the same device, whose work is over, and with its own that those lack.
    void takeKernels(WarpPasses& from) { kernels_.take(from.kernels_); }

    // All of them: the target's colours, except in the tiles that are listed in the end; its depths, too, where it has room
    // for them. Tiles that are hidden become background.
    void record(Commands& commands, const WarpInputs& in);

private:
    KernelCache kernels_;
};

}  // namespace binosplat
