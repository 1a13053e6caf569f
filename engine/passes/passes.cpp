// Recording the passes, in frame order.
#include "engine/passes/passes.h"

#include "engine/srgb.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace binosplat {

unsigned tileBits(glm::uvec2 size_tiles) { return static_cast<unsigned>(std::bit_width(size_tiles.x * size_tiles.y)); }

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
                                .keys = order.keys,
                                .splats = order.values,
                                .splat_count = scene.splatCount(),
                                .chunk_bits = scene.chunkBits(),
                                .order_eye = static_cast<gpu::uint>(eyes.order_eye),
                                .middle = eyes.middle.value_or(gpu::Place{})};
    const CompactKernel kernel{.by_distance = eyes.middle.has_value(), .in_pages = scene.isInPages()};
    dispatchOverBlocks(commands, kernels_.get(kernel), pass, scene, buffers, eyes.list);
    commands.beginPass({role, FrameStage::kSort, "sort_depth"});
    // Four rounds: the result is where the input was.
    sort().record(commands, order, spare, buffers.scratch.address<gpu::uint>(), buffers.state, FrameBuffers::visibleList(eyes.list), 32);
}

// One eye's part of a recording: project to rasterize.
struct Passes::EyePart {
    Commands& commands;
    const GpuScene& scene;
    const FrameBuffers& buffers;
    const Target& target;
    TileMask tiles;  // those that are rendered
    bool lists_tiles;
    Role role;

    [[nodiscard]] gpu::uint eye() const { return static_cast<gpu::uint>(target.index); }
    [[nodiscard]] bool masked() const { return tiles.mask.value != 0; }
    // Where the lists' states lie in the frame's.
    [[nodiscard]] std::uint64_t visibleList() const {
        return lists_tiles && !target.lists_chosen ? FrameBuffers::targetField(target.index, offsetof(TargetState, chosen_visible))
                                                   : FrameBuffers::visibleList(target.list);
    }
    [[nodiscard]] std::uint64_t pairList() const { return FrameBuffers::targetField(target.index, offsetof(TargetState, pairs)); }
    [[nodiscard]] std::uint64_t chosenTiles() const { return FrameBuffers::targetField(target.index, offsetof(TargetState, chosen_tiles)); }
    [[nodiscard]] auto visible() const { return buffers.state.address<gpu::ListState>(visibleList()); }
    [[nodiscard]] auto pairs() const { return buffers.state.address<gpu::ListState>(pairList()); }
    [[nodiscard]] std::uint64_t counterBytes() const { return FrameBuffers::targetField(target.index, offsetof(TargetState, counters)); }
    [[nodiscard]] auto counters() const { return buffers.state.address<gpu::EyeCounters>(counterBytes()); }
    [[nodiscard]] gpu::BinPass binPass() const;
    // Its share of what is in `buffers`.
    [[nodiscard]] std::uint64_t splatCapacity() const { return buffers.visible.capacity() / static_cast<std::uint64_t>(target.shares); }
    [[nodiscard]] std::uint64_t firstSplat() const { return splatCapacity() * static_cast<std::uint64_t>(target.share); }
    [[nodiscard]] auto splats() const { return buffers.visible.splats().at(firstSplat()); }
    [[nodiscard]] auto tileSets() const { return buffers.visible.tileSets().at(firstSplat()); }
    [[nodiscard]] auto tileCounts() const { return buffers.visible.tileCounts().at(firstSplat()); }
    // The device lists the tiles that have pairs.
    [[nodiscard]] bool listsFull() const { return lists_tiles || target.coarse; }
    // Behind the ranges of all tiles, unless some were chosen.
    [[nodiscard]] auto fullTiles() const {
        return lists_tiles ? tiles.full : buffers.tile_ranges.address<gpu::uint>(tileCount() * sizeof(gpu::uvec2));
    }
    [[nodiscard]] std::uint64_t tileCount() const { return std::uint64_t{target.size_tiles.x} * target.size_tiles.y; }
    [[nodiscard]] auto ranges() const {
        return buffers.tile_ranges.address<gpu::uvec2>().at(tileCount() * static_cast<std::uint64_t>(target.share));
    }
    [[nodiscard]] auto scratch() const {
        const std::uint64_t words = buffers.scratch.bytes() / sizeof(gpu::uint) / kMostAtOnce;
        return buffers.scratch.address<gpu::uint>().at(words * static_cast<std::uint64_t>(target.share));
    }
};

void Passes::recordEye(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const Target& target, Role role) {
    const EyePart part{.commands = commands,
                       .scene = scene,
                       .buffers = buffers,
                       .target = target,
                       .tiles = {.mask = target.shown, .list = {}, .full = {}},
                       .lists_tiles = false,
                       .role = role};
    record(std::span(&part, 1));
}

void Passes::recordTiles(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, std::span<const Patch> patches,
                         Role role) {
    std::vector<EyePart> parts;
    for (const Patch& patch : patches) {
        parts.push_back({.commands = commands,
                         .scene = scene,
                         .buffers = buffers,
                         .target = patch.target,
                         .tiles = patch.mask,
                         .lists_tiles = true,
                         .role = role});
    }
    record(parts);
}

void Passes::record(std::span<const EyePart> parts) {
    Commands& commands = parts.front().commands;
    const Role role = parts.front().role;
    // A command for each part, all of them beside each other.
    const auto forEach = [&](auto&& recordPart) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (i > 0) { commands.beside(); }
            recordPart(i);
        }
    };
    commands.beginPass({role, FrameStage::kSplat, "project"});
    forEach([&](std::size_t i) { recordProjected(parts[i]); });
    commands.beginPass({role, FrameStage::kSplat, "bin"});
    forEach([&](std::size_t i) { recordBinned(parts[i]); });
    forEach([&](std::size_t i) { recordLargeBinned(parts[i]); });
    commands.beginPass({role, FrameStage::kSplat, "sort_tiles"});
    std::vector<Sort::Job> jobs;
    for (const EyePart& part : parts) {
        jobs.push_back({part.target.pairs.pairs, part.target.pairs.spare, part.scratch(), part.pairList()});
    }
    sort().record(commands, jobs, parts.front().buffers.state, tileBits(parts.front().target.size_tiles));
    forEach([&](std::size_t i) { recordTileRanges(parts[i], jobs[i].in); });
    commands.beginPass({role, FrameStage::kSplat, "rasterize"});
    forEach([&](std::size_t i) { recordRasterized(parts[i], jobs[i].in); });
}

void Passes::recordProjected(const EyePart& part) {
    const gpu::ProjectPass project{.chunks = part.scene.chunks(),
                                   .eyes = part.buffers.eyes(),
                                   .order = part.buffers.visible.order().values,
                                   .visible = part.visible(),
                                   .splats = part.splats(),
                                   .tile_sets = part.tileSets(),
                                   .tile_counts = part.tileCounts(),
                                   .group_sums = part.scratch(),
                                   .pairs = part.pairs(),
                                   .counters = part.counters(),
                                   .tile_mask = part.tiles.mask,
                                   .chunk_bits = part.scene.chunkBits(),
                                   .eye = part.eye(),
                                   .capacity = part.target.pairs.capacity};
    part.commands.dispatchIndirect(
        kernels_.get(ProjectKernel{
            .sh_degree = static_cast<std::uint32_t>(part.scene.shDegree()), .masked = part.masked(), .splat_kind = part.scene.splatKind()}),
        project, part.buffers.state, part.visibleList() + offsetof(gpu::ListState, per_block));
}

// For bin and bin_large.
gpu::BinPass Passes::EyePart::binPass() const {
    return {.splats = splats(),
            .tile_sets = tileSets(),
            .tile_counts = tileCounts(),
            .group_sums = scratch(),
            .visible = visible(),
            .pairs = pairs(),
            .tiles = target.pairs.pairs.keys,
            .ranks = target.pairs.pairs.values,
            .large_splats = target.pairs.spare.keys,
            .large_begins = target.pairs.spare.values,
            .counters = counters(),
            .tile_mask = tiles.mask,
            .size_tiles = target.size_tiles,
            .low_pass = target.low_pass};
}

void Passes::recordBinned(const EyePart& part) {
    part.commands.dispatchIndirect(kernels_.get(BinKernel{}), part.binPass(), part.buffers.state,
                                   part.visibleList() + offsetof(gpu::ListState, per_block));
}

void Passes::recordLargeBinned(const EyePart& part) {
    part.commands.dispatch(kernels_.get(BinLargeKernel{.masked = part.masked(), .splat_kind = part.scene.splatShape()}), part.binPass(),
                           gpu::kBinLargeGroups);
}

void Passes::recordTileRanges(const EyePart& part, const KeyValues& sorted) {
    const Target& target = part.target;
    const gpu::TileRangesPass ranges{.tiles = sorted.keys,
                                     .pairs = part.pairs(),
                                     .ranges = part.ranges(),
                                     .tile_list = part.tiles.list,
                                     .masked_tiles = part.buffers.state.address<gpu::ListState>(part.chosenTiles()),
                                     .full_tiles = part.fullTiles(),
                                     .counters = part.counters(),
                                     .colours = target.picture->colours.address<gpu::vec4>(),
                                     .depths = target.kept.depth ? target.picture->depths.address<float>() : gpu::DeviceAddress<float>{},
                                     .moving = target.moving,
                                     .past_tiles = target.picture->tiles.address<gpu::PastTile>(),
                                     .visible = part.visible(),
                                     .background = target.background,
                                     .size_px = target.size_px,
                                     .is_made = target.is_made ? 1u : 0u};
    const Kernel& kernel =
        kernels_.get(part.listsFull() ? TileRangesKernel{.masked = true, .half_colours = target.kept.half_floats} : TileRangesKernel{});
    if (part.lists_tiles) {
        part.commands.dispatchIndirect(kernel, ranges, part.buffers.state, part.chosenTiles() + offsetof(gpu::ListState, per_item));
    } else {
        part.commands.dispatchOver(kernel, ranges, part.tileCount());
    }
}

void Passes::recordRasterized(const EyePart& part, const KeyValues& sorted) {
    const Target& target = part.target;
    const bool is_light = part.scene.isLight();
    const gpu::RasterizePass rasterize{.eyes = part.buffers.eyes(),
                                       .splats = part.splats(),
                                       .ranks = sorted.values,
                                       .ranges = part.ranges(),
                                       .colours = target.picture->colours.address<gpu::vec4>(),
                                       .depths = target.kept.depth ? target.picture->depths.address<float>() : gpu::DeviceAddress<float>{},
                                       .moments = target.moments,
                                       .moving = target.moving,
                                       .arrivals = target.arrivals,
                                       .full_tiles = part.fullTiles(),
                                       .counters = part.counters(),
                                       .background = is_light ? glm::vec3(lightOf(glm::dvec3(target.background))) : target.background,
                                       .eye = part.eye(),
                                       .row_words = target.row_words,
                                       .depth_choice = target.kept.depth_choice,
                                       .is_light = is_light,
                                       .is_made = target.is_made ? 1u : 0u,
                                       .past_tiles = target.picture->tiles.address<gpu::PastTile>()};
    const Kernel& kernel =
        kernels_.get(rasterizeKernel(threads_per_cell_, target.kept, part.scene.splatShape(), part.listsFull(), target.coarse));
    if (part.listsFull()) {
        part.commands.dispatchIndirect(kernel, rasterize, part.buffers.state,
                                       part.counterBytes() + offsetof(gpu::EyeCounters, per_full_tile));
    } else {  // hidden tiles have no pairs, and so become background
        part.commands.dispatch(kernel, rasterize, target.size_tiles.x, target.size_tiles.y);
    }
}

}  // namespace binosplat
