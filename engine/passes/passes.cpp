// Recording the passes, in frame order.
#include "engine/passes/passes.h"

#include "engine/srgb.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace binosplat {

unsigned tileBits(gpu::uint tiles) { return static_cast<unsigned>(std::bit_width(tiles)); }

namespace {

// A cell gets one subgroup if subgroups have 8 to 64 invocations and four of them fit into a workgroup.
std::uint32_t threadsPerCell(const Context& context, std::uint32_t wanted) {
    const std::uint32_t most = std::min(64u, std::bit_floor(context.maxGroupInvocations() / gpu::kCellsPerTile));
    return std::clamp(wanted != 0 ? wanted : context.subgroupSize(), 8u, most);
}

// With coarse tiles there is one kernel for all that a picture may keep.
RasterizeKernel rasterizeKernel(std::uint32_t threads_per_cell, const Kept& kept, std::uint32_t splat_shape, bool masked, bool coarse) {
    const bool moves_by_depth = kept.moving && kept.depth_choice != gpu::kDepthInverse;
    return {.threads_per_cell = threads_per_cell,
            .depth = (kept.depth || moves_by_depth || coarse) && !kept.past,  // a past has it from its words
            .moments = kept.moments || kept.moving || kept.past,
            .half_colours = kept.half_floats,
            .splat_kind = splat_shape,
            .local_size_x = gpu::kCellsPerTile * threads_per_cell,
            .even_rows = kept.even_rows,
            .masked = masked,
            .past = kept.past,
            .coarse = coarse};
}

// A workgroup for each block of kCullBlock splats: of the whole scene, or of its visible pages.
template <typename Pass>
void dispatchOverBlocks(Commands& commands, const Kernel& kernel, const Pass& pass, const GpuScene& scene, const FrameBuffers& buffers,
                        int list) {
    if (scene.isInPages()) {
        commands.dispatchIndirect(kernel, pass, buffers.state, FrameBuffers::visiblePages(list) + offsetof(gpu::ListState, per_item));
    } else {
        commands.dispatchOver(kernel, pass, scene.splatCount(), gpu::kCullBlock);
    }
}

}  // namespace

KernelTable passKernels(const Context& context, std::uint32_t wanted_threads_per_cell) {
    KernelTable table = everyVariant<CullPagesKernel>();
    append(table, everyVariant<CullKernel>());
    append(table, everyVariant<CompactKernel>());
    append(table, sortKernels(context));
    append(table, everyVariant<ProjectKernel>());
    append(table, everyVariant<BinKernel>());
    append(table, everyVariant<BinLargeKernel>());
    append(table, everyVariant<TileRangesKernel>([](const TileRangesKernel& k) { return k.masked == 1 || k.half_colours == 0; }));
    const std::uint32_t threads = threadsPerCell(context, wanted_threads_per_cell);
    for (std::uint32_t choices = 0; choices < 8; ++choices) {
        const Kept plain{.depth = (choices & 1) != 0, .half_floats = (choices & 2) != 0};
        Kept moving = plain, even_rows = plain, past = plain;
        moving.moving = even_rows.moving = even_rows.even_rows = past.past = true;
        const auto add = [&](const Kept& kept, bool masked, bool coarse = false) {
            table.push_back(variantOf(rasterizeKernel(threads, kept, choices >> 2, masked, coarse)));
        };
        for (const Kept& kept : {plain, moving, even_rows}) { add(kept, false); }
        add(plain, true);
        if (plain.depth) { continue; }  // a past's depths follow from its words
        add(past, false);
        add(past, true);
        for (const Kept& kept : {plain, past}) { add(kept, true, true); }
    }
    return table;
}

Passes::Passes(const Context& context, std::uint32_t threads_per_cell)
    : context_(context),
      threads_per_cell_(threadsPerCell(context, threads_per_cell)),
      kernels_(context, passKernels(context, threads_per_cell)) {}

void Passes::rebuildKernels() {
    Sort sort(context_);
    kernels_.rebuild();
    sort_ = std::move(sort);
}

void Passes::takeKernels(Passes& from) {
    assert(threads_per_cell_ == from.threads_per_cell_);
    kernels_.take(from.kernels_);
    if (from.sort_) { sort_.swap(from.sort_); }
}

const Sort& Passes::sort() {
    if (!sort_) { sort_.emplace(context_); }
    return *sort_;
}

void Passes::recordCullPages(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes, Role role) {
    commands.beginPass({role, FrameStage::kSort, "cull_pages"});
    commands.dispatchOver(kernels_.get(CullPagesKernel{.splat_kind = scene.splatShape()}),
                          gpu::CullPagesPass{.pages = scene.pages(),
                                             .eyes = buffers.eyes(),
                                             .page_bits = buffers.pageBits(),
                                             .word_offsets = buffers.pageWordOffsets(),
                                             .page_list = buffers.pageList(),
                                             .visible_pages = buffers.state.address<gpu::ListState>(FrameBuffers::visiblePages(eyes.list)),
                                             .page_count = static_cast<gpu::uint>(scene.chunkCount()),
                                             .first_eye = static_cast<gpu::uint>(eyes.first),
                                             .eye_count = static_cast<gpu::uint>(eyes.count)},
                          scene.chunkCount());
}

void Passes::recordCull(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes, Role role) {
    if (scene.isInPages()) { recordCullPages(commands, scene, buffers, eyes, role); }
    commands.beginPass({role, FrameStage::kSort, "cull"});
    const gpu::CullPass pass{.chunks = scene.chunks(),
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
                             .capacity = buffers.visible.capacity() / static_cast<gpu::uint>(eyes.shares),
                             .at_once = static_cast<gpu::uint>(eyes.shares),
                             .first_tile_mask = eyes.first_mask,
                             .last_tile_mask = eyes.last_mask};
    const CullKernel kernel{.splat_kind = scene.splatShape(), .masked = eyes.first_mask.value != 0, .in_pages = scene.isInPages()};
    dispatchOverBlocks(commands, kernels_.get(kernel), pass, scene, buffers, eyes.list);
}

void Passes::recordOrder(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes, Role role) {
    commands.beginPass({role, FrameStage::kSort, "compact"});
    const KeyValues order = buffers.visible.order(), spare = buffers.visible.spare();
    const gpu::CompactPass pass{.chunks = scene.chunks(),
                                .eyes = buffers.eyes(),
                                .page_list = buffers.pageList(),
                                .visible_pages = buffers.state.address<gpu::ListState>(FrameBuffers::visiblePages(eyes.list)),
                                .visible_bits = buffers.visibleBits(),
                                .group_offsets = buffers.groupCounts(),
                                .visible = buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(eyes.list)),
                                .keys = spare.keys,
                                .splats = spare.values,
                                .splat_count = scene.splatCount(),
                                .chunk_bits = scene.chunkBits(),
                                .order_eye = static_cast<gpu::uint>(eyes.order_eye),
                                .middle = eyes.middle.value_or(gpu::Place{})};
    const CompactKernel kernel{.by_distance = eyes.middle.has_value(), .in_pages = scene.isInPages()};
    dispatchOverBlocks(commands, kernels_.get(kernel), pass, scene, buffers, eyes.list);
    commands.beginPass({role, FrameStage::kSort, "sort_depth"});
    static_assert(Sort::endsInSpare(gpu::kDepthKeyBits));
    sort().record(commands, spare, order, buffers.scratch.address<gpu::uint>(), buffers.state, FrameBuffers::visibleList(eyes.list),
                  gpu::kDepthKeyBits);
}

// What the passes of pictures that are rendered at once have in common.
struct Passes::Recording {
    Commands& commands;
    const GpuScene& scene;
    const FrameBuffers& buffers;
    const Targets& targets;

    [[nodiscard]] std::uint64_t field(std::uint64_t offset) const { return FrameBuffers::targetField(targets.first, offset); }
    // Where the lists' states lie in the frame's.
    [[nodiscard]] std::uint64_t visibleList() const {
        return targets.chosen && !targets.lists_chosen ? field(offsetof(TargetState, chosen_visible))
                                                       : FrameBuffers::visibleList(targets.list);
    }
    [[nodiscard]] auto visible() const { return buffers.state.address<gpu::ListState>(visibleList()); }
    [[nodiscard]] auto pairs() const { return buffers.state.address<gpu::ListState>(field(offsetof(TargetState, pairs))); }
    [[nodiscard]] auto states() const { return buffers.state.address<gpu::TargetState>(field(0)); }
    [[nodiscard]] auto eyes() const { return buffers.eyes().at(static_cast<std::uint64_t>(targets.first)); }
    [[nodiscard]] auto ranges() const { return buffers.tile_ranges.address<gpu::uvec2>(); }
    [[nodiscard]] auto sums() const { return buffers.scratch.address<gpu::uint>(); }
    [[nodiscard]] gpu::uint count() const { return static_cast<gpu::uint>(targets.count); }
    [[nodiscard]] gpu::uint splatsApart() const { return buffers.visible.capacity() / count(); }
    // The device lists the tiles that have pairs.
    [[nodiscard]] bool listsFull() const { return targets.chosen || targets.coarse; }
};

void Passes::recordPictures(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const Targets& targets, Role role) {
    const Recording recording{commands, scene, buffers, targets};
    commands.beginPass({role, FrameStage::kSplat, "project"});
    recordProjected(recording);
    commands.beginPass({role, FrameStage::kSplat, "bin"});
    recordBinned(recording);
    commands.beginPass({role, FrameStage::kSplat, "sort_tiles"});
    const KeyValues sorted = sort().record(commands, targets.pairs.pairs, targets.pairs.spare, recording.sums(), buffers.state,
                                           recording.field(offsetof(TargetState, pairs)), tileBits(targets.all_tiles));
    recordTileRanges(recording, sorted);
    commands.beginPass({role, FrameStage::kSplat, "rasterize"});
    recordRasterized(recording, sorted);
}

void Passes::recordProjected(const Recording& recording) {
    const GpuScene& scene = recording.scene;
    const VisibleBuffers& visible = recording.buffers.visible;
    const gpu::ProjectPass project{.chunks = scene.chunks(),
                                   .eyes = recording.eyes(),
                                   .order = visible.order().values,
                                   .visible = recording.visible(),
                                   .splats = visible.splats(),
                                   .tile_sets = visible.tileSets(),
                                   .tile_counts = visible.tileCounts(),
                                   .group_sums = recording.sums(),
                                   .pairs = recording.pairs(),
                                   .targets = recording.states(),
                                   .chunk_bits = scene.chunkBits(),
                                   .splats_apart = recording.splatsApart(),
                                   .capacity = recording.targets.pairs.capacity};
    const ProjectKernel kernel{
        .sh_degree = static_cast<std::uint32_t>(scene.shDegree()), .masked = recording.targets.masked, .splat_kind = scene.splatKind()};
    recording.commands.dispatchIndirect(kernels_.get(kernel), project, recording.buffers.state,
                                        recording.visibleList() + offsetof(gpu::ListState, per_block));
}

void Passes::recordBinned(const Recording& recording) {
    const VisibleBuffers& visible = recording.buffers.visible;
    const PairArrays& pairs = recording.targets.pairs;
    const gpu::BinPass bin{.eyes = recording.eyes(),
                           .splats = visible.splats(),
                           .tile_sets = visible.tileSets(),
                           .tile_counts = visible.tileCounts(),
                           .group_sums = recording.sums(),
                           .visible = recording.visible(),
                           .pairs = recording.pairs(),
                           .tiles = pairs.pairs.keys,
                           .ranks = pairs.pairs.values,
                           .large_splats = pairs.spare.keys,
                           .large_begins = pairs.spare.values,
                           .targets = recording.states(),
                           .splats_apart = recording.splatsApart(),
                           .all_tiles = recording.targets.all_tiles};
    recording.commands.dispatchIndirect(kernels_.get(BinKernel{}), bin, recording.buffers.state,
                                        recording.visibleList() + offsetof(gpu::ListState, per_block));
    const BinLargeKernel large{.masked = recording.targets.masked, .splat_kind = recording.scene.splatShape()};
    recording.commands.dispatch(kernels_.get(large), bin, gpu::kBinLargeGroups, 1, recording.count());
}

void Passes::recordTileRanges(const Recording& recording, const KeyValues& sorted) {
    const Targets& targets = recording.targets;
    const gpu::TileRangesPass ranges{.eyes = recording.eyes(),
                                     .tiles = sorted.keys,
                                     .pairs = recording.pairs(),
                                     .ranges = recording.ranges(),
                                     .visible = recording.visible(),
                                     .targets = recording.states(),
                                     .background = targets.background};
    const Kernel& kernel = kernels_.get(recording.listsFull() ? TileRangesKernel{.masked = true, .half_colours = targets.kept.half_floats}
                                                              : TileRangesKernel{});
    if (targets.chosen) {
        recording.commands.dispatchIndirect(kernel, ranges, recording.buffers.state,
                                            recording.field(offsetof(TargetState, chosen_tiles) + offsetof(gpu::ListState, per_item)));
    } else {
        const gpu::uint tiles = targets.size_tiles.x * targets.size_tiles.y;
        recording.commands.dispatch(kernel, ranges, (tiles + gpu::kGroupSize - 1) / gpu::kGroupSize, 1, recording.count());
    }
}

void Passes::recordRasterized(const Recording& recording, const KeyValues& sorted) {
    const Targets& targets = recording.targets;
    const bool is_light = recording.scene.isLight();
    const gpu::RasterizePass rasterize{.eyes = recording.eyes(),
                                       .splats = recording.buffers.visible.splats(),
                                       .ranks = sorted.values,
                                       .ranges = recording.ranges(),
                                       .targets = recording.states(),
                                       .background = is_light ? glm::vec3(lightOf(glm::dvec3(targets.background))) : targets.background,
                                       .depth_choice = targets.kept.depth_choice,
                                       .is_light = is_light};
    const Kernel& kernel =
        kernels_.get(rasterizeKernel(threads_per_cell_, targets.kept, recording.scene.splatShape(), recording.listsFull(), targets.coarse));
    if (recording.listsFull()) {
        recording.commands.dispatchIndirect(kernel, rasterize, recording.buffers.state,
                                            recording.field(offsetof(TargetState, counters) + offsetof(gpu::EyeCounters, per_full_tile)));
    } else {  // hidden tiles have no pairs, and so become background
        recording.commands.dispatch(kernel, rasterize, targets.size_tiles.x, targets.size_tiles.y, recording.count());
    }
}

}  // namespace binosplat
