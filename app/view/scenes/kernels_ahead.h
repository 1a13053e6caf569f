// Compiling kernels before the first frame that needs them.
#pragma once

#include "app/options/options.h"
#include "engine/frame/stereo_frame.h"

#include <atomic>
#include <functional>
#include <set>
#include <thread>
#include <utility>

namespace binosplat {

// What is known about a headset's frames before there are any.
struct FramesAhead {
    StereoOptions stereo;
    glm::uvec2 size_px{0, 0};
    bool with_depth = false, tint = false;
    // The headset's images, which pictures have memory for, and the wearer's resolution that these are for;
    // zero: not known, or any.
    glm::uvec2 images_px{0, 0};
    double resolution_scale = 1.0;
    // Kinds of splats and degrees of colour that kernels were made for before.
    std::set<std::pair<std::uint32_t, int>> known = {};

    // True if the frames of both need the same kernels.
    [[nodiscard]] bool isLike(const FramesAhead& other) const;
    // True if they do apart from their sizes.
    [[nodiscard]] bool hasMethodOf(FramesAhead other) const {
        other.size_px = size_px;
        return isLike(other);
    }
    // True if the same memory suits both.
    [[nodiscard]] bool hasFramesOf(const FramesAhead& other) const {
        // The runtime's limit may make images of two resolutions equally large.
        const bool is_same = images_px == other.images_px && resolution_scale == other.resolution_scale;
        return hasMethodOf(other) && (is_same || images_px.x == 0 || other.images_px.x == 0);
    }
};

// Makes `kernels` of whatever frames of `scene` may come without a click: those of the chosen method, with
// and without hidden tiles and foveation, with parallel and canted eyes. Takes as long as the driver needs;
// `between` is called now and then, by two threads, and may throw.
void makeKernelsAhead(const Context& context, PassKernels& kernels, const GpuScene& scene,
                      const CameraOptions& camera, const FramesAhead& ahead,
                      const std::function<void()>& between);

// The same on a thread of its own, for a scene that is shown.
class KernelMaker {
public:
    // `kernels` and `scene` outlive this.
    KernelMaker(const Context& context, PassKernels& kernels, const GpuScene& scene, CameraOptions camera,
                FramesAhead ahead);
    KernelMaker(const KernelMaker&) = delete;
    KernelMaker& operator=(const KernelMaker&) = delete;
    // Cancels what it can, and waits for the rest.
    ~KernelMaker();

    void cancel() { cancelled_ = true; }
    [[nodiscard]] const FramesAhead& ahead() const { return ahead_; }
    [[nodiscard]] bool isDone() const { return done_; }
    // Once done: true if it was cancelled in time. If it failed, a frame that needs the kernels will report
    // that.
    [[nodiscard]] bool hasGivenUp() const { return gave_up_; }

private:
    FramesAhead ahead_;
    std::atomic<bool> done_ = false, cancelled_ = false;
    bool gave_up_ = false;
    std::thread thread_;
};

}  // namespace binosplat
