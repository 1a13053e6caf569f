// From what the device reported to counters and sentences.
#include "engine/frame/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string_view>

namespace binosplat {
namespace {

// Which the frames' buffers need not have any more.
std::uint32_t tilesShownOf(const TargetPlan& target) {
    const glm::uvec2 tiles = tilesOf(target.eye.size_px);
    return tiles.x * tiles.y - target.tiles_hidden;
}

void countWarp(const FrameFacts& frame, std::size_t index, FrameResult& result) {
    const TargetPlan& target = frame.plan.targets[index];
    const TargetPlan& source = frame.plan.targets[static_cast<std::size_t>(target.warp->source)];
    const StereoSettings& settings = target.warp->settings;
    const TargetState& state = frame.state.targets[index];
    const gpu::WarpCounters& warp = state.warp_counters;
    const WarpBuffers& buffers = frame.memory.warp(static_cast<int>(index));
    const bool has_classes = buffers.classesBuffer().bytes() > 0;
    WarpedCounters& counters = result.counters.warped.emplace();
    if (has_classes) { counters.pixels = {warp.covered_pixels, warp.gap_pixels, warp.hole_pixels}; }
    counters.tiles_patched = state.chosen_tiles.count;
    counters.tiles_edge = warp.edge_tiles;
    counters.tiles_center = warp.center_tiles;
    counters.tiles_predicted = warp.predicted_tiles;
    if (settings.choice == TileChoice::kPredicted) {
        counters.work = {.tiles_cheap = warp.cheap_tiles,
                         .tiles_weighed_as_reprojected = warp.reprojected_tiles,
                         .full = warp.picture_cost,
                         .patched = warp.chosen_cost,
                         .saved_by_moving = warp.saved_cost};
    }
    counters.hole_components = warp.components;
    counters.splats_newcomers = warp.newcomers;
    counters.bytes = buffers.bytes();
    const bool rectified = target.warp->relation.rectified;
    result.stereo_bytes_per_pixel =
        warpTraffic({.settings = settings,
                     .may_move = target.warp->may_move,
                     .moves_rows = movesRows(rectified, buffers),
                     .even_rows = settings.choice == TileChoice::kPredicted && rectified,
                     .sums_even_rows = source.kept.even_rows,
                     .half_floats = target.kept.half_floats,
                     .target_depth = target.kept.depth,
                     .classes = has_classes,
                     .size_px = target.eye.size_px,
                     .counters = warp,
                     .visible = frame.state.visible[0].count});
    const std::uint32_t shown = tilesShownOf(target);
    counters.tiles_shown = shown;
    result.tiles_rendered = shown > 0 ? static_cast<double>(state.chosen_tiles.count) / shown : 0.0;
    if (warp.picture_cost > 0) {
        result.work_rendered = static_cast<double>(warp.chosen_cost) / warp.picture_cost;
    }
}

// For both eyes together, since they share one budget.
void countHistory(const FrameFacts& frame, FrameResult& result) {
    WarpedCounters& counters = result.counters.warped.emplace();
    std::uint64_t shown = 0;
    WarpedCounters::Work work;
    double left = 0.0, expected = 0.0, found = 0.0, wider = 0.0;
    if (frame.plan.error_bound_db > 0.0) { counters.tiles_over_bound = 0; }
    for (std::size_t t = 0; t < frame.plan.targets.size(); ++t) {
        if (!frame.plan.targets[t].history) { continue; }
        const TargetState& state = frame.state.targets[t];
        const WarpBuffers& buffers = frame.memory.warp(static_cast<int>(t));
        counters.tiles_patched += state.chosen_tiles.count;
        counters.tiles_predicted += state.warp_counters.predicted_tiles;
        if (counters.tiles_over_bound) { *counters.tiles_over_bound += state.warp_counters.waiting_tiles; }
        counters.bytes += buffers.bytes();
        work.full += state.warp_counters.picture_cost;
        work.patched += state.warp_counters.chosen_cost;
        left += state.warp_counters.left_squares;
        expected += state.warp_counters.expected_squares;
        found += state.warp_counters.found_squares;
        wider += state.warp_counters.wider_squares;
        shown += tilesShownOf(frame.plan.targets[t]);
    }
    counters.tiles_shown = shown;
    const double all_steps = static_cast<double>(gpu::kSquareSteps * 3 * gpu::kTileSize * gpu::kTileSize) *
                             static_cast<double>(std::max<std::uint64_t>(shown, 1));
    // Expectations for rendered tiles err in the same way, and those errors are known.
    result.warp_error = left / all_steps * (expected > 0.0 ? std::min(found / expected, 1.0) : 1.0);
    result.half_loss = wider / all_steps * gpu::kMeasuredParts;
    result.tiles_rendered =
        shown > 0 ? static_cast<double>(counters.tiles_patched) / static_cast<double>(shown) : 0.0;
    if (work.full > 0) {
        result.work_rendered = static_cast<double>(work.patched) / static_cast<double>(work.full);
        counters.work = work;
    }
}

// Of all eyes together.
void countCoarse(const gpu::EyeCounters& eye, FrameCounters& counters) {
    if (!counters.coarse) { counters.coarse.emplace(); }
    counters.coarse->tiles += eye.coarse_kept;
    counters.coarse->tiles_tried += eye.coarse_tiles;
    counters.coarse->pairs += eye.coarse_pairs;
    counters.coarse->sharp_pairs += eye.sharp_pairs;
}

bool seesNothing(const FrameCounters& counters) {
    if (std::ranges::any_of(counters.targets,
                            [](const TargetCounters& target) { return target.tile_pairs > 0; })) {
        return false;
    }
    // Pictures that are made from their histories may need no splat: then their tiles know the cost of making
    // them. An empty tile counts for kTilePairs.
    std::uint64_t tiles = 0;
    for (const TargetCounters& target : counters.targets) { tiles += target.tiles; }
    return !counters.warped || !counters.warped->work ||
           counters.warped->work->full <= gpu::kTilePairs * tiles;
}

using LeaveOut = std::function<void(bool condition, std::string_view sentence)>;

void explainWarp(const FrameFacts& frame, std::size_t index, const LeaveOut& leaveOut) {
    const StereoSettings& settings = frame.plan.targets[index].warp->settings;
    const gpu::WarpCounters& warp = frame.state.targets[index].warp_counters;
    const bool paper = settings.choice == TileChoice::kPaper,
               predicts = settings.choice == TileChoice::kPredicted;
    leaveOut(predicts && warp.moves == 0,
             "reprojection: every tile is cheaper to render than to reproject, so nothing is lost");
    leaveOut((paper || predicts) && frame.state.targets[index].chosen_tiles.count == 0,
             "patching: no tile needs to be rendered again");
    leaveOut(paper && !settings.center_rois, "centre ROIs: not asked for");
    leaveOut(paper && settings.center_rois && warp.hole_pixels == 0, "centre ROIs: the picture has no holes");
    leaveOut(predicts && warp.moves != 0 && warp.newcomers == 0,
             "errors of newcomers: the affiliated eye sees no splat that the dominant one does not");
}

void explainLeftOut(const FrameFacts& frame, FrameResult& result) {
    const LeaveOut leaveOut = [&](bool condition, std::string_view sentence) {
        if (condition) { result.left_out.emplace_back(sentence); }
    };
    const FramePlan& plan = frame.plan;
    const bool moments = std::ranges::any_of(plan.targets, [](const TargetPlan& target) {
        return target.kept.moments || target.kept.history ||
               (target.warp && (target.warp->settings.choice == TileChoice::kPredicted ||
                                target.warp->settings.depth_choice == gpu::kDepthInverse));
    });
    const bool two = plan.eyes == 2,
               both_at_once = two && plan.targets[kLeft].list == plan.targets[kRight].list;
    leaveOut(frame.scene.shDegree() < kMaxShDegree,
             fmt::format("SH bands above {}: the scene has none", frame.scene.shDegree()));
    leaveOut(!moments, "moments of inverse depth: no stage of this mode reads them");
    leaveOut(two && !plan.targets[static_cast<std::size_t>(1 - plan.firstTarget() % 2)].kept.depth,
             "depth of the affiliated eye: nothing reads it");
    leaveOut(both_at_once, "culling for the affiliated eye alone: both eyes are culled at once");
    leaveOut(both_at_once && plan.shares_order, plan.lists[0].eyes.middle
                                                    ? "depth sort of the affiliated eye: both eyes sort by "
                                                      "the distance from the midpoint between them"
                                                    : "depth sort of the affiliated eye: the eyes are "
                                                      "parallel, so the dominant eye's order is exact");
    for (std::size_t e = 0; e < plan.eyes; ++e) {
        const glm::uvec2 tiles = tilesOf(plan.targets[e].eye.size_px);
        const std::uint32_t hidden = plan.targets[e].tiles_hidden;
        leaveOut(hidden > 0,
                 fmt::format("{} of the {} tiles of the {} eye: its lens never shows them", hidden,
                             std::uint64_t{tiles.x} * tiles.y, e == kLeft ? "left" : "right"));
    }
    const bool two_full =
        two && plan.targets[0].coarse && !plan.targets[0].history && !plan.targets[1].history;
    leaveOut(two_full, "reprojection: both eyes are rendered, coarsely where they do not see sharply");
    leaveOut(plan.in_full && !two_full,
             "reprojection: rendering both eyes in full costs no more, so nothing is lost");
    for (std::size_t t = 0; t < plan.targets.size(); ++t) {
        if (plan.targets[t].warp) { explainWarp(frame, t, leaveOut); }
    }
}

}  // namespace

FrameResult reportFrame(const FrameFacts& frame, std::uint64_t mark) {
    const FrameBuffers& lists = frame.memory.lists();
    FrameResult result;
    result.mark = mark;
    result.gpu_ms = frame.commands.times();
    result.gpu_total_ms = frame.commands.totalMs();
    result.peak_gpu_bytes = frame.context.memoryUse().peak_bytes;
    FrameCounters& counters = result.counters;
    counters.commands = frame.commands.count();
    counters.splats_read = frame.scene.splatsHeld();
    if (frame.scene.isInPages()) {
        const auto seen = std::ranges::max(frame.state.visible_pages, {}, &gpu::ListState::count).count;
        counters.pages = {.resident = frame.scene.pagesHeld(), .seen = seen};
    }
    counters.scene_bytes = frame.scene.bytes();
    counters.visible_bytes = lists.visible.bytes();
    counters.pair_bytes = lists.pairs.bytes();
    counters.scratch_bytes = lists.scratch.bytes();
    for (std::size_t t = 0; t < frame.plan.eyes; ++t) {
        const TargetPlan& target = frame.plan.targets[t];
        const TargetState& state = frame.state.targets[t];
        const glm::uvec2 size_px = target.eye.size_px, tiles = tilesOf(size_px);
        const Picture& picture = frame.memory.picture(target.picture);
        TargetCounters& its = counters.targets.emplace_back();
        its.splats_visible = frame.state.visible[static_cast<std::size_t>(target.list)].count;
        const gpu::ListState& pairs = frame.state.targets[frame.plan.at_once > 1 ? 0 : t].pairs;
        its.tile_pairs = pairs.count == pairs.needed ? state.counters.pairs : 0;
        its.tiles = std::uint64_t{tiles.x} * tiles.y;
        its.tiles_hidden = target.tiles_hidden;
        its.pixels = std::uint64_t{size_px.x} * size_px.y;
        its.pixel_bytes =
            picture.colours.bytes() + picture.depths.bytes() + picture.words.bytes() + picture.tiles.bytes();
        if (target.warp) { countWarp(frame, t, result); }
        if (target.coarse) { countCoarse(state.counters, counters); }
    }
    if (std::ranges::any_of(frame.plan.targets,
                            [](const TargetPlan& target) { return target.history.has_value(); })) {
        countHistory(frame, result);
    }
    result.sees_nothing = seesNothing(counters);
    explainLeftOut(frame, result);
    return result;
}

}  // namespace binosplat
