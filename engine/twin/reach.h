// Where a splat can be visible in the image: the box of its pixels and, row by row, the runs of them.
#pragma once

#include "engine/twin/splat.h"

namespace binosplat::reference {

// ProjectedSplat::box_px for a splat whose other fields are set.
glm::ivec4 boxOfReach(const ProjectedSplat& splat, const Settings& settings, glm::uvec2 size_px);

// ProjectedSplat::square_box_tiles for such a splat.
std::uint64_t countSquareBoxTiles(const ProjectedSplat& splat, const Settings& settings, glm::uvec2 size_px);

// Pixels [begin, end) of a row; empty if begin >= end.
struct Span {
    int begin, end;
};

// The pixels of row `y` in [x0, x1) that the splat can reach, as at most two runs that do not overlap (the
// disc and the low-pass are convex, but their union need not be). Rounding may add a pixel, so `meet` has the
// last word.
std::array<Span, 2> runsOfReach(const RayPlane& plane, int y, int x0, int x1);

}  // namespace binosplat::reference
