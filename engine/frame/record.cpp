// The steps of a plan as passes.
#include "engine/frame/record.h"

#include "engine/passes/eye_view.h"

namespace binosplat {

void FrameRecorder::begin(Commands& commands, const FramePlan& plan) const {
    FrameState state{};
    for (std::size_t t = 0; t < plan.targets.size(); ++t) {
        const TargetPlan& target = plan.targets[t];
        state.views[t] = viewOf(target.eye, plan.near);
        if (!target.warp) { continue; }
        const StereoSettings& settings = target.warp->settings;
        state.targets[t].warp = warpViewOf(target.warp->relation, target.eye.size_px, room.warp(static_cast<int>(t)).rowWords(), settings);
        state.targets[t].warp_counters = firstCountersOf(settings, target.eye.size_px);
    }
    commands.begin();
    commands.update(room.lists().state, &state, sizeof(state));
}

void FrameRecorder::recordCulling(Commands& commands, const FramePlan& plan) const {
    begin(commands, plan);
    for (const ListPlan& list : plan.lists) {
        if (list.culls) { passes.recordCull(commands, scene, room.lists(), list.eyes, Role::kNone); }
    }
}

void FrameRecorder::record(Commands& commands, const FramePlan& plan) const {
    begin(commands, plan);
    room.recordShown(commands);
    for (const Step& step : plan.steps) {
        switch (step.kind) {
            case Step::Kind::kList: {
                const ListPlan& list = plan.lists[static_cast<std::size_t>(step.index)];
                if (list.culls) { passes.recordCull(commands, scene, room.lists(), list.eyes, list.role); }
                passes.recordOrder(commands, scene, room.lists(), list.eyes, list.role);
                break;
            }
            case Step::Kind::kWarp:
                recordWarp(commands, plan, step.index);
                break;
            case Step::Kind::kRender:
                recordPicture(commands, plan, step.index);
                break;
        }
    }
    commands.endPass();
}

void FrameRecorder::recordWarp(Commands& commands, const FramePlan& plan, int index) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(index)];
    const Warp& warp = *target.warp;
    warp_passes.record(commands, {.scene = scene,
                                  .buffers = room.lists(),
                                  .warp = room.warp(index),
                                  .settings = warp.settings,
                                  .rectified = warp.relation.rectified,
                                  .may_move = warp.may_move,
                                  .list = target.list,
                                  .index = index,
                                  .role = target.role,
                                  .source = room.picture(warp.source),
                                  .target = room.picture(index),
                                  .source_shown = room.shown(warp.source),
                                  .target_shown = room.shown(index),
                                  .background = glm::vec3(plan.background),
                                  .target_lens = target.eye.intrinsics,
                                  .target_gaze = warp.gaze});
}

void FrameRecorder::recordPicture(Commands& commands, const FramePlan& plan, int index) const {
    const TargetPlan& planned = plan.targets[static_cast<std::size_t>(index)];
    const Target target = targetOf(plan, index);
    if (planned.choice == TileChoice::kAll) {
        passes.recordEye(commands, scene, room.lists(), target, planned.role);
    } else {
        const WarpBuffers& warp = room.warp(index);
        const TileMask chosen{warp.tileMask(), warp.tileList(), warp.tilesWithPairs()};
        passes.recordTiles(commands, scene, room.lists(), target, chosen, planned.role);
    }
}

Target FrameRecorder::targetOf(const FramePlan& plan, int index) const {
    const TargetPlan& planned = plan.targets[static_cast<std::size_t>(index)];
    const PairBuffers& pairs = room.lists().pairs;
    Target target{.index = index,
                  .list = planned.list,
                  .size_px = planned.eye.size_px,
                  .size_tiles = tilesOf(planned.eye.size_px),
                  .pairs = pairs.arrays(),
                  .picture = &room.picture(index),
                  .background = glm::vec3(plan.background),
                  .kept = planned.kept,
                  .square_boxes = plan.square_boxes,
                  .moments = planned.kept.moments ? room.moments().address<gpu::vec2>() : gpu::DeviceAddress<gpu::vec2>{},
                  .shown = room.shown(index).mask()};
    if (!planned.feeds) { return target; }
    const Picture& fed = room.picture(*planned.feeds);
    if (planned.kept.moving) {
        const WarpBuffers& warp = room.warp(*planned.feeds);
        target.moving = warp.moving(fed);
        const EyeRelation& relation = plan.targets[static_cast<std::size_t>(*planned.feeds)].warp->relation;
        if (!movesRows(relation.rectified, warp)) { target.arrivals = warp.arrivals(fed); }
        target.row_words = warp.rowWords();
    }
    // Until this one is blended nothing is in the other one's picture.
    if (pairs.lentCapacity() > pairs.capacity()) { target.pairs = pairs.arraysWith(fed.colours, tileBits(target.size_tiles)); }
    return target;
}

}  // namespace binosplat
