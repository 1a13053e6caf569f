// What the device is told about making an eye from a picture, and about where the eye looks.
#include "engine/passes/warp_view.h"

#include "engine/passes/frame_buffers.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

gpu::WarpView warpViewOf(const EyeRelation& relation, glm::uvec2 size_px, gpu::uint row_words,
                         const StereoSettings& settings) {
    return {.target_from_source = relation.target_from_source,
            .source_from_target = relation.source_from_target,
            .size_px = size_px,
            .size_tiles = tilesOf(size_px),
            .row_words = row_words,
            .rows_apart = settings.choice == TileChoice::kPredicted ? 2u : 1u,
            .gap_px = settings.gap_px,
            .margin_px = settings.margin_px,
            .edge_samples = settings.edge_samples,
            .tight_edges = settings.tight_edges ? 1u : 0u,
            .move_cost = settings.move_cost,
            .budget = static_cast<float>(settings.budget),
            .hole_error = static_cast<float>(settings.hole_error),
            .newcomer_error = static_cast<float>(settings.newcomer_error),
            .error_bound = settings.error_bound_db > 0.0
                               ? static_cast<float>(std::pow(10.0, -0.05 * settings.error_bound_db))
                               : 0.0f};
}

gpu::WarpCounters firstCountersOf(const StereoSettings& settings, glm::uvec2 size_px) {
    gpu::WarpCounters counters{};
    if (settings.choice == TileChoice::kPredicted) { return counters; }
    const glm::uvec2 tiles = tilesOf(size_px);
    counters.moves = 1;
    counters.per_pixel_block = {tiles.x, 2 * tiles.y, 1};
    counters.per_row = {size_px.y, 1, 1};
    return counters;
}

gpu::EyeGaze eyeGazeOf(const Gaze& gaze, const Intrinsics& lens) {
    return {.direction = glm::vec3(glm::normalize(gaze.direction)),
            .clear_rad = static_cast<float>(gaze.clear_rad),
            .pixel_cycle = static_cast<float>(2.0 / std::min(lens.fx, lens.fy)),
            .focal_px = {lens.fx, lens.fy},
            .principal_px = {lens.cx, lens.cy}};
}

}  // namespace binosplat
