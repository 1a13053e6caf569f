// Running whole frames in tests: one call, and all that they leave.
#pragma once

#include "engine/frame.h"
#include "tests/gpu_fixture.h"
#include "tests/gpu_scenes.h"

#include <array>

namespace binosplat::test {

struct MonoFrame {
    FrameResult result;
    Image picture, depth, moments;
};
inline MonoFrame renderMono(const Context& context, const Scene& scene, const Eye& eye, const FrameSettings& settings,
                            const FrameOptions& options = {}) {
    const GpuScene gpu_scene(context, scene);
    StereoFrame frame(context, gpu_scene, options);
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
    FrameResult result = frame.render(eyes, settings);
    return {std::move(result), {frame.readPicture(kLeft), frame.readPicture(kRight)}};
}

}  // namespace binosplat::test
