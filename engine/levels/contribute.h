// contribute: how much each splat contributes to a picture. Not part of frames: for thinning out scenes
// (engine/levels).
#pragma once

#include "engine/passes/passes.h"

namespace binosplat {

// 64-bit words of `sums` per splat of the scene.
inline std::uint64_t sumsPerSplat(bool fits) { return fits ? gpu::kContributionSums : gpu::kErrorSums; }
// After recordPictures for all of one target, whose pairs are only in `buffers` and whose picture has floats.
// Adds to `sums`, against a picture of the same size.
void recordContributions(PassKernels& kernels, Commands& commands, const GpuScene& scene,
                         const FrameBuffers& buffers, const Targets& targets, const Picture& picture,
                         const Picture& wanted, const Buffer& sums, bool fits);

}  // namespace binosplat
