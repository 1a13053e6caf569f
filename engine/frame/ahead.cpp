// What frames to come need: capacity for more, and whole pictures where reprojecting does not pay.
#include "engine/frame/stereo_frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace binosplat {

bool StereoFrame::growFor(glm::uvec2 size_px) {
    // Nothing is known, or the device lacks the memory.
    if (plan_.targets.empty() || memory_.isFirstFrame() || FrameMemory::isCutShort(state_) ||
        !memory_.growsBeside() || !memory_.fitsAhead()) {
        return true;
    }
    FramePlan plan = plan_;
    FrameState state = stateAhead();
    double pairs = 0.0, splats = 0.0;
    for (std::size_t t = 0; t < plan.targets.size(); ++t) {
        TargetState& target = state.targets[t];
        // A history of another size is of no use: all of a larger picture is rendered.
        if (plan.targets[t].history || plan.targets[t].from_history_later) {
            target.pairs.needed = std::max(target.pairs.needed, target.warp_counters.picture_cost);
        }
        pairs += target.pairs.needed;
        // The list of what is rendered at once is that of the first.
        if (plan.at_once > 1 || target.pairs.needed > 0) {
            splats += state.visible[static_cast<std::size_t>(plan.targets[t].list)].needed;
        }
    }
    // What a splat touches, one tile and more to each side, as if all were alike.
    const double times = std::max(1.0 * size_px.x / plan.targets[0].eye.size_px.x, 1.0),
                 across = std::sqrt(std::max(pairs / std::max(splats, 1.0), 1.0)),
                 across_then = 1.0 + times * (across - 1.0),
                 more = across_then * across_then / (across * across);
    for (std::size_t t = 0; t < plan.targets.size(); ++t) {
        std::uint32_t& needed = state.targets[t].pairs.needed;
        const double at_once = plan.at_once > 1 ? pairs : needed;
        needed = static_cast<std::uint32_t>(std::min(more * at_once, 1.0 * gpu::kMaxItems));
        plan.targets[t].eye.size_px = size_px;
    }
    if (memory_.hasCapacity(plan, state, kCapacityAhead)) { return true; }
    memory_.growBeside(plan, state);
    return false;
}

FrameState StereoFrame::stateAhead() const {
    FrameState ahead = state_;
    const std::uint32_t more =
        scene_->splatsComing() > splats_known_ ? scene_->splatsComing() - splats_known_ : 0;
    if (more == 0) { return ahead; }
    std::uint64_t visible = 1;
    for (const ListPlan& list : plan_.lists) {
        const auto l = static_cast<std::size_t>(list.eyes.list);
        visible = std::max<std::uint64_t>(visible, state_.visible[l].needed);
        ahead.visible[l].needed = std::min(state_.visible[l].needed, gpu::kMaxItems - more) + more;
    }
    // Each of them touches about as many tiles as the present ones, none of which may have been visible yet.
    constexpr std::uint64_t kLeastTiles = 2;
    for (std::size_t t = 0; t < plan_.targets.size(); ++t) {
        const std::uint64_t pairs = state_.targets[t].pairs.needed,
                            of_more = more * std::max(pairs / visible, kLeastTiles);
        ahead.targets[t].pairs.needed =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(pairs + of_more, gpu::kMaxItems));
    }
    return ahead;
}

void StereoFrame::growForVisible() {
    recorder().recordCulling(flight().commands, plan_);
    recorder().recordReport(flight().commands, flight().readback);
    flight().commands.submitAndWait();
    state_ = flight().readback.mapped<FrameState>()[0];
    memory_.growIfItFits(plan_, state_);  // nothing is known about pairs yet
}

bool StereoFrame::rendersInFull(std::span<const Eye> eyes, const FrameSettings& settings) {
    if (settings.mode != Mode::kTemporal || !settings.keep_history || history_pays_.mayReproject() ||
        memory_.isFirstFrame() || FrameMemory::isCutShort(state_)) {
        return false;
    }
    const FramePlan plan = planFrame(settings, eyes, false, scene_->splatCount());
    FrameState state = stateAhead();
    double tiles = 0.0;
    for (const Eye& eye : eyes) {
        const glm::uvec2 of_eye = tilesOf(eye.size_px);
        tiles += 1.0 * of_eye.x * of_eye.y;
    }
    // A splat that is seen touches a tile; how the work is divided among the eyes is not known. Until this
    // frame is known, there may be twice as much of it.
    const auto pairs = static_cast<std::uint32_t>(
        std::min(std::max(2.0 * history_pays_.fullWork(), gpu::kTilePairs * tiles), 1.0 * gpu::kMaxItems));
    for (gpu::ListState& visible : state.visible) {
        visible.needed = std::max(visible.needed, std::min(pairs, scene_->splatCount()));
    }
    for (TargetState& target : state.targets) { target.pairs.needed = std::max(target.pairs.needed, pairs); }
    if (memory_.hasCapacity(plan, state, kCapacityAhead)) { return true; }
    if (memory_.growsBeside()) { memory_.growBeside(plan, state); }
    return false;
}

void StereoFrame::learnWhetherHistoryPays(const HistoryPays::Asked& asked, const FrameCounters& counters) {
    double tiles = 0.0, pairs = 0.0;
    for (const TargetCounters& target : counters.targets) {
        tiles += static_cast<double>(target.tiles - target.tiles_hidden);
        pairs += static_cast<double>(target.tile_pairs);
    }
    if (!counters.warped || !counters.warped->work) {
        history_pays_.learn(asked, pairs, std::nullopt, tiles);
        return;
    }
    // An empty tile counts for kTilePairs there.
    const auto worth = [](std::uint64_t cost, std::uint64_t of_tiles) {
        return static_cast<double>(cost) - static_cast<double>(gpu::kTilePairs * of_tiles);
    };
    const WarpedCounters& warped = *counters.warped;
    history_pays_.learn(asked, worth(warped.work->full, warped.tiles_shown),
                        worth(warped.work->patched, warped.tiles_patched), tiles);
}

}  // namespace binosplat
