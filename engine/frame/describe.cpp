// What the device is told about a frame before its passes: FrameState.
#include "engine/frame/record.h"

#include "engine/passes/eye_view.h"

namespace binosplat {
namespace {

// Where the target's eye looks; if that is unknown, it sees everything.
gpu::EyeGaze gazeOf(const TargetPlan& target) {
    const std::optional<Gaze>& gaze = target.warp ? target.warp->gaze : target.gaze;
    if (gaze) { return eyeGazeOf(*gaze, target.eye.intrinsics); }
    return {.direction = {0, 0, 1},
            .clear_rad = 4.0f,
            .pixel_cycle = 1.0f,
            .focal_px = {1, 1},
            .principal_px = {0, 0}};
}

gpu::uint tileCountOf(const TargetPlan& target) {
    const glm::uvec2 tiles = tilesOf(target.eye.size_px);
    return tiles.x * tiles.y;
}

}  // namespace

void FrameRecorder::describeFrame(Commands& commands, const FramePlan& plan) const {
    FrameState state{};
    for (std::size_t t = 0; t < plan.targets.size(); ++t) {
        state.views[t] = viewOf(plan.targets[t].eye, plan.near);
        describe(plan, static_cast<int>(t), state.targets[t]);
    }
    commands.update(memory.lists().state, &state, sizeof(state));
}

void FrameRecorder::describe(const FramePlan& plan, int index, TargetState& state) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(index)];
    const Picture& picture = memory.picture(target.picture);
    if (target.history) {
        state.history = historyViewOf(target.eye, target.history->eye, plan.near, glm::vec3(plan.background));
        state.history_blocks = {.per_group = {.x = 0, .y = 1, .z = 1}, .count = 0};
        state.warp = warpViewOf(
            {}, target.eye.size_px, 0,
            {.choice = target.choice, .budget = plan.budget, .error_bound_db = plan.error_bound_db});
    }
    if (target.warp) {
        state.warp = warpViewOf(target.warp->relation, target.eye.size_px, wordsOf(plan, index).row_words,
                                target.warp->settings);
        state.warp_counters = firstCountersOf(target.warp->settings, target.eye.size_px);
    }
    memory.warp(index).tell(state);
    if (target.choice == TileChoice::kAll) {
        state.tile_mask = memory.shown(index).mask();
        state.tile_list = {};
        state.full_tiles =
            memory.lists().tile_ranges.address<gpu::uint>(tileCountOf(target) * sizeof(gpu::uvec2));
    }
    state.colours = picture.colours.address<gpu::vec4>();
    if (target.kept.depth) { state.depths = picture.depths.address<float>(); }
    if (target.mesh_depths) {
        state.mesh_depths = target.mesh_depths->depths;
        state.depth_scale = target.mesh_depths->depth_scale;
        state.depth_offset = target.mesh_depths->depth_offset;
    }
    if (target.kept.moments) { state.moments = memory.moments().address<gpu::vec2>(); }
    if (target.kept.history) {
        state.history_tiles = picture.tiles.address<gpu::HistoryTile>();
        state.moving = picture.words.address<gpu::uint>();
        state.row_words = target.eye.size_px.x;
    }
    const std::optional<int> warped = plan.warpedTarget();
    if (target.kept.moving && warped &&
        plan.targets[static_cast<std::size_t>(*warped)].warp->source == index) {
        const MovingWords words = wordsOf(plan, *warped);
        state.moving = words.moving;
        const EyeRelation& relation = plan.targets[static_cast<std::size_t>(*warped)].warp->relation;
        if (!movesRows(relation.rectified, memory.warp(*warped))) { state.arrivals = words.arrivals; }
        state.row_words = words.row_words;
    }
    if (plan.at_once > 1 && index > 0) { state.first_tile = tileCountOf(plan.targets[0]); }
    state.measured = plan.measured_part;
    state.is_made = target.history ? 1 : 0;
    state.area =
        static_cast<float>(target.history ? 1.0 / (target.eye.own_pixel_px * target.eye.own_pixel_px) : 1.0);
    state.counters.may_be_coarse = target.coarse ? 1 : 0;
    state.counters.gaze = gazeOf(target);
}

MovingWords FrameRecorder::wordsOf(const FramePlan& plan, int warped) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(warped)];
    const WarpBuffers& warp = memory.warp(warped);
    const Picture& picture = memory.picture(target.picture);
    return {warp.moving(picture), warp.arrivals(picture), warp.rowWords()};
}

}  // namespace binosplat
