// Records `contribute`.
#include "engine/levels/contribute.h"

namespace binosplat {

void recordContributions(PassKernels& kernels, Commands& commands, const GpuScene& scene,
                         const FrameBuffers& buffers, const Targets& targets, const Picture& picture,
                         const Picture& wanted, const Buffer& sums, bool fits) {
    const PairFormat format = pairFormatOf(buffers, targets);
    const PairArrays pairs = pairsOf(buffers, targets);
    const KeyValues& sorted = format.tile_bits.endInSpare() ? pairs.spare : pairs.pairs;
    const VisibleArrays visible = visibleOf(buffers, targets);
    const gpu::ContributePass pass{.eyes = buffers.eyes(),
                                   .splats = visible.splats,
                                   .ranks = format.fitsOneWord() ? sorted.keys : sorted.values,
                                   .ranges = buffers.tile_ranges.address<gpu::uvec2>(),
                                   .order = visible.order,
                                   .picture = picture.colours.address<gpu::vec4>(),
                                   .wanted = wanted.colours.address<gpu::vec4>(),
                                   .sums = sums.address<gpu::uint>(),
                                   .eye = static_cast<gpu::uint>(targets.first),
                                   .rank_bits = format.rank_bits};
    commands.beginPass({Role::kNone, ContributeKernel::kStage, ContributeKernel::kShader});
    commands.dispatch(kernels.get(contributeKernel(kernels.threadsPerCell(), scene.splatKind(), fits,
                                                   kernels.cellsAreNarrow())),
                      pass, targets.size_tiles.x, targets.size_tiles.y);
}

}  // namespace binosplat
