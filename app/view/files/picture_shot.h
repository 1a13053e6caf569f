// Renders a picture alongside the frames, which must not wait for it.
#pragma once

#include "engine/frame/stereo_frame.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace binosplat {

class PictureShot {
public:
    // What these eyes see of `scene`, which must exist until the picture is taken.
    PictureShot(const Context& context, const GpuScene& scene, std::vector<Eye> eyes,
                const FrameSettings& settings)
        : context_(&context), scene_(scene.asItIs()), eyes_(std::move(eyes)), settings_(settings) {}

    // Each pixel becomes the mean of the four of a picture twice as wide and as high.
    void smoothen() { is_smooth_ = true; }
    // With a frame and kernels of its own, on any thread, while other frames go on. Waits for the device.
    // Throws Error if it does not have enough memory.
    [[nodiscard]] std::vector<Image> take() const {
        StereoFrame frame(*context_, scene_);
        const int samples = is_smooth_ ? 4 : 1;
        std::vector<Image> means;
        for (int sample = 0; sample < samples; ++sample) {
            frame.render(is_smooth_ ? eyesOf(sample) : eyes_, settings_);
            for (std::size_t e = 0; e < eyes_.size(); ++e) {
                Image picture = frame.readPicture(static_cast<int>(e));
                for (float& value : picture.values) { value /= static_cast<float>(samples); }
                if (sample == 0) {
                    means.push_back(std::move(picture));
                    continue;
                }
                std::ranges::transform(means[e].values, picture.values, means[e].values.begin(), std::plus());
            }
        }
        return means;
    }

private:
    // Eyes that see the middles of a quarter of each pixel, with the low-pass of pixels half as wide.
    [[nodiscard]] std::vector<Eye> eyesOf(int sample) const {
        std::vector<Eye> eyes = eyes_;
        for (Eye& eye : eyes) {
            eye.intrinsics.cx += sample % 2 == 0 ? 0.25 : -0.25;
            eye.intrinsics.cy += sample / 2 == 0 ? 0.25 : -0.25;
            eye.own_pixel_px = 0.5;
        }
        return eyes;
    }

    const Context* context_;
    GpuScene scene_;
    std::vector<Eye> eyes_;
    FrameSettings settings_;
    bool is_smooth_ = false;
};

}  // namespace binosplat
