// Rendering a picture beside the frames, which must not wait for it.
#pragma once

#include "engine/frame/stereo_frame.h"

#include <utility>
#include <vector>

namespace binosplat {

class PictureShot {
public:
    // What these eyes see of `scene`, which stays until the picture is taken.
    PictureShot(const Context& context, const GpuScene& scene, std::vector<Eye> eyes,
                const FrameSettings& settings)
        : context_(&context), scene_(scene.asItIs()), eyes_(std::move(eyes)), settings_(settings) {}

    // By a frame of its own with kernels of its own, on any thread: frames go on meanwhile. Waits for the
    // device. Throws Error if it lacks the memory.
    [[nodiscard]] std::vector<Image> take() const {
        StereoFrame frame(*context_, scene_);
        frame.render(eyes_, settings_);
        std::vector<Image> pictures;
        for (std::size_t e = 0; e < eyes_.size(); ++e) {
            pictures.push_back(frame.readPicture(static_cast<int>(e)));
        }
        return pictures;
    }

private:
    const Context* context_;
    GpuScene scene_;
    std::vector<Eye> eyes_;
    FrameSettings settings_;
};

}  // namespace binosplat
