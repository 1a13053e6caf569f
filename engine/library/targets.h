// From pictures to the images of a program.
#pragma once

#include "engine/frame/settings.h"
#include "engine/gpu/kernel.h"
#include "engine/library/binosplat_vulkan.h"
#include "engine/passes/warp_buffers.h"

#include <array>

namespace binosplat {

// Throws Error if it makes no sense, alone or with such pictures.
void checkTarget(const bsp_target& target, bool half_floats, bool has_background);

class TargetImages {
public:
    explicit TargetImages(const Context& context);
    // Where the program's depths will lie, for a view's splats to be tested one by one; and records that they are brought there.
    MeshDepths meshDepths(const bsp_target& target, glm::uvec2 size_px, std::size_t view);
    void readDepths(Commands& commands, const bsp_target& target, glm::uvec2 size_px, std::size_t view);
    // Makes its kernel before it is needed.
    void makeKernels(bool half_floats) { kernels_.get(PresentKernel{.half_colours = half_floats}); }
    // Records it; all views share the buffer that their colours go through. `is_cut`: its depths are read already.
    void record(Commands& commands, const Picture& picture, const bsp_target& target, std::size_t view, bool is_cut);

private:
    const Context& context_;
    KernelCache kernels_;
    Buffer& depthsOf(std::size_t view, glm::uvec2 size_px);

    Buffer pixels_;
    std::array<Buffer, 4> depths_;  // by view
};

}  // namespace binosplat
