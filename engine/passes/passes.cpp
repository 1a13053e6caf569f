// Recording the passes, in frame order.
#include "engine/passes/passes.h"

#include <algorithm>
#include <bit>

namespace binosplat {

unsigned tileBits(glm::uvec2 size_tiles) { return static_cast<unsigned>(std::bit_width(size_tiles.x * size_tiles.y)); }

Passes::Passes(const Context& context, std::uint32_t threads_per_cell)
    :  // A cell is one subgroup's where a subgroup has 8 to 64 invocations.
      threads_per_cell_(threads_per_cell != 0 ? threads_per_cell : std::clamp(context.subgroupSize(), 8u, 64u)),
      scan_(context),
      sort_(context),
      kernels_(context) {}

void Passes::rebuildKernels(const Context& context) {
    Scan scan(context);
    Sort sort(context);
    kernels_.rebuild();
    scan_ = std::move(scan);
    sort_ = std::move(sort);
}

void Passes::recordVisible(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, int first_eye, int eye_count,
                           int order_eye, int list, const std::string& role) {
    commands.beginPass(role + "1_cull");
    commands.dispatchOver(kernels_.get("1_cull", sizeof(gpu::CullPass)),
                          gpu::CullPass{scene.chunks(), buffers.eyes(), buffers.visibleBits(), buffers.groupCounts(), scene.splatCount(),
                                        scene.chunkBits(), static_cast<gpu::uint>(first_eye), static_cast<gpu::uint>(eye_count)},
                          scene.splatCount());
    commands.beginPass(role + "2_compact");
    scan_.overCount(commands, buffers.groupCounts(), static_cast<gpu::uint>(buffers.cullGroups()),
                    buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(list)), buffers.visible.capacity());
    recordOrder(commands, scene, buffers, order_eye, list, role);
}

void Passes::recordOrder(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, int order_eye, int list,
                         const std::string& role) {
    commands.beginPass(role + "2_compact");
    const auto visible = buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(list));
    commands.dispatchOver(kernels_.get("2_compact", sizeof(gpu::CompactPass)),
                          gpu::CompactPass{scene.chunks(), buffers.eyes(), buffers.visibleBits(), buffers.groupCounts(), visible,
                                           buffers.visible.order().keys, buffers.visible.order().values, scene.splatCount(),
                                           scene.chunkBits(), static_cast<gpu::uint>(order_eye)},
                          scene.splatCount());
    commands.beginPass(role + "3_sort_depth");
    // Four rounds: the result is where the input was.
    sort_.record(commands, buffers.visible.order(), buffers.visible.spare(), buffers.scratch.address<gpu::uint>(), buffers.state,
                 FrameBuffers::visibleList(list), 32);
}

const Kernel& Passes::rasterizeKernel(Kept kept, bool masked) {
    return kernels_.get(
        "7_rasterize", sizeof(gpu::RasterizePass),
        {threads_per_cell_, kept.depth, kept.stereo_pixels, kept.inverse_depth_moments, masked, gpu::kCellsPerTile * threads_per_cell_});
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
    const auto per_visible = visible_list + offsetof(gpu::ListState, per_item);
    const auto per_pair = pair_list + offsetof(gpu::ListState, per_item);
    const auto scratch = buffers.scratch.address<gpu::uint>();
    const TileMask tiles = mask != nullptr ? *mask : target.shown;

    commands.beginPass(role + "4_project");
    const std::uint32_t masked = tiles.tiles_before.value != 0 ? 1 : 0;
    commands.dispatchIndirect(
        kernels_.get("4_project", sizeof(gpu::ProjectPass), {static_cast<std::uint32_t>(scene.shDegree()), masked, target.shifted}),
        gpu::ProjectPass{scene.chunks(), buffers.eyes(), buffers.visible.order().values, visible, buffers.visible.splats(),
                         buffers.visible.tileSets(), buffers.visible.tileCounts(), counters, tiles.tiles_before,
                         buffers.state.address<gpu::StereoView>(offsetof(FrameState, stereo)), scene.chunkBits(), eye},
        buffers.state, per_visible);
    commands.beginPass(role + "5_bin");
    scan_.overList(commands, buffers.visible.tileCounts(), scratch, buffers.state, visible_list, pairs, target.pairs.capacity);
    const KeyValues& unsorted = target.pairs.pairs;
    const gpu::BinPass bin{buffers.visible.splats(),
                           buffers.visible.tileSets(),
                           buffers.visible.tileCounts(),
                           visible,
                           pairs,
                           unsorted.keys,
                           unsorted.values,
                           target.pairs.spare.keys,
                           counters,
                           tiles.tiles_before,
                           target.size_tiles};
    commands.dispatchIndirect(kernels_.get("5_bin", sizeof(gpu::BinPass), {masked}), bin, buffers.state, per_visible);
    commands.dispatch(kernels_.get("5_bin_large", sizeof(gpu::BinPass), {masked}), bin, gpu::kBinLargeGroups);
    commands.beginPass(role + "6_sort_tiles");
    const KeyValues sorted =
        sort_.record(commands, unsorted, target.pairs.spare, scratch, buffers.state, pair_list, tileBits(target.size_tiles));
    const auto ranges = buffers.tile_ranges.address<gpu::uvec2>();
    commands.fillZero(buffers.tile_ranges);
    commands.dispatchIndirect(kernels_.get("6_tile_ranges", sizeof(gpu::TileRangesPass)), gpu::TileRangesPass{sorted.keys, pairs, ranges},
                              buffers.state, per_pair);
    commands.beginPass(role + "7_rasterize");
    const gpu::RasterizePass rasterize{buffers.eyes(),
                                       buffers.visible.splats(),
                                       sorted.values,
                                       ranges,
                                       target.image->colours.address<gpu::vec4>(),
                                       target.image->depths.address<float>(),
                                       target.stereo_pixels,
                                       tiles.tile_list,
                                       buffers.state.address<gpu::ListState>(offsetof(FrameState, masked_tiles)),
                                       target.background,
                                       eye};
    if (mask == nullptr) {  // hidden tiles have no pairs, and so become background
        commands.dispatch(rasterizeKernel(target.kept, false), rasterize, target.size_tiles.x, target.size_tiles.y);
    } else {
        commands.dispatchIndirect(rasterizeKernel(target.kept, true), rasterize, buffers.state,
                                  offsetof(FrameState, masked_tiles) + offsetof(gpu::ListState, per_tile));
    }
}

}  // namespace binosplat
