// The steps of a plan as passes.
#include "engine/frame/record.h"

#include "engine/frame/changes.h"
#include "engine/passes/eye_view.h"

#include <algorithm>

namespace binosplat {

namespace {

// Where the target's eye looks; if nobody knows, it sees everything.
gpu::EyeGaze gazeOf(const TargetPlan& target) {
    const std::optional<Gaze>& gaze = target.warp ? target.warp->gaze : target.gaze;
    if (gaze) { return eyeGazeOf(*gaze, target.eye.intrinsics); }
    return {.direction = {0, 0, 1}, .clear_rad = 4.0f, .pixel_cycle = 1.0f, .focal_px = {1, 1}, .principal_px = {0, 0}};
}

gpu::uint tileCountOf(const TargetPlan& target) {
    const glm::uvec2 tiles = tilesOf(target.eye.size_px);
    return tiles.x * tiles.y;
}

}  // namespace

void FrameRecorder::begin(Commands& commands, bool times_passes) const {
    commands.begin(times_passes);
    if (changes_known && brings_changes) { scene.recordChanges(commands); }
}

void FrameRecorder::describeFrame(Commands& commands, const FramePlan& plan) const {
    FrameState state{};
    for (std::size_t t = 0; t < plan.targets.size(); ++t) {
        state.views[t] = viewOf(plan.targets[t].eye, plan.near);
        describe(plan, static_cast<int>(t), state.targets[t]);
    }
    commands.update(room.lists().state, &state, sizeof(state));
}

void FrameRecorder::describe(const FramePlan& plan, int index, TargetState& state) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(index)];
    const Picture& picture = room.picture(target.picture);
    if (target.past) {
        state.past = pastViewOf(target.eye, target.past->eye, plan.near, glm::vec3(plan.background));
        state.past_blocks = {.per_group = {.x = 0, .y = 1, .z = 1}, .count = 0};
        state.warp =
            warpViewOf({}, target.eye.size_px, 0, {.choice = target.choice, .budget = plan.budget, .error_bound_db = plan.error_bound_db});
    }
    if (target.warp) {
        state.warp = warpViewOf(target.warp->relation, target.eye.size_px, wordsOf(plan, index).row_words, target.warp->settings);
        state.warp_counters = firstCountersOf(target.warp->settings, target.eye.size_px);
    }
    room.warp(index).tell(state);
    if (target.choice == TileChoice::kAll) {
        state.tile_mask = room.shown(index).mask();
        state.tile_list = {};
        state.full_tiles = room.lists().tile_ranges.address<gpu::uint>(tileCountOf(target) * sizeof(gpu::uvec2));
    }
    state.colours = picture.colours.address<gpu::vec4>();
    if (target.kept.depth) { state.depths = picture.depths.address<float>(); }
    if (target.mesh_depths) {
        state.mesh_depths = target.mesh_depths->depths;
        state.depth_scale = target.mesh_depths->depth_scale;
        state.depth_offset = target.mesh_depths->depth_offset;
    }
    if (target.kept.moments) { state.moments = room.moments().address<gpu::vec2>(); }
    if (target.kept.past) {
        state.past_tiles = picture.tiles.address<gpu::PastTile>();
        state.moving = picture.words.address<gpu::uint>();
        state.row_words = target.eye.size_px.x;
    }
    const std::optional<int> warped = plan.warpedTarget();
    if (target.kept.moving && warped && plan.targets[static_cast<std::size_t>(*warped)].warp->source == index) {
        const MovingWords words = wordsOf(plan, *warped);
        state.moving = words.moving;
        const EyeRelation& relation = plan.targets[static_cast<std::size_t>(*warped)].warp->relation;
        if (!movesRows(relation.rectified, room.warp(*warped))) { state.arrivals = words.arrivals; }
        state.row_words = words.row_words;
    }
    if (plan.shares() > 1 && index > 0) { state.first_tile = tileCountOf(plan.targets[0]); }
    state.measured = plan.measured_part;
    state.is_made = target.past ? 1 : 0;
    state.area = static_cast<float>(target.past ? 1.0 / (target.eye.own_pixel_px * target.eye.own_pixel_px) : 1.0);
    state.counters.may_be_coarse = target.coarse ? 1 : 0;
    state.counters.gaze = gazeOf(target);
}

void FrameRecorder::recordCulling(Commands& commands, const FramePlan& plan) const {
    begin(commands, false);
    describeFrame(commands, plan);
    for (const ListPlan& list : plan.lists) {
        if (list.culls) { recordCull(kernels, commands, scene, room.lists(), list.eyes, Role::kNone); }
    }
}

void FrameRecorder::record(Commands& commands, const FramePlan& plan, bool times_passes,
                           const std::function<void(Commands&)>& before) const {
    begin(commands, times_passes);
    if (before) { before(commands); }
    room.recordShown(commands);  // which says where the masks are
    describeFrame(commands, plan);
    for (const Step& step : plan.steps) {
        switch (step.kind) {
            case Step::Kind::kList: {
                const ListPlan& list = plan.lists[static_cast<std::size_t>(step.index)];
                const EyesOfList eyes = eyesOf(list);
                if (list.culls) { recordCull(kernels, commands, scene, room.lists(), eyes, list.role); }
                recordOrder(kernels, commands, scene, room.lists(), eyes, list.role);
                break;
            }
            case Step::Kind::kWarp:
                recordWarp(commands, plan, step.index);
                break;
            case Step::Kind::kPast:
                recordFromPast(kernels, commands, pastOf(plan, step.index));
                break;
            case Step::Kind::kChoose:
                recordChoice(commands, plan);
                break;
            case Step::Kind::kRender:
                recordPictures(commands, plan, step.index, 1);
                break;
            case Step::Kind::kRenderAll:
                recordPictures(commands, plan, 0, static_cast<int>(plan.targets.size()));
                break;
        }
    }
    commands.endPass();
}

void FrameRecorder::recordWarp(Commands& commands, const FramePlan& plan, int index) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(index)];
    const Warp& warp = *target.warp;
    binosplat::recordWarp(kernels, commands,
                          {.scene = scene,
                           .buffers = room.lists(),
                           .warp = room.warp(index),
                           .settings = warp.settings,
                           .rectified = warp.relation.rectified,
                           .may_move = warp.may_move,
                           .list = target.list,
                           .index = index,
                           .role = target.role,
                           .source = room.picture(plan.targets[static_cast<std::size_t>(warp.source)].picture),
                           .target = room.picture(target.picture),
                           .source_shown = room.shown(warp.source),
                           .target_shown = room.shown(index),
                           .words = wordsOf(plan, index),
                           .background = glm::vec3(plan.background),
                           .target_gaze = warp.gaze.has_value()});
}

MovingWords FrameRecorder::wordsOf(const FramePlan& plan, int warped) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(warped)];
    const WarpBuffers& warp = room.warp(warped);
    const Picture& picture = room.picture(target.picture);
    return {warp.moving(picture), warp.arrivals(picture), warp.rowWords()};
}

PastInputs FrameRecorder::pastOf(const FramePlan& plan, int index) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(index)];
    return {.buffers = room.lists(),
            .warp = room.warp(index),
            .index = index,
            .role = target.role,
            .source = room.picture(target.past->picture),
            .target = room.picture(target.picture),
            .shown = room.shown(index).mask(),
            .source_shown = room.shown(index).maskBefore(),
            .gaze = target.gaze.has_value()};
}

void FrameRecorder::recordChoice(Commands& commands, const FramePlan& plan) const {
    std::vector<PastInputs> eyes;
    for (int t = 0; t < static_cast<int>(plan.targets.size()); ++t) {
        if (plan.targets[static_cast<std::size_t>(t)].choice == TileChoice::kPast) { eyes.push_back(pastOf(plan, t)); }
    }
    recordChanged(commands, plan, eyes);
    binosplat::recordChoice(kernels, commands, eyes, static_cast<gpu::uint>(plan.shares()));
}

void FrameRecorder::recordChanged(Commands& commands, const FramePlan& plan, std::span<const PastInputs> pictures) const {
    if (!changes_known) { return; }
    const std::optional<std::span<const SceneChange>> changes = scene.changesSince(*changes_known);
    if (!changes || changes->empty()) { return; }
    std::vector<gpu::ChangedRect> rects;
    std::vector<std::size_t> begins;
    for (const PastInputs& picture : pictures) {
        begins.push_back(rects.size());
        const auto its = rectsOf(*changes, plan.targets[static_cast<std::size_t>(picture.index)].eye, plan.near);
        rects.insert(rects.end(), its.begin(), its.end());
    }
    if (rects.empty()) { return; }
    begins.push_back(rects.size());
    const Buffer& buffer = room.changedRects();
    commands.update(buffer, rects.data(), rects.size() * sizeof(gpu::ChangedRect));
    for (std::size_t p = 0; p < pictures.size(); ++p) {
        binosplat::recordChanged(kernels, commands, pictures[p], buffer.address<gpu::ChangedRect>(begins[p] * sizeof(gpu::ChangedRect)),
                                 static_cast<gpu::uint>(begins[p + 1] - begins[p]));
    }
}

EyesOfList FrameRecorder::eyesOf(const ListPlan& list) const {
    EyesOfList eyes = list.eyes;
    if (list.of_chosen) {
        eyes.first_mask = room.warp(eyes.first).tileMask();
        eyes.last_mask = room.warp(eyes.first + eyes.count - 1).tileMask();
    }
    return eyes;
}

void FrameRecorder::recordPictures(Commands& commands, const FramePlan& plan, int first, int count) const {
    const TargetPlan& planned = plan.targets[static_cast<std::size_t>(first)];
    Targets targets{.first = first,
                    .count = count,
                    .list = planned.list,
                    .pairs = {},
                    .background = glm::vec3(plan.background),
                    .kept = planned.kept,
                    .coarse = planned.coarse,
                    .masked = planned.choice != TileChoice::kAll || room.shown(first).hideAny(),
                    .chosen = planned.choice != TileChoice::kAll};
    for (int t = first; t < first + count; ++t) {
        const TargetPlan& target = plan.targets[static_cast<std::size_t>(t)];
        targets.size_tiles = glm::max(targets.size_tiles, tilesOf(target.eye.size_px));
        targets.all_tiles += tileCountOf(target);
    }
    const PairBuffers& pairs = room.lists().pairs;
    targets.pairs = plan.isSortedInPicture(planned) ? pairs.arraysBeside(room.picture(planned.picture).colours, tileBits(targets.all_tiles))
                                                    : pairs.arrays();
    targets.lists_chosen =
        std::ranges::any_of(plan.lists, [&](const ListPlan& list) { return list.of_chosen && list.eyes.list == planned.list; });
    binosplat::recordPictures(kernels, commands, scene, room.lists(), targets, count > 1 ? Role::kBoth : planned.role);
}

}  // namespace binosplat
