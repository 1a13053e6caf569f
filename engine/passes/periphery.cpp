// Recording the passes of an eye's periphery.
#include "engine/passes/periphery.h"

#include <cstddef>

namespace binosplat {
namespace {

constexpr gpu::uint groupsOver(std::uint64_t items, gpu::uint group) { return static_cast<gpu::uint>((items + group - 1) / group); }

glm::uvec2 halfOf(glm::uvec2 size_px) { return (size_px + 1u) / 2u; }

std::uint64_t tileCount(glm::uvec2 size_px) {
    const glm::uvec2 tiles = tilesOf(size_px);
    return std::uint64_t{tiles.x} * tiles.y;
}

// A mask, a list, and the list of those with pairs.
std::uint64_t wordsOf(glm::uvec2 size_px) { return WarpBuffers::maskWords(size_px) + 2 * tileCount(size_px); }

gpu::PeripheryPass passOf(const PeripheryInputs& in, const TileMask& tiles, int index) {
    const std::size_t list = in.fromPasts() ? offsetof(TargetState, wanted_tiles) : offsetof(TargetState, chosen_tiles);
    return {.colours = in.half.colours.address<gpu::vec4>(),
            .half_colours = in.half.colours.address<gpu::uvec2>(),
            .shown_mask = in.shown.mask(),
            .tile_list = tiles.list,
            .tile_mask = tiles.mask,
            .tile_kinds = index == in.index ? in.kinds : in.half_kinds,
            .tile_losses = in.tiles.losses(),
            .chosen_tiles = in.buffers.state.address<gpu::ListState>(FrameBuffers::targetField(index, list)),
            .size_px = in.tiles.sizePx(),
            .gaze = eyeGazeOf(in.gaze, in.lens)};
}

}  // namespace

Eye halfOf(const Eye& eye) {
    Eye half = eye;
    half.size_px = halfOf(eye.size_px);
    half.own_pixel_px = 0.5 * eye.own_pixel_px;
    half.intrinsics = {0.5 * eye.intrinsics.fx, 0.5 * eye.intrinsics.fy, 0.5 * eye.intrinsics.cx, 0.5 * eye.intrinsics.cy};
    return half;
}

PeripheryBuffers::PeripheryBuffers(const Context& context, glm::uvec2 size_px) : size_px_(size_px) {
    if (size_px.x == 0) { return; }
    words_ =
        Buffer(context, "tiles of a periphery", (wordsOf(size_px) + wordsOf(halfOf(size_px)) + tileCount(size_px)) * sizeof(gpu::uint));
}

TileMask PeripheryBuffers::ofHalf() const { return tilesAt(wordsOf(size_px_), halfOf(size_px_)); }

gpu::DeviceAddress<gpu::uint> PeripheryBuffers::losses() const {
    return words_.address<gpu::uint>((wordsOf(size_px_) + wordsOf(halfOf(size_px_))) * sizeof(gpu::uint));
}

TileMask PeripheryBuffers::tilesAt(std::uint64_t first_word, glm::uvec2 size_px) const {
    const auto mask = words_.address<gpu::uint>(first_word * sizeof(gpu::uint));
    const auto list = mask.at(WarpBuffers::maskWords(size_px));
    return {mask, list, list.at(tileCount(size_px))};
}

KernelTable peripheryKernels() {
    KernelTable table = everyVariant<PeripheryKernel>([](const PeripheryKernel& k) { return k.of_half == 0 || k.half_colours == 0; });
    append(table, everyVariant<FillPeripheryKernel>());
    return table;
}

void PeripheryPasses::recordHalfChoice(Commands& commands, const PeripheryInputs& in) {
    commands.beginPass({in.role, PeripheryKernel::kStage, PeripheryKernel::kShader});
    commands.fillZero(in.tiles.buffer());
    if (in.half.words.bytes() > 0) {  // nothing is known of what is not made; its colours are sampled across the border
        std::vector<const Buffer*> unknown{&in.half.words, &in.half.tiles, &in.half.colours};
        if (!in.fromPasts()) { unknown.push_back(&in.target.tiles); }
        for (const Buffer* buffer : unknown) {
            commands.beside();
            commands.fillZero(*buffer);
        }
    }
    commands.dispatch(kernels_.get(PeripheryKernel{.of_half = 1}), passOf(in, in.tiles.ofHalf(), in.half_index),
                      groupsOver(tileCount(halfOf(in.tiles.sizePx())), gpu::kWarpGroup));
}

void PeripheryPasses::recordChoice(Commands& commands, const PeripheryInputs& in) {
    commands.beginPass({in.role, PeripheryKernel::kStage, PeripheryKernel::kShader});
    commands.dispatch(kernels_.get(PeripheryKernel{.half_colours = in.half.half_floats}), passOf(in, in.tiles.own(), in.index),
                      groupsOver(tileCount(in.tiles.sizePx()) * gpu::kHalfTileRows, gpu::kWarpGroup));
}

void PeripheryPasses::recordFill(Commands& commands, const PeripheryInputs& in) {
    commands.beginPass({in.role, FillPeripheryKernel::kStage, FillPeripheryKernel::kShader});
    const gpu::FillPeripheryPass pass{.source = in.half.colours.address<gpu::vec4>(),
                                      .half_source = in.half.colours.address<gpu::uvec2>(),
                                      .source_depths = in.half.depths.address<float>(),
                                      .target = in.target.colours.address<gpu::vec4>(),
                                      .half_target = in.target.colours.address<gpu::uvec2>(),
                                      .depths = in.target.depths.address<float>(),
                                      .tile_mask = in.tiles.own().mask,
                                      .shown_mask = in.shown.mask(),
                                      .source_words = in.half.words.address<gpu::uint>(),
                                      .words = in.target.words.address<gpu::uint>(),
                                      .source_tiles = in.half.tiles.address<gpu::PastTile>(),
                                      .tiles = in.target.tiles.address<gpu::PastTile>(),
                                      .tile_losses = in.tiles.losses(),
                                      .background = in.background,
                                      .size_px = in.tiles.sizePx()};
    const glm::uvec2 tiles = tilesOf(in.tiles.sizePx());
    const FillPeripheryKernel kernel{
        .depth = in.target.depths.bytes() > 0, .half_colours = in.target.half_floats, .past = in.target.words.bytes() > 0};
    commands.dispatch(kernels_.get(kernel), pass, groupsOver(tiles.x, gpu::kFillTiles), tiles.y);
}

}  // namespace binosplat
