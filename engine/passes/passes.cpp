// Recording the passes, in frame order.
#include "engine/passes/passes.h"

#include <algorithm>
#include <bit>

namespace binosplat {
namespace {

Kernel rasterizeKernelFor(const Context& context, std::uint32_t threads_per_cell, Kept kept) {
    // A cell is one subgroup's where a subgroup has 8 to 64 invocations.
    const std::uint32_t threads = threads_per_cell != 0 ? threads_per_cell : std::clamp(context.subgroupSize(), 8u, 64u);
    return Kernel(context, "7_rasterize", sizeof(gpu::RasterizePass), {threads, kept.depth, kept.inverse_depth_moments, gpu::kCellsPerTile * threads});
}

}  // namespace

Passes::Passes(const Context& context, int sh_degree, std::uint32_t threads_per_cell)
    : scan_(context),
      sort_(context),
      cull_(context, "1_cull", sizeof(gpu::CullPass)),
      compact_(context, "2_compact", sizeof(gpu::CompactPass)),
      project_(context, "4_project", sizeof(gpu::ProjectPass), {static_cast<std::uint32_t>(sh_degree)}),
      bin_(context, "5_bin", sizeof(gpu::BinPass)),
      tile_ranges_(context, "6_tile_ranges", sizeof(gpu::TileRangesPass)),
      rasterize_colour_(rasterizeKernelFor(context, threads_per_cell, {})),
      rasterize_depth_(rasterizeKernelFor(context, threads_per_cell, {/*depth=*/true})),
      rasterize_moments_(rasterizeKernelFor(context, threads_per_cell, {/*depth=*/true, /*inverse_depth_moments=*/true})) {}

void Passes::recordVisible(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, int first_eye, int eye_count, int order_eye, int list,
                           const std::string& role) const {
    commands.beginPass(role + "1_cull");
    commands.dispatchOver(cull_,
                          gpu::CullPass{scene.chunks(), buffers.eyes(), buffers.visibleBits(), buffers.groupCounts(), scene.splatCount(), scene.chunkBits(),
                                        static_cast<gpu::uint>(first_eye), static_cast<gpu::uint>(eye_count)},
                          scene.splatCount());
    commands.beginPass(role + "2_compact");
    scan_.overCount(commands, buffers.groupCounts(), static_cast<gpu::uint>(buffers.cullGroups()),
                    buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(list)), buffers.visible.capacity());
    recordOrder(commands, scene, buffers, order_eye, list, role);
}

void Passes::recordOrder(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, int order_eye, int list, const std::string& role) const {
    const auto visible = buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(list));
    commands.dispatchOver(compact_,
                          gpu::CompactPass{scene.chunks(), buffers.eyes(), buffers.visibleBits(), buffers.groupCounts(), visible, buffers.visible.order().keys,
                                           buffers.visible.order().values, scene.splatCount(), scene.chunkBits(), static_cast<gpu::uint>(order_eye)},
                          scene.splatCount());
    commands.beginPass(role + "3_sort_depth");
    // Four rounds: the result is where the input was.
    sort_.record(commands, buffers.visible.order(), buffers.visible.spare(), buffers.scratch.address<gpu::uint>(), buffers.state,
                 FrameBuffers::visibleList(list), 32);
}

const Kernel& Passes::rasterizeKernel(Kept kept) const {
    return kept.inverse_depth_moments ? rasterize_moments_ : kept.depth ? rasterize_depth_ : rasterize_colour_;
}

void Passes::recordEye(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, int eye, int list, glm::uvec2 size_tiles, const EyeImage& image,
                       const glm::vec3& background, Kept kept, const std::string& role) const {
    const auto eye_index = static_cast<gpu::uint>(eye);
    const std::uint64_t visible_list = FrameBuffers::visibleList(list), pair_list = FrameBuffers::pairList(eye);
    const auto visible = buffers.state.address<gpu::ListState>(visible_list);
    const auto pairs = buffers.state.address<gpu::ListState>(pair_list);
    const auto counters = buffers.state.address<gpu::EyeCounters>(offsetof(FrameState, counters)).at(eye_index);
    const auto per_visible = visible_list + offsetof(gpu::ListState, per_item);
    const auto per_pair = pair_list + offsetof(gpu::ListState, per_item);
    const auto scratch = buffers.scratch.address<gpu::uint>();

    commands.beginPass(role + "4_project");
    commands.dispatchIndirect(project_,
                              gpu::ProjectPass{scene.chunks(), buffers.eyes(), buffers.visible.order().values, visible, buffers.visible.splats(),
                                               buffers.visible.tileBoxes(), buffers.visible.tileCounts(), counters, scene.chunkBits(), eye_index},
                              buffers.state, per_visible);
    commands.beginPass(role + "5_bin");
    scan_.overList(commands, buffers.visible.tileCounts(), scratch, buffers.state, visible_list, pairs, buffers.pairs.capacity());
    commands.dispatchIndirect(bin_,
                              gpu::BinPass{buffers.eyes(), buffers.visible.splats(), buffers.visible.tileBoxes(), buffers.visible.tileCounts(), visible, pairs,
                                           buffers.pairs.pairs().keys, buffers.pairs.pairs().values, eye_index},
                              buffers.state, per_pair);
    commands.beginPass(role + "6_sort_tiles");
    const unsigned tile_bits = static_cast<unsigned>(std::bit_width(size_tiles.x * size_tiles.y));
    const KeyValues sorted = sort_.record(commands, buffers.pairs.pairs(), buffers.pairs.spare(), scratch, buffers.state, pair_list, tile_bits);
    const auto ranges = buffers.tile_ranges.address<gpu::uvec2>();
    commands.fillZero(buffers.tile_ranges);
    commands.dispatchIndirect(tile_ranges_, gpu::TileRangesPass{sorted.keys, pairs, ranges}, buffers.state, per_pair);
    commands.beginPass(role + "7_rasterize");
    commands.dispatch(rasterizeKernel(kept),
                      gpu::RasterizePass{buffers.eyes(), buffers.visible.splats(), sorted.values, ranges, image.colours.address<gpu::vec4>(),
                                         image.depths.address<float>(), image.inverse_depth_moments.address<gpu::vec2>(), background, eye_index},
                      size_tiles.x, size_tiles.y);
}

}  // namespace binosplat
