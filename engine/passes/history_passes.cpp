// Records the passes that make an eye from its own history.
#include "engine/passes/history_passes.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

namespace binosplat {
namespace {

constexpr gpu::uint groupsOver(gpu::uint items, gpu::uint group) { return (items + group - 1) / group; }

}  // namespace

gpu::HistoryView historyViewOf(const Eye& now, const Eye& history, double near, const glm::vec3& background) {
    const EyeRelation relation = relate(history, now);
    return {.history_from_now = relation.source_from_target,
            .now_from_history = relation.target_from_source,
            .size_px = now.size_px,
            .size_tiles = tilesOf(now.size_px),
            .history_size_px = history.size_px,
            .history_size_tiles = tilesOf(history.size_px),
            .nearest = static_cast<float>(1.0 / near),
            .background = background};
}

void recordFromHistory(PassKernels& kernels, Commands& commands, const HistoryInputs& in) {
    commands.beginPass({in.role, WarpHistoryKernel::kStage, WarpHistoryKernel::kShader});
    const std::uint64_t blocks = FrameBuffers::targetField(in.index, offsetof(TargetState, history_blocks));
    const gpu::WarpHistoryPass pass{.view = in.buffers.state.address<gpu::HistoryView>(
                                        FrameBuffers::targetField(in.index, offsetof(TargetState, history))),
                                    .source = in.source.colours.address<gpu::vec4>(),
                                    .source_words = in.source.words.address<gpu::uint>(),
                                    .source_tiles = in.source.tiles.address<gpu::HistoryTile>(),
                                    .target = in.target.colours.address<gpu::vec4>(),
                                    .target_words = in.target.words.address<gpu::uint>(),
                                    .tiles = in.target.tiles.address<gpu::HistoryTile>(),
                                    .tile_kinds = in.warp.tileKinds(),
                                    .tile_mask = in.warp.tileMask(),
                                    .price_bins = in.warp.bins(),
                                    .shown_mask = in.shown,
                                    .history_shown = in.source_shown,
                                    .blocks = in.warp.historyBlocks(),
                                    .block_list = in.buffers.state.address<gpu::HistoryBlockList>(blocks)};
    const glm::uvec2 size_px = in.target.size_px;
    const WarpHistoryKernel kernel{.half_colours = in.target.half_floats,
                                   .hidden_tiles = in.shown.value != 0 || in.source_shown.value != 0,
                                   .whole_blocks = size_px.x % gpu::kHistoryColumns == 0,
                                   .by_address = kernels.byAddress()};
    commands.dispatch(kernels.get(kernel), pass, groupsOver(size_px.x, gpu::kHistoryTiles * gpu::kTileSize),
                      groupsOver(size_px.y, gpu::kTileSize));
    commands.beginPass({in.role, WarpPixelsKernel::kStage, WarpPixelsKernel::kShader});
    const WarpPixelsKernel pixels{.half_colours = kernel.half_colours,
                                  .hidden_tiles = kernel.hidden_tiles,
                                  .by_address = kernels.byAddress()};
    commands.dispatchIndirect(kernels.get(pixels), pass, in.buffers.state,
                              blocks + offsetof(gpu::HistoryBlockList, per_group));
}

void recordChanged(PassKernels& kernels, Commands& commands, const HistoryInputs& in,
                   gpu::DeviceAddress<gpu::ChangedRect> rects, gpu::uint count) {
    if (count == 0) { return; }
    commands.beginPass({in.role, MarkChangedKernel::kStage, MarkChangedKernel::kShader});
    const gpu::MarkChangedPass pass{.tiles = in.target.tiles.address<gpu::HistoryTile>(),
                                    .rects = rects,
                                    .size_tiles = tilesOf(in.target.size_px),
                                    .count = count};
    commands.dispatch(kernels.get(MarkChangedKernel{}), pass,
                      groupsOver(in.warp.tileCount(), gpu::kWarpGroup));
}

void recordChoice(PassKernels& kernels, Commands& commands, std::span<const HistoryInputs> eyes,
                  gpu::uint at_once, gpu::uint most_pairs) {
    const HistoryInputs& first = eyes.front();
    const std::uint64_t target = FrameBuffers::targetField(first.index, 0);
    std::uint32_t most_tiles = 0;
    bool foveated = false;
    for (const HistoryInputs& in : eyes) {
        most_tiles = std::max(most_tiles, in.warp.tileCount());
        foveated = foveated || in.gaze;
    }
    const auto targets = first.buffers.state.address<gpu::TargetState>(target);
    const auto chosen =
        first.buffers.state.address<gpu::ListState>(target + offsetof(TargetState, chosen_tiles));
    const auto dispatch = [&](const auto& kernel, const auto& pass) {
        using K = std::remove_cvref_t<decltype(kernel)>;
        commands.beginPass({eyes.size() > 1 ? Role::kBoth : first.role, K::kStage, K::kShader});
        commands.dispatch(kernels.get(kernel), pass, groupsOver(most_tiles, gpu::kWarpGroup), 1,
                          static_cast<std::uint32_t>(eyes.size()));
    };
    dispatch(PriceKernel{.foveated = foveated, .history = true},
             gpu::PricePass{.targets = targets,
                            .chosen = chosen,
                            .price_bins = first.warp.bins(),
                            // Surely fits, if tiles cost what they did when they were rendered last. Lists
                            // grow when that many are needed.
                            .most_cost = most_pairs - most_pairs / 8});
    dispatch(
        SelectKernel{.predicted = true, .history = true},
        gpu::SelectPass{.targets = targets,
                        .chosen = chosen,
                        .visible = first.buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(0)),
                        .at_once = at_once});
}

}  // namespace binosplat
