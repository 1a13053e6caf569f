// Runs whole frames in tests: one call returns everything that a frame leaves.
#pragma once

#include "app/scores/metrics.h"
#include "engine/frame/stereo_frame.h"
#include "tests/engine/frame/gpu_scenes.h"
#include "tests/engine/gpu/gpu_fixture.h"

namespace binosplat::test {

// The kernels of all frames on the tests' own device whose options leave the threads per cell to the device:
// made once in this program. Other frames make kernels of their own.
struct KeptKernels {
    KeptKernels(const Context& context, const FrameOptions& options) {
        if (&context != &Gpu::shared() || options.threads_per_cell != 0) {
            kernels = &own_kernels.emplace(context, options.threads_per_cell);
            return;
        }
        static PassKernels shared(context);
        kernels = &shared;
    }

    std::optional<PassKernels> own_kernels;
    PassKernels* kernels = nullptr;
};

struct OwnScene {
    std::optional<GpuScene> own_scene;
};
// A frame with such kernels, of a scene on the device or of one that it uploads itself.
class KeptFrame : private OwnScene, private KeptKernels, public StereoFrame {
public:
    KeptFrame(const Context& context, const GpuScene& scene, const FrameOptions& options = {})
        : KeptKernels(context, options), StereoFrame(context, scene, *kernels, options) {}
    KeptFrame(const Context& context, const Scene& scene, const FrameOptions& options = {})
        : OwnScene{std::optional<GpuScene>(std::in_place, context, scene)},
          KeptKernels(context, options),
          StereoFrame(context, *own_scene, *kernels, options) {}
};

// Frames that can have a history keep one.
inline FrameSettings makeSettings(Mode mode, Side dominant = kLeft, std::uint64_t mark = 0) {
    FrameSettings settings;
    settings.mode = mode;
    settings.dominant = dominant;
    settings.mark = mark;
    settings.keep_history = hasHistory(mode);
    return settings;
}

// Where an eye looks that sees little of its picture. One this small shows more than the eye resolves only
// far from the gaze.
inline const Gaze kAside{{-3.0, 1.0, -2.0}, 0.0};

// A head that walks 3 mm a step and turns a little.
inline std::array<Eye, 2> walkedEyes(Eye eye, double step) {
    eye.world_from_camera.position += step * glm::dvec3(0.003, 0.001, 0.001);
    eye.world_from_camera.orientation = eye.world_from_camera.orientation *
                                        glm::angleAxis(0.002 * step, glm::normalize(glm::dvec3(0.2, 1, 0)));
    return stereoPair(eye, 0.063);
}

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
inline PairOfValues renderPair(StereoFrame& frame, std::span<const Eye> eyes, const FrameSettings& settings) {
    frame.render(eyes, settings);
    return shownBy(frame);
}

// One eye's picture in such a frame.
inline Image renderEye(StereoFrame& frame, const Eye& eye,
                       const FrameSettings& settings = makeSettings(Mode::kMono)) {
    frame.render({&eye, 1}, settings);
    return frame.readPicture(0);
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
                            const FrameSettings& settings = makeSettings(Mode::kMono)) {
    KeptFrame frame(context, scene);
    FrameResult result = frame.render({&eye, 1}, settings);
    return {std::move(result), frame.readPicture(0), frame.readDominantDepth(),
            settings.keep_moments ? frame.readInverseDepthMoments() : Image{}};
}

}  // namespace binosplat::test
