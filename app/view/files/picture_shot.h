// Renders a picture alongside the frames, which must not wait for it.
#pragma once

#include "engine/frame/stereo_frame.h"

#include <utility>
#include <vector>

namespace binosplat {

class PictureShot {
public:
    // What these eyes see of `scene`, which must exist until the picture is taken.
    PictureShot(const Context& context, const GpuScene& scene, std::vector<Eye> eyes,
                const FrameSettings& settings)
        : context_(&context), scene_(scene.asItIs()), eyes_(std::move(eyes)), settings_(settings) {}

    // With a frame and kernels of its own, on any thread, while other frames go on. Waits for the device.
    // Throws Error if it does not have enough memory.
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
