// Records `contribute`.
#include "engine/levels/contribute.h"

namespace binosplat {

void recordContributions(PassKernels& kernels, Commands& commands, const GpuScene& scene,
                         const FrameBuffers& buffers, const Targets& targets, const Picture& picture,
                         const Picture& wanted, const Buffer& sums, bool fits) {
    const KeyValues& sorted =
        Sort::endsInSpare(tileBits(targets.all_tiles)) ? targets.pairs.spare : targets.pairs.pairs;
    const gpu::ContributePass pass{.eyes = buffers.eyes(),
                                   .splats = buffers.visible.splats(),
                                   .ranks = sorted.values,
                                   .ranges = buffers.tile_ranges.address<gpu::uvec2>(),
                                   .order = buffers.visible.order().values,
                                   .picture = picture.colours.address<gpu::vec4>(),
                                   .wanted = wanted.colours.address<gpu::vec4>(),
                                   .sums = sums.address<gpu::uint>(),
                                   .eye = static_cast<gpu::uint>(targets.first)};
    commands.beginPass({Role::kNone, ContributeKernel::kStage, ContributeKernel::kShader});
    commands.dispatch(kernels.get(contributeKernel(kernels.threadsPerCell(), scene.splatKind(), fits,
                                                   kernels.cellsAreNarrow())),
                      pass, targets.size_tiles.x, targets.size_tiles.y);
}

}  // namespace binosplat
