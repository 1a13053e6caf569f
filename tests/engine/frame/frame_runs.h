// Running whole frames in tests: one call, and all that they leave.
#pragma once

#include "engine/frame/stereo_frame.h"
#include "tests/engine/frame/gpu_scenes.h"
#include "tests/engine/gpu/gpu_fixture.h"

#include <array>

namespace binosplat::test {

// While it lives a frame on the tests' own device has the kernels that were made before it in this program. They are those of frames
// whose options leave the threads of a cell to the device: a frame that chose them makes its own.
class KeptKernels {
public:
    KeptKernels(const Context& context, StereoFrame& frame, const FrameOptions& options = {})
        : frame_(frame), pool_(&context == &Gpu::shared() && options.threads_per_cell == 0 ? &pool() : nullptr) {
        if (pool_ != nullptr) { frame_.takeKernels(pool_->frame); }
    }
    KeptKernels(const KeptKernels&) = delete;
    KeptKernels& operator=(const KeptKernels&) = delete;
    ~KeptKernels() {
        if (pool_ != nullptr) { pool_->frame.takeKernels(frame_); }
    }

private:
    struct Pool {
        GpuScene scene{Gpu::shared(), viewBuiltin("builtin:one-splat", {16, 16}).scene};
        StereoFrame frame{Gpu::shared(), scene};
    };
    static Pool& pool() {
        static Pool made;
        return made;
    }

    StereoFrame& frame_;
    Pool* pool_;
};

struct MonoFrame {
    FrameResult result;
    Image picture, depth, moments;
};
inline MonoFrame renderMono(const Context& context, const Scene& scene, const Eye& eye, const FrameSettings& settings,
                            const FrameOptions& options = {}) {
    const GpuScene gpu_scene(context, scene);
    StereoFrame frame(context, gpu_scene, options);
    const KeptKernels kept(context, frame, options);
    FrameResult result = frame.render({&eye, 1}, settings);
    return {std::move(result), frame.readPicture(0), frame.readDominantDepth(),
            settings.keep_moments ? frame.readInverseDepthMoments() : Image{}};
}

struct PairOfPictures {
    FrameResult result;
    std::array<Image, 2> pictures;
};
inline PairOfPictures renderPair(const Context& context, const Scene& scene, const std::array<Eye, 2>& eyes, const FrameSettings& settings,
                                 const FrameOptions& options = {}) {
    const GpuScene gpu_scene(context, scene);
    StereoFrame frame(context, gpu_scene, options);
    const KeptKernels kept(context, frame, options);
    FrameResult result = frame.render(eyes, settings);
    return {std::move(result), {frame.readPicture(kLeft), frame.readPicture(kRight)}};
}

}  // namespace binosplat::test
