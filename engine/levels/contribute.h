// contribute: what each splat of a picture makes up of it. Not of frames: for thinning a scene out (engine/levels).
#pragma once

#include "engine/passes/passes.h"

namespace binosplat {

// 64-bit words of `sums` per splat of the scene.
inline std::uint64_t sumsPerSplat(bool fits) { return fits ? gpu::kContributionSums : 1; }
// After recordPictures of all of one target, whose pairs lie in `buffers` alone and whose picture has floats. Adds to `sums`. `wanted`: a
// picture of the same size, or null for the weights alone.
void recordContributions(PassKernels& kernels, Commands& commands, const GpuScene& scene, const FrameBuffers& buffers,
                         const Targets& targets, const Picture& picture, const Picture* wanted, const Buffer& sums);

}  // namespace binosplat
