// The headset's images for both eyes, and how a frame's pictures get into them.
#pragma once

#include "engine/present.h"
#include "xr/layers.h"

#include <array>

namespace binosplat {

// Throws Error (exit code 3) if the runtime has no 8-bit RGBA or BGRA images.
vk::Format chooseEyeFormat(const xr::Session& session);

class EyeImages {
public:
    // `presenter` outlives this.
    EyeImages(const xr::Session& session, Presenter& presenter, vk::Format format, glm::uvec2 size_px);

    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    [[nodiscard]] bool takesDepth() const { return depth_[0].handle() != XR_NULL_HANDLE; }

    // Between begin and submitAndWait of `commands`. `near` in scene units; the depth goes along where the eye has one.
    void present(Commands& commands, int eye, const EyeImage& image, const StereoBuffers* tinted_by, double near);
    void clear(Commands& commands, int eye, const glm::vec3& colour);
    // After submitAndWait: gives back what present and clear took.
    void release();

    // What of `eye` was presented in this frame, as a layer shows it.
    [[nodiscard]] xr::LayerEye layerEye(int eye, const xr::EyeView& view, double near_m) const;

private:
    Presenter& presenter_;
    glm::uvec2 size_px_;
    std::array<xr::Swapchain, 2> colour_, depth_;
    std::array<bool, 2> colour_taken_{}, depth_taken_{};  // and not given back
    std::array<bool, 2> shows_depth_{};
};

}  // namespace binosplat
