// The steps of a plan as passes. A frame of `temporal` has these, if one order of the splats serves both eyes
// (planTemporal in plan.cpp):
//
//   kHistory    for each eye: what its last picture shows of the new one, and the error to expect of each
//   tile
//               (recordFromHistory)
//   kChoose     the tiles of both that are rendered again (recordChoice)
//   kList       the splats that touch these, front to back (recordCull, recordOrder)
//   kRender     the chosen tiles, and what the next frame is told of them (recordPictures)
//
// Before them the device is told where everything lies (describe.cpp), and after them it reports what it did
// (report.cpp).
#include "engine/frame/record.h"

#include "engine/frame/changes.h"

#include <algorithm>

namespace binosplat {

void FrameRecorder::begin(Commands& commands, bool times_passes) const {
    commands.begin(times_passes);
    if (changes_known && brings_changes) { scene.recordChanges(commands); }
}

void FrameRecorder::recordCulling(Commands& commands, const FramePlan& plan) const {
    begin(commands, false);
    describeFrame(commands, plan);
    for (const ListPlan& list : plan.lists) {
        if (list.culls) { recordCull(kernels, commands, scene, memory.lists(), list.eyes, Role::kNone); }
    }
}

void FrameRecorder::record(Commands& commands, const FramePlan& plan, bool times_passes,
                           const std::function<void(Commands&)>& before) const {
    begin(commands, times_passes);
    if (before) { before(commands); }
    memory.recordShown(commands);  // which says where the masks are
    describeFrame(commands, plan);
    for (const Step& step : plan.steps) {
        switch (step.kind) {
            case Step::Kind::kList: {
                const ListPlan& list = plan.lists[static_cast<std::size_t>(step.index)];
                const EyesOfList eyes = eyesOf(plan, list);
                if (list.culls) { recordCull(kernels, commands, scene, memory.lists(), eyes, list.role); }
                recordOrder(kernels, commands, scene, memory.lists(), eyes, list.role);
                break;
            }
            case Step::Kind::kWarp:
                recordWarp(commands, plan, step.index);
                break;
            case Step::Kind::kHistory:
                recordFromHistory(kernels, commands, historyOf(plan, step.index));
                break;
            case Step::Kind::kChoose:
                recordChoice(commands, plan);
                break;
            case Step::Kind::kRender:
                recordPictures(commands, plan, step.index);
                break;
        }
    }
    commands.endPass();
}

void FrameRecorder::recordWarp(Commands& commands, const FramePlan& plan, int index) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(index)];
    const Warp& warp = *target.warp;
    binosplat::recordWarp(
        kernels, commands,
        {.scene = scene,
         .buffers = memory.lists(),
         .warp = memory.warp(index),
         .settings = warp.settings,
         .rectified = warp.relation.rectified,
         .may_move = warp.may_move,
         .list = target.list,
         .index = index,
         .role = target.role,
         .source = memory.picture(plan.targets[static_cast<std::size_t>(warp.source)].picture),
         .target = memory.picture(target.picture),
         .source_shown = memory.shown(warp.source),
         .target_shown = memory.shown(index),
         .words = wordsOf(plan, index),
         .background = glm::vec3(plan.background),
         .target_gaze = warp.gaze.has_value()});
}

HistoryInputs FrameRecorder::historyOf(const FramePlan& plan, int index) const {
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(index)];
    return {.buffers = memory.lists(),
            .warp = memory.warp(index),
            .index = index,
            .role = target.role,
            .source = memory.picture(target.history->picture),
            .target = memory.picture(target.picture),
            .shown = memory.shown(index).mask(),
            .source_shown = memory.shown(index).maskBefore(),
            .gaze = target.gaze.has_value()};
}

void FrameRecorder::recordChoice(Commands& commands, const FramePlan& plan) const {
    std::vector<HistoryInputs> eyes;
    gpu::uint most_pairs = gpu::kMaxItems;
    for (int t = 0; t < static_cast<int>(plan.targets.size()); ++t) {
        if (plan.targets[static_cast<std::size_t>(t)].choice == TileChoice::kHistory) {
            eyes.push_back(historyOf(plan, t));
            most_pairs = std::min(most_pairs, pairsOf(memory.lists(), targetsOf(plan, t)).capacity);
        }
    }
    recordChanged(commands, plan, eyes);
    binosplat::recordChoice(kernels, commands, eyes, static_cast<gpu::uint>(plan.at_once), most_pairs);
}

void FrameRecorder::recordChanged(Commands& commands, const FramePlan& plan,
                                  std::span<const HistoryInputs> pictures) const {
    if (!changes_known) {
        // This recording is made for its kernels alone, so that the first change need not wait for one.
        if (scene.isInPages()) { kernels.get(MarkChangedKernel{}); }
        return;
    }
    const std::optional<std::span<const SceneChange>> changes = scene.changesSince(*changes_known);
    if (!changes || changes->empty()) { return; }
    std::vector<gpu::ChangedRect> rects;
    std::vector<std::size_t> begins;
    for (const HistoryInputs& picture : pictures) {
        begins.push_back(rects.size());
        const auto its =
            rectsOf(*changes, plan.targets[static_cast<std::size_t>(picture.index)].eye, plan.near);
        rects.insert(rects.end(), its.begin(), its.end());
    }
    if (rects.empty()) { return; }
    begins.push_back(rects.size());
    const Buffer& buffer = memory.changedRects();
    commands.update(buffer, rects.data(), rects.size() * sizeof(gpu::ChangedRect));
    for (std::size_t p = 0; p < pictures.size(); ++p) {
        binosplat::recordChanged(kernels, commands, pictures[p],
                                 buffer.address<gpu::ChangedRect>(begins[p] * sizeof(gpu::ChangedRect)),
                                 static_cast<gpu::uint>(begins[p + 1] - begins[p]));
    }
}

EyesOfList FrameRecorder::eyesOf(const FramePlan& plan, const ListPlan& list) const {
    EyesOfList eyes = list.eyes;
    eyes.empty = memory.emptyPictures(plan, plan.targets[static_cast<std::size_t>(eyes.first)]);
    if (list.of_chosen) {
        eyes.first_mask = memory.warp(eyes.first).tileMask();
        eyes.last_mask = memory.warp(eyes.first + eyes.count - 1).tileMask();
    }
    return eyes;
}

Targets FrameRecorder::targetsOf(const FramePlan& plan, int index) const {
    const int count = plan.at_once, first = count > 1 ? 0 : index;
    const TargetPlan& planned = plan.targets[static_cast<std::size_t>(first)];
    Targets targets{.first = first,
                    .count = count,
                    .list = planned.list,
                    .empty = memory.emptyPictures(plan, planned),
                    .background = glm::vec3(plan.background),
                    .kept = planned.kept,
                    .coarse = planned.coarse,
                    .masked = planned.choice != TileChoice::kAll || memory.shown(first).isMasked(),
                    .chosen = planned.choice != TileChoice::kAll};
    for (int t = first; t < first + count; ++t) {
        const glm::uvec2 tiles = tilesOf(plan.targets[static_cast<std::size_t>(t)].eye.size_px);
        targets.size_tiles = glm::max(targets.size_tiles, tiles);
        // Where only one of them keeps its depth, the other has no memory for it.
        targets.kept.depth = targets.kept.depth || plan.targets[static_cast<std::size_t>(t)].kept.depth;
    }
    targets.all_tiles = plan.tilesWith(planned);
    targets.lists_chosen = std::ranges::any_of(
        plan.lists, [&](const ListPlan& list) { return list.of_chosen && list.eyes.list == planned.list; });
    return targets;
}

void FrameRecorder::recordPictures(Commands& commands, const FramePlan& plan, int index) const {
    binosplat::recordPictures(
        kernels, commands, scene, memory.lists(), targetsOf(plan, index),
        plan.at_once > 1 ? Role::kBoth : plan.targets[static_cast<std::size_t>(index)].role);
}

}  // namespace binosplat
