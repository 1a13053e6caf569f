// Records the passes, in frame order.
#include "engine/passes/passes.h"

#include "engine/srgb.h"

#include <algorithm>

namespace binosplat {

VisibleArrays visibleOf(const FrameBuffers& buffers, const Targets& targets) {
    return buffers.visible.arrays(targets.count, targets.empty);
}

PairFormat pairFormatOf(const FrameBuffers& buffers, const Targets& targets) {
    // Sets of several pictures' tiles are in the pictures while pairs are made.
    const bool in_place = targets.count > 1 && targets.empty.bytes > 0;
    return {targets.all_tiles, std::min(visibleOf(buffers, targets).capacity, buffers.splat_count), in_place};
}

PairArrays pairsOf(const FrameBuffers& buffers, const Targets& targets) {
    return buffers.pairs.arrays(pairFormatOf(buffers, targets), targets.empty);
}

namespace {

// A workgroup for each block of kCullBlock splats: of the whole scene, or of its visible pages.
template <typename Pass>
void dispatchOverBlocks(Commands& commands, const Kernel& kernel, const Pass& pass, const GpuScene& scene,
                        const FrameBuffers& buffers, int list) {
    if (scene.isInPages()) {
        commands.dispatchIndirect(kernel, pass, buffers.state,
                                  FrameBuffers::visiblePages(list) + offsetof(gpu::ListState, per_item));
    } else {
        commands.dispatchOver(kernel, pass, scene.splatCount(), gpu::kCullBlock);
    }
}

void recordCullPages(PassKernels& kernels, Commands& commands, const GpuScene& scene,
                     const FrameBuffers& buffers, const EyesOfList& eyes, Role role) {
    commands.beginPass({role, FrameStage::kSort, "cull_pages"});
    commands.dispatchOver(kernels.get(CullPagesKernel{.splat_kind = scene.splatKind()}),
                          gpu::CullPagesPass{.pages = scene.pages(),
                                             .eyes = buffers.eyes(),
                                             .page_bits = buffers.pageBits(),
                                             .word_offsets = buffers.pageWordOffsets(),
                                             .page_list = buffers.pageList(),
                                             .visible_pages = buffers.state.address<gpu::ListState>(
                                                 FrameBuffers::visiblePages(eyes.list)),
                                             .page_count = static_cast<gpu::uint>(scene.chunkCount()),
                                             .first_eye = static_cast<gpu::uint>(eyes.first),
                                             .eye_count = static_cast<gpu::uint>(eyes.count)},
                          scene.chunkCount());
}

// What the passes share for pictures that are rendered at once.
struct Recording {
    PassKernels& kernels;
    Commands& commands;
    const GpuScene& scene;
    const FrameBuffers& buffers;
    const Targets& targets;
    VisibleArrays splats;
    PairFormat format;
    PairArrays lists;

    [[nodiscard]] std::uint64_t field(std::uint64_t offset) const {
        return FrameBuffers::targetField(targets.first, offset);
    }
    // Where the lists' states are in the frame's state.
    [[nodiscard]] std::uint64_t visibleList() const {
        return targets.chosen && !targets.lists_chosen ? field(offsetof(TargetState, chosen_visible))
                                                       : FrameBuffers::visibleList(targets.list);
    }
    [[nodiscard]] auto visible() const { return buffers.state.address<gpu::ListState>(visibleList()); }
    [[nodiscard]] auto pairs() const {
        return buffers.state.address<gpu::ListState>(field(offsetof(TargetState, pairs)));
    }
    [[nodiscard]] auto states() const { return buffers.state.address<gpu::TargetState>(field(0)); }
    [[nodiscard]] auto eyes() const { return buffers.eyes().at(static_cast<std::uint64_t>(targets.first)); }
    [[nodiscard]] auto ranges() const { return buffers.tile_ranges.address<gpu::uvec2>(); }
    [[nodiscard]] auto sums() const { return buffers.scratch.address<gpu::uint>(); }
    [[nodiscard]] gpu::uint count() const { return static_cast<gpu::uint>(targets.count); }
    // The device lists the tiles that have pairs.
    [[nodiscard]] bool listsFull() const { return targets.chosen || targets.coarse; }
};

void recordProjected(const Recording& recording) {
    const GpuScene& scene = recording.scene;
    const gpu::ProjectPass project{.chunks = scene.chunks(),
                                   .eyes = recording.eyes(),
                                   .order = recording.splats.order,
                                   .visible = recording.visible(),
                                   .splats = recording.splats.splats,
                                   .tile_sets = recording.splats.tile_sets,
                                   .group_sums = recording.sums(),
                                   .pairs = recording.pairs(),
                                   .targets = recording.states(),
                                   .chunk_bits = scene.chunkBits(),
                                   .splats_apart = recording.splats.capacity,
                                   .capacity = recording.lists.capacity,
                                   .is_dimmed = scene.traits().is_dimmed};
    const ProjectKernel kernel{
        .sh_degree = static_cast<std::uint32_t>(scene.isPlaced() ? kMaxShDegree : scene.shDegree()),
        .masked = recording.targets.masked,
        .splat_kind = scene.splatKind(),
        .placed = scene.isPlaced()};
    recording.commands.dispatchIndirect(recording.kernels.get(kernel), project, recording.buffers.state,
                                        recording.visibleList() + offsetof(gpu::ListState, per_block));
}

void recordBinned(const Recording& recording) {
    const gpu::BinPass bin{.eyes = recording.eyes(),
                           .splats = recording.splats.splats,
                           .tile_sets = recording.splats.tile_sets,
                           .group_sums = recording.sums(),
                           .visible = recording.visible(),
                           .pairs = recording.pairs(),
                           .tiles = recording.lists.pairs.keys,
                           .ranks = recording.lists.pairs.values,
                           .targets = recording.states(),
                           .splats_apart = recording.splats.capacity,
                           .all_tiles = recording.targets.all_tiles,
                           .rank_bits = recording.format.rank_bits};
    const BinKernel kernel{.splat_kind = recording.scene.splatKind()};
    recording.commands.dispatchIndirect(recording.kernels.get(kernel), bin, recording.buffers.state,
                                        recording.visibleList() + offsetof(gpu::ListState, per_block));
}

void recordTileRanges(const Recording& recording, const KeyValues& sorted) {
    const Targets& targets = recording.targets;
    const gpu::TileRangesPass ranges{.eyes = recording.eyes(),
                                     .tiles = sorted.keys,
                                     .pairs = recording.pairs(),
                                     .ranges = recording.ranges(),
                                     .visible = recording.visible(),
                                     .targets = recording.states(),
                                     .background = targets.background,
                                     .rank_bits = recording.format.rank_bits};
    const Kernel& kernel = recording.kernels.get(
        recording.listsFull() ? TileRangesKernel{.masked = true, .half_colours = targets.kept.half_floats}
                              : TileRangesKernel{});
    if (targets.chosen) {
        recording.commands.dispatchIndirect(
            kernel, ranges, recording.buffers.state,
            recording.field(offsetof(TargetState, chosen_tiles) + offsetof(gpu::ListState, per_item)));
    } else {
        const gpu::uint tiles = targets.size_tiles.x * targets.size_tiles.y;
        recording.commands.dispatch(kernel, ranges, (tiles + gpu::kGroupSize - 1) / gpu::kGroupSize, 1,
                                    recording.count());
    }
}

void recordRasterized(const Recording& recording, const KeyValues& sorted) {
    const Targets& targets = recording.targets;
    const bool is_light = recording.scene.isLight();
    const gpu::RasterizePass rasterize{
        .eyes = recording.eyes(),
        .splats = recording.splats.splats,
        .ranks = recording.format.fitsOneWord() ? sorted.keys : sorted.values,
        .ranges = recording.ranges(),
        .targets = recording.states(),
        .background = is_light ? glm::vec3(lightOf(glm::dvec3(targets.background))) : targets.background,
        .depth_choice = targets.kept.depth_choice,
        .is_light = is_light,
        .splats_apart = recording.splats.capacity,
        .rank_bits = recording.format.rank_bits,
        .is_dimmed = recording.scene.traits().is_dimmed,
        .keeps_surface = targets.kept.surface};
    const Kernel& kernel = recording.kernels.get(rasterizeKernel(recording.kernels.threadsPerCell(),
                                                                 targets.kept, recording.scene.splatKind(),
                                                                 recording.listsFull(), targets.coarse));
    if (recording.listsFull()) {
        recording.commands.dispatchIndirect(
            kernel, rasterize, recording.buffers.state,
            recording.field(offsetof(TargetState, counters) + offsetof(gpu::EyeCounters, per_full_tile)));
    } else {  // hidden tiles have no pairs, and so become background
        recording.commands.dispatch(kernel, rasterize, targets.size_tiles.x, targets.size_tiles.y,
                                    recording.count());
    }
}

}  // namespace

void recordCull(PassKernels& kernels, Commands& commands, const GpuScene& scene, const FrameBuffers& buffers,
                const EyesOfList& eyes, Role role) {
    if (scene.isInPages()) { recordCullPages(kernels, commands, scene, buffers, eyes, role); }
    commands.beginPass({role, FrameStage::kSort, "cull"});
    const gpu::CullPass pass{
        .chunks = scene.chunks(),
        .eyes = buffers.eyes(),
        .page_list = buffers.pageList(),
        .visible_pages = buffers.state.address<gpu::ListState>(FrameBuffers::visiblePages(eyes.list)),
        .visible_bits = buffers.visibleBits(),
        .group_counts = buffers.groupCounts(),
        .visible = buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(eyes.list)),
        .splat_count = scene.splatCount(),
        .chunk_bits = scene.chunkBits(),
        .first_eye = static_cast<gpu::uint>(eyes.first),
        .eye_count = static_cast<gpu::uint>(eyes.count),
        .capacity = buffers.visible.arrays(eyes.at_once, eyes.empty).capacity,
        .at_once = static_cast<gpu::uint>(eyes.at_once),
        .first_tile_mask = eyes.first_mask,
        .last_tile_mask = eyes.last_mask};
    const CullKernel kernel{.splat_kind = scene.splatKind(),
                            .masked = eyes.first_mask.value != 0,
                            .in_pages = scene.isInPages(),
                            .placed = scene.isPlaced()};
    dispatchOverBlocks(commands, kernels.get(kernel), pass, scene, buffers, eyes.list);
}

void recordOrder(PassKernels& kernels, Commands& commands, const GpuScene& scene, const FrameBuffers& buffers,
                 const EyesOfList& eyes, Role role) {
    commands.beginPass({role, FrameStage::kSort, "compact"});
    const VisibleArrays visible = buffers.visible.arrays(eyes.at_once, eyes.empty);
    const KeyValues unsorted = visible.unsorted();
    const gpu::CompactPass pass{
        .chunks = scene.chunks(),
        .eyes = buffers.eyes(),
        .page_list = buffers.pageList(),
        .visible_pages = buffers.state.address<gpu::ListState>(FrameBuffers::visiblePages(eyes.list)),
        .visible_bits = buffers.visibleBits(),
        .group_offsets = buffers.groupCounts(),
        .visible = buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(eyes.list)),
        .keys = unsorted.keys,
        .splats = unsorted.values,
        .splat_count = scene.splatCount(),
        .chunk_bits = scene.chunkBits(),
        .order_eye = static_cast<gpu::uint>(eyes.order_eye),
        .by_distance = eyes.middle.has_value(),
        .middle = eyes.middle.value_or(gpu::Place{})};
    const CompactKernel kernel{.in_pages = scene.isInPages(), .placed = scene.isPlaced()};
    dispatchOverBlocks(commands, kernels.get(kernel), pass, scene, buffers, eyes.list);
    commands.beginPass({role, FrameStage::kSort, "sort_depth"});
    static_assert(KeyBits::roundsOf(gpu::kDepthKeyBits) % 2 == 1);
    kernels.recordSort(commands, unsorted, visible.sorted(), buffers.scratch.address<gpu::uint>(),
                       buffers.state, FrameBuffers::visibleList(eyes.list), gpu::kDepthKeyBits);
}

void recordPictures(PassKernels& kernels, Commands& commands, const GpuScene& scene,
                    const FrameBuffers& buffers, const Targets& targets, Role role) {
    const Recording recording{kernels,
                              commands,
                              scene,
                              buffers,
                              targets,
                              visibleOf(buffers, targets),
                              pairFormatOf(buffers, targets),
                              pairsOf(buffers, targets)};
    commands.beginPass({role, FrameStage::kSplat, "project"});
    recordProjected(recording);
    commands.beginPass({role, FrameStage::kSplat, "bin"});
    recordBinned(recording);
    commands.beginPass({role, FrameStage::kSplat, "sort_tiles"});
    const KeyValues sorted = kernels.recordSort(
        commands, recording.lists.pairs, recording.lists.spare, recording.sums(), buffers.state,
        recording.field(offsetof(TargetState, pairs)), recording.format.tile_bits);
    recordTileRanges(recording, sorted);
    commands.beginPass({role, FrameStage::kSplat, "rasterize"});
    recordRasterized(recording, sorted);
}

}  // namespace binosplat
