// The headset's images for both eyes, and how a frame's pictures get into them.
#pragma once

#include "engine/passes/present.h"
#include "xr/layers.h"

#include <array>

namespace binosplat {

// Throws Error (exit code 3) if the runtime does not have 8-bit RGBA or BGRA images.
vk::Format chooseEyeFormat(const xr::Session& session);

class EyeImages {
public:
    // `presenter` must outlive this.
    EyeImages(const xr::Session& session, Presenter& presenter, vk::Format format, glm::uvec2 size_px);

    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    // Frames may be smaller than the images: from now on they have this size, at most sizePx().
    void draw(glm::uvec2 part_px) { part_px_ = glm::min(part_px, size_px_); }
    [[nodiscard]] glm::uvec2 partPx() const { return part_px_; }
    // The runtime turned out to refuse depth: from now on there is none.
    void dropDepth();
    [[nodiscard]] bool takesDepth() const { return depth_[0].handle() != XR_NULL_HANDLE; }

    // No frame in flight presents into them: freeing them need not wait.
    void noteIdle();

    // Before anything is recorded: acquires an eye's image for this frame, and its depth image if
    // `with_depth` is set and the runtime accepts depth.
    void acquire(int eye, bool with_depth);
    // Whether alpha is kept, to show the room behind the scene.
    void seeThrough(bool see_through) { see_through_ = see_through; }
    // Between begin and submit of `commands`, into the images from acquire(); may be repeated. `near` is in
    // scene units.
    void present(Commands& commands, int eye, const Picture& image, const WarpBuffers* tinted_by,
                 double near);
    void clear(Commands& commands, int eye, const glm::vec4& colour);
    // After submit: releases the images from acquire().
    void release();

    // The part of `eye` that was presented in this frame, for a layer.
    [[nodiscard]] xr::LayerEye layerEye(int eye, const xr::EyeView& view, double near_m) const;

private:
    Presenter& presenter_;
    glm::uvec2 size_px_, part_px_;
    std::array<xr::Swapchain, 2> colour_, depth_;
    std::array<vk::Image, 2> colour_now_{}, depth_now_{};  // this frame's; null: not acquired
    std::array<bool, 2> shows_depth_{};
    bool see_through_ = false;
};

}  // namespace binosplat
