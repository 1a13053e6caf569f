// What a frame says of itself: counters, and what it left out.
#include "engine/frame.h"

#include <fmt/format.h>

#include <string_view>

namespace binosplat {

FrameResult StereoFrame::collect(const Flight& flight) const {
    const std::vector<Eye>& eyes = flight.eyes;
    const FrameSettings& settings = flight.settings;
    FrameResult result;
    result.mark = settings.mark;
    result.gpu_ms = flight.commands.times();
    result.gpu_total_ms = flight.commands.totalMs();
    result.peak_gpu_bytes = context_.memoryUse().peak_bytes;
    auto& counters = result.counters;
    counters["commands"] = flight.commands.count();
    counters["splats_read"] = scene_->splatCount();
    counters["scene_bytes"] = scene_->bytes();
    counters["visible_bytes"] = buffers_.visible.bytes();
    counters["pair_bytes"] = buffers_.pairs.bytes();
    counters["scratch_bytes"] = buffers_.scratch.bytes();
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const std::string suffix = settings.mode == Mode::kMono ? "" : e == kLeft ? "_left" : "_right";
        const glm::uvec2 tiles = tilesOf(eyes[e].size_px);
        counters["splats_visible" + suffix] = state_.visible[listOf(static_cast<int>(e))].count;
        counters["tile_pairs" + suffix] = state_.pairs[e].count;
        if (settings.square_boxes) {
            counters["square_box_tile_pairs" + suffix] =
                (std::uint64_t{state_.counters[e].square_box_pairs_high} << 32) | state_.counters[e].square_box_pairs_low;
        }
        counters["tiles" + suffix] = std::uint64_t{tiles.x} * tiles.y;
        if (shown_[e].hideAny()) { counters["tiles_hidden" + suffix] = shown_[e].hiddenCount(); }
        counters["pixels" + suffix] = std::uint64_t{eyes[e].size_px.x} * eyes[e].size_px.y;
        counters["pixel_bytes" + suffix] = images_[e].colours.bytes() + images_[e].depths.bytes();
    }
    if (reprojects(settings.mode)) { collectStereo(flight, result); }
    explainLeftOut(flight, result);
    return result;
}

void StereoFrame::collectStereo(const Flight& flight, FrameResult& result) const {
    const FrameSettings& settings = flight.settings;
    auto& counters = result.counters;
    const gpu::WarpCounters& stereo = state_.warp_counters;
    if (stereo_buffers_.classesBuffer().bytes() > 0) {
        counters["pixels_covered"] = stereo.covered_pixels;
        counters["pixels_gap"] = stereo.gap_pixels;
        counters["pixels_hole"] = stereo.hole_pixels;
    }
    counters["tiles_patched"] = state_.masked_tiles.count;
    counters["tiles_edge"] = stereo.edge_tiles;
    counters["tiles_center"] = stereo.center_tiles;
    counters["tiles_predicted"] = stereo.predicted_tiles;
    if (settings.mode == Mode::kPredicted) {
        counters["tiles_cheap"] = stereo.cheap_tiles;
        counters["tiles_weighed_as_moved"] = stereo.moved_tiles;
        counters["work_full"] = stereo.picture_cost;
        counters["work_patched"] = stereo.chosen_cost;
        counters["work_saved_by_moving"] = stereo.saved_cost;
    }
    counters["hole_components"] = stereo.components;
    counters["splats_newcomers"] = stereo.newcomers;
    counters["stereo_bytes"] = stereo_buffers_.bytes();
    result.stereo_bytes_per_pixel = warpTraffic({.settings = stereoSettingsOf(settings),
                                                 .may_move = flight.may_move,
                                                 .moves_rows = movesRows(flight.relation.rectified, stereo_buffers_),
                                                 .even_rows = settings.mode == Mode::kPredicted && flight.relation.rectified,
                                                 .sums_even_rows = sumsEvenRows(settings, flight.relation),
                                                 .half_floats = settings.half_floats,
                                                 .target_depth = images_[1 - dominant_].depths.bytes() > 0,
                                                 .classes = stereo_buffers_.classesBuffer().bytes() > 0,
                                                 .size_px = flight.eyes[0].size_px,
                                                 .counters = stereo,
                                                 .visible = state_.visible[0].count});
    const std::uint32_t shown = stereo_buffers_.tileCount() - shown_[1 - dominant_].hiddenCount();
    result.tiles_rendered = shown > 0 ? static_cast<double>(state_.masked_tiles.count) / shown : 0.0;
    if (stereo.picture_cost > 0) { result.work_rendered = static_cast<double>(stereo.chosen_cost) / stereo.picture_cost; }
}

void StereoFrame::explainLeftOut(const Flight& flight, FrameResult& result) const {
    const std::vector<Eye>& eyes = flight.eyes;
    const FrameSettings& settings = flight.settings;
    const auto leaveOut = [&](bool condition, std::string_view sentence) {
        if (condition) { result.left_out.emplace_back(sentence); }
    };
    const bool patched = settings.mode == Mode::kPaper || settings.mode == Mode::kPredicted;
    const bool inverse = reprojects(settings.mode) && settings.stereo.depth_choice == gpu::kDepthInverse;
    const bool moments = settings.keep_moments || settings.mode == Mode::kPredicted || inverse;
    const gpu::WarpCounters& stereo = state_.warp_counters;
    leaveOut(scene_->shDegree() < kMaxShDegree, fmt::format("SH bands above {}: the scene has none", scene_->shDegree()));
    leaveOut(!moments, "moments of inverse depth: no stage of this mode reads them");
    leaveOut(eyes.size() == 2 && images_[1 - dominant_].depths.bytes() == 0, "depth of the affiliated eye: nothing reads it");
    leaveOut(eyes.size() == 2 && !per_eye_, "culling for the affiliated eye alone: both eyes are culled at once");
    leaveOut(eyes.size() == 2 && !per_eye_ && (settings.order == Order::kDistance || flight.relation.same_depths),
             settings.order == Order::kDistance
                 ? "depth sort of the affiliated eye: both eyes go by the distance from the middle between them"
                 : "depth sort of the affiliated eye: the eyes are parallel, so the dominant eye's order is exact");
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const std::uint64_t tiles = std::uint64_t{tilesOf(eyes[e].size_px).x} * tilesOf(eyes[e].size_px).y;
        leaveOut(shown_[e].hideAny(), fmt::format("{} of the {} tiles of the {} eye: its lens never shows them", shown_[e].hiddenCount(),
                                                  tiles, e == kLeft ? "left" : "right"));
    }
    leaveOut(settings.mode == Mode::kPredicted && stereo.moves == 0,
             "reprojection: every tile is cheaper to render than to move, so that nothing is lost");
    leaveOut(patched && state_.masked_tiles.count == 0, "patching: no tile needs to be rendered again");
    leaveOut(settings.mode == Mode::kPaper && !settings.stereo.center_rois, "centre ROIs: not asked for");
    leaveOut(settings.mode == Mode::kPaper && settings.stereo.center_rois && stereo.hole_pixels == 0,
             "centre ROIs: the picture has no holes");
    leaveOut(settings.mode == Mode::kPredicted && stereo.moves != 0 && stereo.newcomers == 0,
             "errors of newcomers: the affiliated eye sees no splat that the dominant one does not");
}

}  // namespace binosplat
