// Runs whole frames in tests: one call returns everything that a frame leaves.
#pragma once

#include "app/scores/metrics.h"
#include "engine/frame/stereo_frame.h"
#include "tests/engine/frame/gpu_scenes.h"
#include "tests/engine/gpu/gpu_fixture.h"

namespace binosplat::test {

// While this exists, frames on the tests' own device reuse kernels that were made earlier in this program.
// This applies to frames whose options leave the threads per cell to the device; those that choose the number
// make kernels of their own.
class KeptKernels {
public:
    KeptKernels(const Context& context, StereoFrame& frame, const FrameOptions& options = {})
        : frame_(frame),
          pool_(&context == &Gpu::shared() && options.threads_per_cell == 0 ? &pool() : nullptr) {
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

struct OwnScene {
    std::optional<GpuScene> own_scene;
};
// A frame with such kernels, of a scene on the device or of one that it uploads itself. While one exists,
// other frames make their kernels again, unless they come from StereoFrame::beside it.
class KeptFrame : private OwnScene, public StereoFrame {
public:
    KeptFrame(const Context& context, const GpuScene& scene, const FrameOptions& options = {})
        : StereoFrame(context, scene, options), kept_(context, *this, options) {}
    KeptFrame(const Context& context, const Scene& scene, const FrameOptions& options = {})
        : OwnScene{std::optional<GpuScene>(std::in_place, context, scene)},
          StereoFrame(context, *own_scene, options),
          kept_(context, *this, options) {}

private:
    KeptKernels kept_;
};

// 0 before the first frame.
inline std::uint64_t countOf(const FrameResult& result, const char* name) {
    const auto counters = result.counters.named();
    return counters.empty() ? 0 : counters.at(name);
}

inline std::array<Image, 2> picturesOf(StereoFrame& frame) {
    return {frame.readPicture(kLeft), frame.readPicture(kRight)};
}

using PairOfValues = std::array<std::vector<float>, 2>;
inline PairOfValues shownBy(StereoFrame& frame) {
    return {frame.readPicture(kLeft).values, frame.readPicture(kRight).values};
}

// The lower value of the two eyes.
inline double psnrDb(const std::array<Image, 2>& a, const std::array<Image, 2>& b) {
    return std::min(compare(a[kLeft], b[kLeft]).psnrDb(), compare(a[kRight], b[kRight]).psnrDb());
}

struct MonoFrame {
    FrameResult result;
    Image picture, depth, moments;
};
inline MonoFrame renderMono(const Context& context, const Scene& scene, const Eye& eye,
                            const FrameSettings& settings, const FrameOptions& options = {}) {
    KeptFrame frame(context, scene, options);
    FrameResult result = frame.render({&eye, 1}, settings);
    return {std::move(result), frame.readPicture(0), frame.readDominantDepth(),
            settings.keep_moments ? frame.readInverseDepthMoments() : Image{}};
}

struct PairOfPictures {
    FrameResult result;
    std::array<Image, 2> pictures;
};
inline PairOfPictures renderPair(const Context& context, const Scene& scene, const std::array<Eye, 2>& eyes,
                                 const FrameSettings& settings, const FrameOptions& options = {}) {
    KeptFrame frame(context, scene, options);
    FrameResult result = frame.render(eyes, settings);
    return {std::move(result), picturesOf(frame)};
}

}  // namespace binosplat::test
