// The memory traffic of making the target, except for the tiles that are rendered for it.
#pragma once

#include "engine/passes/stereo_settings.h"
#include "shaders/shared/passes.h"

#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// Bytes that a pass reads and writes, per pixel of an eye, in frame order. What several threads read counts
// once, since neighbours read it from a cache; what is read and written back counts twice.
using Traffic = std::vector<std::pair<std::string, double>>;

// The facts about a frame on which its traffic depends.
struct WarpFacts {
    StereoSettings settings;
    bool may_move = true;          // the source came with what warping needs
    bool moves_rows = false;       // resample also does what reproject does otherwise
    bool even_rows = false;        // odd rows are warped like even ones
    bool sums_even_rows = false;   // so the source writes nothing for odd rows
    bool half_floats = false;      // what pictures consist of
    bool target_depth = false;     // its D is kept
    bool classes = false;          // of pixels are kept
    glm::uvec2 size_px{0, 0};      // of an eye
    gpu::WarpCounters counters{};  // at the end of the frame
    std::uint32_t visible = 0;     // splats that either eye sees
};

Traffic warpTraffic(const WarpFacts& facts);

}  // namespace binosplat
