// The passes of a frame: what `ls shaders` shows, as functions that record them.
//
//   1_cull        which splats may touch a pixel of any eye
//   2_compact     those in the scene's order, with the depth of their centres
//   3_sort_depth  front to back
//   4_project     as one eye sees them, and how many tiles each meets
//   5_bin         a (tile, splat) pair for each tile a splat meets
//   6_sort_tiles  the pairs by tile, front to back within
//   7_rasterize   blending: colour, alpha and depth
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/passes/frame_buffers.h"
#include "shaders/shared/passes.h"

#include <string>

namespace binosplat {

// Which of an eye's values the rasterizer keeps beside the colour.
struct Kept {
    bool depth = false;
    bool inverse_depth_moments = false;
};

class Passes {
public:
    // `threads_per_cell`: 8, 16, 32 or 64 invocations blend 8x8 pixels; 0: as wide as the device's subgroups.
    Passes(const Context& context, int sh_degree, std::uint32_t threads_per_cell = 0);

    // Passes 1 to 3 for the eyes [first_eye, first_eye + eye_count): fills list `list` with the splats that any of them sees, by
    // the depths of `order_eye`. `role` goes before the passes' names.
    void recordVisible(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, int first_eye, int eye_count, int order_eye, int list,
                       const std::string& role) const;
    // Passes 2 and 3 alone, once more, by the depths of another eye.
    void recordOrder(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, int order_eye, int list, const std::string& role) const;
    // Passes 4 to 7: the picture of `eye` from the splats in list `list`.
    void recordEye(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, int eye, int list, glm::uvec2 size_tiles, const EyeImage& image,
                   const glm::vec3& background, Kept kept, const std::string& role) const;

private:
    [[nodiscard]] const Kernel& rasterizeKernel(Kept kept) const;

    Scan scan_;
    Sort sort_;
    Kernel cull_, compact_, project_, bin_, tile_ranges_;
    Kernel rasterize_colour_, rasterize_depth_, rasterize_moments_;
};

}  // namespace binosplat
