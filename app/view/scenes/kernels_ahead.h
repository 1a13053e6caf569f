// Kernels before the first frame that wants them.
#pragma once

#include "app/options/options.h"
#include "engine/frame.h"

#include <functional>
#include <set>
#include <utility>

namespace binosplat {

// What there is to know of a headset's frames before there are any.
struct FramesAhead {
    StereoOptions stereo;
    glm::uvec2 size_px{0, 0};
    bool with_depth = false, tint = false;
    // Kinds of splats and degrees of colour that kernels were made for before.
    std::set<std::pair<std::uint32_t, int>> known;
};

// For `frame`, whose frames are of `scene`: kernels of what may come without a click, i.e. of the method that was chosen and of what the
// governor may have in its place, with and without what a lens hides and foveation, with eyes side by side and canted ones. Takes what
// drivers take; `between` is called now and then and may throw.
void makeKernelsAhead(const Context& context, const GpuScene& scene, StereoFrame& frame, const CameraOptions& camera,
                      const FramesAhead& ahead, const std::function<void()>& between);

}  // namespace binosplat
