// Brings a frame's pictures into the images that a headset's runtime lends for them.
#pragma once

#include "engine/gpu/kernel.h"
#include "engine/passes/warp_buffers.h"

#include <utility>

namespace binosplat {

// An eye's picture and what is shown along with it.
struct PresentedEye {
    const Picture* picture = nullptr;
    glm::uvec2 size_px{0, 0};
    // The affiliated eye's, to tint its pixels by how they were made; or null.
    const WarpBuffers* tinted_by = nullptr;
    vk::Image colour;  // where the picture goes; 8-bit RGBA or BGRA
    // Where its depth goes, D32: near / depth, 0 where there is nothing; or null.
    vk::Image depth;
    // Also write its alpha, by which colours are multiplied in linear light, as headsets blend.
    bool see_through = false;
    // Bits of each word that keep what the previous eye left, as for an anaglyph.
    std::uint32_t kept_bits = 0;
};

// All kernels of `present`.
KernelTable presentKernels();

class Presenter {
public:
    // For images of `colour_format`. Throws Error if it does not have four channels of 8 bits.
    Presenter(const Context& context, vk::Format colour_format);

    [[nodiscard]] static bool takes(vk::Format colour_format);

    // Makes the kernel for half floats before it is needed.
    void makeKernels();
    // What it needs for pictures up to a size.
    struct Buffers {
        Buffer pixels, depths;  // of one eye after another
        Buffer turned;          // see turn()
    };
    // On any thread. `view_px`: of turn(); zero without it. Throws Error if there is not enough memory.
    [[nodiscard]] static Buffers makeBuffers(const Context& context, glm::uvec2 size_px, bool with_depth,
                                             glm::uvec2 view_px);
    // From now on `buffers` is used. Frames in flight may still use the one before, which is returned.
    [[nodiscard]] Buffers exchange(Buffers buffers) { return std::exchange(buffers_, std::move(buffers)); }
    // For pictures of that size, while nothing recorded is in flight. Throws Error if there is not enough
    // memory.
    void reserve(glm::uvec2 size_px, bool with_depth);
    // Records `present`, allocating memory first. `near` is in scene units.
    void record(Commands& commands, const PresentedEye& eye, double near);
    // Makes its kernels again, see Context::replacedShaders. Throws Error if one cannot be made, and then
    // keeps the old ones.
    void rebuildKernels() { kernels_.rebuild(); }
    // The bytes of the eye that was recorded last, rows top to bottom, for showing them elsewhere.
    [[nodiscard]] const Buffer& pixels() const { return buffers_.pixels; }
    [[nodiscard]] bool turns() const { return buffers_.turned.bytes() > 0; }
    // The same bytes as seen by a view from the same place with other axes. The matrix maps places in the
    // view, in pixels, to those in the picture. Allocates memory first; only the first one in a submission
    // may need to.
    const Buffer& turn(Commands& commands, glm::uvec2 picture_px, glm::uvec2 view_px,
                       const glm::dmat3& picture_from_view);

private:
    static void grow(const Context& context, Buffers& buffers, glm::uvec2 size_px, bool with_depth,
                     glm::uvec2 view_px);

    const Context& context_;
    KernelCache kernels_;
    bool blue_first_, linear_;
    Buffers buffers_;
};

}  // namespace binosplat
