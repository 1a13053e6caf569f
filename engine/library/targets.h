// From pictures to a program's images.
#pragma once

#include "engine/frame/settings.h"
#include "engine/gpu/kernel.h"
#include "engine/library/binosplat_vulkan.h"
#include "engine/passes/warp_buffers.h"

#include <array>

namespace binosplat {

// Throws Error if it makes no sense by itself, or with such pictures.
void checkTarget(const bsp_target& target, bool half_floats, bool has_background);

class TargetImages {
public:
    explicit TargetImages(const Context& context);
    // Where the program's depths will be, for testing a view's splats one by one; records their copy to that
    // place.
    MeshDepths meshDepths(const bsp_target& target, glm::uvec2 size_px, std::size_t view);
    void readDepths(Commands& commands, const bsp_target& target, glm::uvec2 size_px, std::size_t view);
    // Makes its kernel in advance.
    void makeKernels(bool half_floats) { kernels_.get(PresentKernel{.half_colours = half_floats}); }
    // Records it; all views' colours go through the same buffer. `is_cut`: its depths have been read already.
    void record(Commands& commands, const Picture& picture, const bsp_target& target, std::size_t view,
                bool is_cut);

private:
    const Context& context_;
    KernelCache kernels_;
    Buffer& depthsOf(std::size_t view, glm::uvec2 size_px);

    Buffer pixels_;
    std::array<Buffer, 4> depths_;  // one for each view
};

}  // namespace binosplat
