// contribute: how much each splat contributes to a picture. Not part of frames: for thinning out scenes
// (engine/levels).
#pragma once

#include "engine/passes/passes.h"

namespace binosplat {

// 64-bit words of `sums` per splat of the scene.
inline std::uint64_t sumsPerSplat(bool fits) { return fits ? gpu::kContributionSums : 1; }
// After recordPictures for all of one target, whose pairs are only in `buffers` and whose picture has floats.
// Adds to `sums`. `wanted`: a picture of the same size, or null for the weights alone.
void recordContributions(PassKernels& kernels, Commands& commands, const GpuScene& scene, const FrameBuffers& buffers,
                         const Targets& targets, const Picture& picture, const Picture* wanted, const Buffer& sums);

}  // namespace binosplat
