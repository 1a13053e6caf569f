// How one eye's picture is made from another.
#pragma once

#include "engine/mode.h"
#include "shaders/shared/constants.h"

namespace binosplat {

// The cost of reprojecting a tile, in pairs of tile and splat, if it has not been measured: docs/tried.md,
// *One eye from the other*.
inline constexpr gpu::uint kDefaultMoveCost = 32;

struct StereoSettings {
    TileChoice choice = TileChoice::kPredicted;  // follows from the mode
    gpu::uint depth_choice =
        // The depth by which a pixel is reprojected, from its blended sums: D, D/A or A/I
        // (docs/how-it-works.md).
        gpu::kDepthInverse;
    // Colours are copied and gaps interpolated, as in the paper, instead of sampled; kPredicted samples.
    bool forward = false;
    gpu::uint gap_px = 2;         // runs of uncovered pixels up to this long are interpolated
    gpu::uint margin_px = 32;     // of the paper's ROIs
    gpu::uint edge_samples = 64;  // along each edge of the picture, for the paper's borders
    bool tight_edges = false;     // which also cover disocclusion by near content
    bool center_rois = false;     // paper: holes inside the picture are rendered, too
    double budget = 0.2;          // share of an eye's work, or of both eyes'
    // With a history: tiles that are expected to be under this PSNR come first, within the budget; 0: no
    // bound.
    double error_bound_db = 0.0;
    gpu::uint move_cost = 0;      // of a tile, in pairs
    double hole_error = 1.0;      // weight of the error expected of a hole's pixel
    double newcomer_error = 0.3;  // of a pixel covered by splats that the source does not see
    bool operator==(const StereoSettings&) const = default;
};

}  // namespace binosplat
