// Recording the passes, in frame order.
#include "engine/passes/passes.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace binosplat {

unsigned tileBits(glm::uvec2 size_tiles) { return static_cast<unsigned>(std::bit_width(size_tiles.x * size_tiles.y)); }

namespace {

// A cell is one subgroup's where a subgroup has 8 to 64 invocations and four fit into a workgroup.
std::uint32_t threadsPerCell(const Context& context, std::uint32_t wanted) {
    const std::uint32_t most = std::min(64u, std::bit_floor(context.maxGroupInvocations() / gpu::kCellsPerTile));
    return std::clamp(wanted != 0 ? wanted : context.subgroupSize(), 8u, most);
}

}  // namespace

KernelTable passKernels(const Context& context, std::uint32_t wanted_threads_per_cell) {
    KernelTable table = everyVariant("1_cull", sizeof(gpu::CullPass), {{"kSplatKind", 2}});
    append(table, everyVariant("2_compact", sizeof(gpu::CompactPass), {{"kByDistance", 2}}));
    append(table, sortKernels(context));
    append(table,
           everyVariant("4_project", sizeof(gpu::ProjectPass), {{"kShDegree", kMaxShDegree + 1}, {"kMasked", 2}, {"kSplatKind", 3}}));
    append(table, everyVariant("5_bin", sizeof(gpu::BinPass)));
    append(table, everyVariant("5_bin_large", sizeof(gpu::BinPass), {{"kMasked", 2}, {"kSplatKind", 2}}));
    append(table, everyVariant("6_tile_ranges", sizeof(gpu::TileRangesPass)));
    const std::uint32_t threads = threadsPerCell(context, wanted_threads_per_cell);
    const auto rasterize = [&](const Kept& kept, std::uint32_t masked) {
        for (std::uint32_t choices = 0; choices < 8; ++choices) {
            const std::uint32_t depth = choices & 1, half_floats = choices >> 1 & 1, kind = choices >> 2;
            table.push_back({"7_rasterize",
                             sizeof(gpu::RasterizePass),
                             {{"kThreadsPerCell", threads},
                              {"kDepth", depth},
                              {"kMoments", kept.moments},
                              {"kMoving", kept.moving},
                              {"kSpread", kept.spread},
                              {"kMasked", masked},
                              {"kDepthChoice", kept.depth_choice},
                              {"kHalfColours", half_floats},
                              {"kSplatKind", kind},
                              {"local_size_x", gpu::kCellsPerTile * threads}}});
        }
    };
    rasterize({}, 1);
    for (const bool moments : {false, true}) {
        rasterize({.moments = moments}, 0);
        for (const gpu::uint choice : {gpu::kDepthSum, gpu::kDepthMean, gpu::kDepthInverse}) {
            for (const bool spread : {false, true}) {
                rasterize({.moments = moments, .moving = true, .spread = spread, .depth_choice = choice}, 0);
            }
        }
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

void Passes::recordCull(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes,
                        const std::string& role) {
    commands.beginPass(role + "1_cull");
    const auto visible = buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(eyes.list));
    commands.dispatchOver(kernels_.get("1_cull", sizeof(gpu::CullPass), {scene.splatShape()}),
                          gpu::CullPass{scene.chunks(), buffers.eyes(), buffers.visibleBits(), buffers.groupCounts(), visible,
                                        scene.splatCount(), scene.chunkBits(), static_cast<gpu::uint>(eyes.first),
                                        static_cast<gpu::uint>(eyes.count), buffers.visible.capacity()},
                          scene.splatCount(), gpu::kCullBlock);
}

void Passes::recordVisible(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes,
                           const std::string& role) {
    recordCull(commands, scene, buffers, eyes, role);
    recordOrder(commands, scene, buffers, eyes, role);
}

void Passes::recordOrder(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyesOfList& eyes,
                         const std::string& role) {
    commands.beginPass(role + "2_compact");
    const auto visible = buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(eyes.list));
    commands.dispatchOver(kernels_.get("2_compact", sizeof(gpu::CompactPass), {eyes.middle ? 1u : 0u}),
                          gpu::CompactPass{scene.chunks(), buffers.eyes(), buffers.visibleBits(), buffers.groupCounts(), visible,
                                           buffers.visible.order().keys, buffers.visible.order().values, scene.splatCount(),
                                           scene.chunkBits(), static_cast<gpu::uint>(eyes.order_eye), eyes.middle.value_or(gpu::Place{})},
                          scene.splatCount(), gpu::kCullBlock);
    commands.beginPass(role + "3_sort_depth");
    // Four rounds: the result is where the input was.
    sort().record(commands, buffers.visible.order(), buffers.visible.spare(), buffers.scratch.address<gpu::uint>(), buffers.state,
                  FrameBuffers::visibleList(eyes.list), 32);
}

const Kernel& Passes::rasterizeKernel(const GpuScene& scene, Kept kept, bool masked) {
    return kernels_.get("7_rasterize", sizeof(gpu::RasterizePass),
                        {threads_per_cell_, kept.depth, kept.moments, kept.moving, kept.spread, masked, kept.depth_choice, kept.half_floats,
                         scene.splatShape(), gpu::kCellsPerTile * threads_per_cell_});
}

void Passes::recordEye(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyeTarget& target,
                       const std::string& role) {
    record(commands, scene, buffers, target, nullptr, role);
}

void Passes::recordTiles(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyeTarget& target,
                         const TileMask& mask, const std::string& role) {
    record(commands, scene, buffers, target, &mask, role);
}

void Passes::record(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const EyeTarget& target, const TileMask* mask,
                    const std::string& role) {
    const auto eye = static_cast<gpu::uint>(target.eye);
    const std::uint64_t visible_list = mask != nullptr ? offsetof(FrameState, masked_visible) : FrameBuffers::visibleList(target.list);
    const std::uint64_t pair_list = FrameBuffers::pairList(target.eye);
    const auto visible = buffers.state.address<gpu::ListState>(visible_list);
    const auto pairs = buffers.state.address<gpu::ListState>(pair_list);
    const auto counters = buffers.state.address<gpu::EyeCounters>(offsetof(FrameState, counters)).at(eye);
    const auto per_visible = visible_list + offsetof(gpu::ListState, per_block);
    const auto per_pair = pair_list + offsetof(gpu::ListState, per_item);
    const auto scratch = buffers.scratch.address<gpu::uint>();
    const TileMask tiles = mask != nullptr ? *mask : TileMask{target.shown, {}};

    commands.beginPass(role + "4_project");
    const std::uint32_t masked = tiles.mask.value != 0 ? 1 : 0;
    commands.dispatchIndirect(
        kernels_.get("4_project", sizeof(gpu::ProjectPass), {static_cast<std::uint32_t>(scene.shDegree()), masked, scene.splatKind()}),
        gpu::ProjectPass{scene.chunks(), buffers.eyes(), buffers.visible.order().values, visible, buffers.visible.splats(),
                         buffers.visible.tileSets(), buffers.visible.tileCounts(), scratch, pairs, counters, tiles.mask, scene.chunkBits(),
                         eye, target.pairs.capacity},
        buffers.state, per_visible);
    commands.beginPass(role + "5_bin");
    const KeyValues& unsorted = target.pairs.pairs;
    const auto ranges = buffers.tile_ranges.address<gpu::uvec2>();
    const gpu::BinPass bin{buffers.visible.splats(),
                           buffers.visible.tileSets(),
                           buffers.visible.tileCounts(),
                           scratch,
                           visible,
                           pairs,
                           unsorted.keys,
                           unsorted.values,
                           target.pairs.spare.keys,
                           target.pairs.spare.values,
                           counters,
                           tiles.mask,
                           ranges,
                           target.size_tiles};
    commands.dispatchIndirect(kernels_.get("5_bin", sizeof(gpu::BinPass)), bin, buffers.state, per_visible);
    commands.dispatch(kernels_.get("5_bin_large", sizeof(gpu::BinPass), {masked, scene.splatShape()}), bin, gpu::kBinLargeGroups);
    commands.beginPass(role + "6_sort_tiles");
    const KeyValues sorted =
        sort().record(commands, unsorted, target.pairs.spare, scratch, buffers.state, pair_list, tileBits(target.size_tiles));
    commands.dispatchIndirect(kernels_.get("6_tile_ranges", sizeof(gpu::TileRangesPass)), gpu::TileRangesPass{sorted.keys, pairs, ranges},
                              buffers.state, per_pair);
    commands.beginPass(role + "7_rasterize");
    const gpu::RasterizePass rasterize{.eyes = buffers.eyes(),
                                       .splats = buffers.visible.splats(),
                                       .ranks = sorted.values,
                                       .ranges = ranges,
                                       .colours = target.image->colours.address<gpu::vec4>(),
                                       .half_colours = target.image->colours.address<gpu::uvec2>(),
                                       .depths = target.image->depths.address<float>(),
                                       .moments = target.moments,
                                       .moving = target.moving,
                                       .arrivals = target.arrivals,
                                       .tile_list = tiles.list,
                                       .masked_tiles = buffers.state.address<gpu::ListState>(offsetof(FrameState, masked_tiles)),
                                       .background = target.background,
                                       .eye = eye,
                                       .row_words = target.row_words};
    if (mask == nullptr) {  // hidden tiles have no pairs, and so become background
        commands.dispatch(rasterizeKernel(scene, target.kept, false), rasterize, target.size_tiles.x, target.size_tiles.y);
    } else {
        commands.dispatchIndirect(rasterizeKernel(scene, target.kept, true), rasterize, buffers.state,
                                  offsetof(FrameState, masked_tiles) + offsetof(gpu::ListState, per_tile));
    }
}

}  // namespace binosplat
