// Records `contribute`.
#include "engine/levels/contribute.h"

namespace binosplat {

void recordContributions(PassKernels& kernels, Commands& commands, const GpuScene& scene, const FrameBuffers& buffers,
                         const Targets& targets, const Picture& picture, const Picture* wanted, const Buffer& sums) {
    const KeyValues& sorted = Sort::endsInSpare(tileBits(targets.all_tiles)) ? targets.pairs.spare : targets.pairs.pairs;
    gpu::ContributePass pass{.eyes = buffers.eyes(),
                             .splats = buffers.visible.splats(),
                             .ranks = sorted.values,
                             .ranges = buffers.tile_ranges.address<gpu::uvec2>(),
                             .order = buffers.visible.order().values,
                             .picture = {},
                             .wanted = {},
                             .sums = sums.address<gpu::uint>(),
                             .eye = static_cast<gpu::uint>(targets.first)};
    if (wanted != nullptr) {
        pass.picture = picture.colours.address<gpu::vec4>();
        pass.wanted = wanted->colours.address<gpu::vec4>();
    }
    commands.beginPass({Role::kNone, ContributeKernel::kStage, ContributeKernel::kShader});
    commands.dispatch(kernels.get(contributeKernel(kernels.threadsPerCell(), scene.splatKind(), wanted != nullptr)), pass,
                      targets.size_tiles.x, targets.size_tiles.y);
}

}  // namespace binosplat
