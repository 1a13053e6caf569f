// What the device is told about making an eye from a picture, and about where the eye looks.
#pragma once

#include "engine/passes/eye_relation.h"
#include "engine/passes/stereo_settings.h"
#include "shaders/shared/passes.h"

namespace binosplat {

// Where an eye looks, for TileChoice::kPredicted: errors that it does not see are not worth rendering for.
struct Gaze {
    glm::dvec3 direction{0.0, 0.0, 1.0};  // in the eye's axes, of any length
    // How far around the gaze everything counts in full, since the eye may look there, too.
    double clear_rad = 0.0;
};

// `settings` and the eyes, for the device. `row_words`: of a row of moving pixels, see WarpBuffers.
gpu::WarpView warpViewOf(const EyeRelation& relation, glm::uvec2 size_px, gpu::uint row_words,
                         const StereoSettings& settings);
// A frame's initial counters: modes that do not weigh tiles reproject everything.
gpu::WarpCounters firstCountersOf(const StereoSettings& settings, glm::uvec2 size_px);

// `gaze` for the device.
gpu::EyeGaze eyeGazeOf(const Gaze& gaze, const Intrinsics& lens);

// Where the source leaves its pixels to be warped, and where they arrive, one word each; and the number of
// words from one row to the next.
struct MovingWords {
    gpu::DeviceAddress<gpu::uint> moving, arrivals;
    gpu::uint row_words;
};

}  // namespace binosplat
