// From pictures to the images of a program.
#pragma once

#include "engine/gpu/kernel.h"
#include "engine/library/binosplat_vulkan.h"
#include "engine/passes/warp_buffers.h"

namespace binosplat {

// Throws Error if it makes no sense, alone or with such pictures.
void checkTarget(const bsp_target& target, bool half_floats, bool has_background);

class TargetImages {
public:
    explicit TargetImages(const Context& context);
    // Makes its kernel before it is needed.
    void makeKernels(bool half_floats) { kernels_.get(PresentKernel{.half_colours = half_floats}); }
    // Records it; all views share the buffers that it goes through.
    void record(Commands& commands, const Picture& picture, const bsp_target& target);

private:
    const Context& context_;
    KernelCache kernels_;
    Buffer pixels_, depths_;
};

}  // namespace binosplat
