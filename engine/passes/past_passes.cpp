// Recording the passes that make an eye from its own past.
#include "engine/passes/past_passes.h"

#include <cstddef>

namespace binosplat {
namespace {

constexpr gpu::uint groupsOver(gpu::uint items, gpu::uint group) { return (items + group - 1) / group; }

auto listAt(const PastInputs& in, std::uint64_t offset) {
    return in.buffers.state.address<gpu::ListState>(FrameBuffers::targetField(in.index, offset));
}
auto countersOf(const PastInputs& in) {
    return in.buffers.state.address<gpu::WarpCounters>(FrameBuffers::targetField(in.index, offsetof(TargetState, warp_counters)));
}
auto viewOf(const PastInputs& in) {
    return in.buffers.state.address<gpu::WarpView>(FrameBuffers::targetField(in.index, offsetof(TargetState, warp)));
}

// Pairs that surely have room, as far as tiles cost what they did when they were rendered last. Lists grow when so much is needed.
gpu::uint mostCost(const FrameCapacity& capacity) { return capacity.pairs - capacity.pairs / 8; }

}  // namespace

gpu::PastView pastViewOf(const Eye& now, const Eye& past, double near, const glm::vec3& background) {
    const EyeRelation relation = relate(past, now);
    return {.past_from_now = relation.source_from_target,
            .now_from_past = relation.target_from_source,
            .size_px = now.size_px,
            .size_tiles = tilesOf(now.size_px),
            .past_size_px = past.size_px,
            .past_size_tiles = tilesOf(past.size_px),
            .nearest = static_cast<float>(1.0 / near),
            .background = background};
}

KernelTable pastKernels(bool by_address) {
    KernelTable table = everyVariant<WarpPastKernel>([=](const WarpPastKernel& k) { return k.by_address == by_address; });
    append(table, everyVariant<WarpPixelsKernel>([=](const WarpPixelsKernel& k) { return k.by_address == by_address; }));
    append(table, everyVariant<MarkChangedKernel>());
    append(table, everyVariant<PriceKernel>([](const PriceKernel& k) { return k.past == 1; }));
    append(table, everyVariant<SelectKernel>([](const SelectKernel& k) { return k.past == 1 && k.predicted == 1; }));
    return table;
}

void PastPasses::recordWarp(Commands& commands, const PastInputs& in) {
    commands.beginPass({in.role, WarpPastKernel::kStage, WarpPastKernel::kShader});
    const std::uint64_t blocks = FrameBuffers::targetField(in.index, offsetof(TargetState, past_blocks));
    const gpu::WarpPastPass pass{
        .view = in.buffers.state.address<gpu::PastView>(FrameBuffers::targetField(in.index, offsetof(TargetState, past))),
        .source = in.source.colours.address<gpu::vec4>(),
        .source_words = in.source.words.address<gpu::uint>(),
        .source_tiles = in.source.tiles.address<gpu::PastTile>(),
        .target = in.target.colours.address<gpu::vec4>(),
        .target_words = in.target.words.address<gpu::uint>(),
        .tiles = in.target.tiles.address<gpu::PastTile>(),
        .tile_kinds = in.warp.tileKinds(),
        .tile_mask = in.warp.tileMask(),
        .price_bins = in.warp.bins(),
        .shown_mask = in.shown,
        .blocks = in.warp.pastBlocks(),
        .block_list = in.buffers.state.address<gpu::PastBlockList>(blocks)};
    const glm::uvec2 size_px = in.target.size_px;
    const WarpPastKernel kernel{.half_colours = in.target.half_floats,
                                .hidden_tiles = in.shown.value != 0,
                                .whole_blocks = size_px.x % gpu::kPastColumns == 0,
                                .by_address = by_address_};
    commands.dispatch(kernels_.get(kernel), pass, groupsOver(size_px.x, gpu::kPastTiles * gpu::kTileSize),
                      groupsOver(size_px.y, gpu::kTileSize));
    commands.beginPass({in.role, WarpPixelsKernel::kStage, WarpPixelsKernel::kShader});
    const WarpPixelsKernel pixels{.half_colours = kernel.half_colours, .hidden_tiles = kernel.hidden_tiles, .by_address = by_address_};
    commands.dispatchIndirect(kernels_.get(pixels), pass, in.buffers.state, blocks + offsetof(gpu::PastBlockList, per_group));
}

void PastPasses::recordChanged(Commands& commands, const PastInputs& in, gpu::DeviceAddress<gpu::ChangedRect> rects, gpu::uint count) {
    if (count == 0) { return; }
    commands.beginPass({in.role, MarkChangedKernel::kStage, MarkChangedKernel::kShader});
    const gpu::MarkChangedPass pass{
        .tiles = in.target.tiles.address<gpu::PastTile>(), .rects = rects, .size_tiles = tilesOf(in.target.size_px), .count = count};
    commands.dispatch(kernels_.get(MarkChangedKernel{}), pass, groupsOver(in.warp.tileCount(), gpu::kWarpGroup));
}

void PastPasses::recordChoice(Commands& commands, std::span<const PastInputs> eyes) {
    const PastInputs& first = eyes.front();
    for (const PastInputs& in : eyes) {
        commands.beginPass({in.role, PriceKernel::kStage, PriceKernel::kShader});
        const gpu::PricePass pass{.warp = viewOf(in),
                                  .tile_kinds = in.warp.tileKinds(),
                                  .tile_costs = in.warp.tileCosts(),
                                  .tile_errors = in.warp.tileErrors(),
                                  .tile_prices = in.warp.tilePrices(),
                                  .price_bins = first.warp.bins(),
                                  .masked_tiles = listAt(in, offsetof(TargetState, chosen_tiles)),
                                  .counters = countersOf(in),
                                  .budget = countersOf(first),
                                  .past_tiles = in.target.tiles.address<gpu::PastTile>(),
                                  .is_last = &in == &eyes.back() ? 1u : 0u,
                                  .area = in.area,
                                  .most_cost = mostCost(in.buffers.capacity()),
                                  .gaze = in.gaze ? eyeGazeOf(*in.gaze, in.lens) : gpu::EyeGaze{}};
        commands.dispatch(kernels_.get(PriceKernel{.foveated = in.gaze.has_value(), .past = true}), pass,
                          groupsOver(in.warp.tileCount(), gpu::kWarpGroup));
    }
    for (const PastInputs& in : eyes) {
        commands.beginPass({in.role, SelectKernel::kStage, SelectKernel::kShader});
        const gpu::SelectPass pass{.warp = viewOf(in),
                                   .tile_kinds = in.warp.tileKinds(),
                                   .tile_prices = in.warp.tilePrices(),
                                   .tile_list = in.warp.tileList(),
                                   .tile_mask = in.warp.tileMask(),
                                   .tile_costs = in.warp.tileCosts(),
                                   .visible = in.buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(0)),
                                   .masked_tiles = listAt(in, offsetof(TargetState, chosen_tiles)),
                                   .masked_visible = listAt(in, offsetof(TargetState, chosen_visible)),
                                   .counters = countersOf(in),
                                   .budget = countersOf(first)};
        commands.dispatch(kernels_.get(SelectKernel{.predicted = true, .past = true}), pass,
                          groupsOver(in.warp.tileCount(), gpu::kWarpGroup));
    }
}

}  // namespace binosplat
