// Records `present` and the copies after it.
#include "engine/passes/present.h"

#include "engine/error.h"

#include <algorithm>

namespace binosplat {

KernelTable presentKernels() { return everyVariantOf<PresentKernel, TurnKernel>(); }

bool Presenter::takes(vk::Format format) {
    using Format = vk::Format;
    return format == Format::eR8G8B8A8Srgb || format == Format::eB8G8R8A8Srgb ||
           format == Format::eR8G8B8A8Unorm || format == Format::eB8G8R8A8Unorm;
}

Presenter::Presenter(const Context& context, vk::Format format)
    : context_(context),
      kernels_(context, presentKernels()),
      blue_first_(format == vk::Format::eB8G8R8A8Srgb || format == vk::Format::eB8G8R8A8Unorm),
      linear_(format == vk::Format::eR8G8B8A8Unorm || format == vk::Format::eB8G8R8A8Unorm) {
    check(takes(format), "pictures leave as 8-bit RGBA or BGRA, not as {}", vk::to_string(format));
}

void Presenter::makeKernels() {
    kernels_.get(PresentKernel{.half_colours = true});
    kernels_.get(TurnKernel{});
}

Presenter::Buffers Presenter::makeBuffers(const Context& context, glm::uvec2 size_px, bool with_depth,
                                          glm::uvec2 view_px) {
    Buffers buffers;
    grow(context, buffers, size_px, with_depth, view_px);
    return buffers;
}

void Presenter::reserve(glm::uvec2 size_px, bool with_depth) {
    grow(context_, buffers_, size_px, with_depth, {0, 0});
}

void Presenter::grow(const Context& context, Buffers& buffers, glm::uvec2 size_px, bool with_depth,
                     glm::uvec2 view_px) {
    const auto fit = [&](Buffer& buffer, const char* name, glm::uvec2 px) {
        const std::uint64_t bytes = sizeof(gpu::uint) * px.x * px.y;
        if (buffer.bytes() < bytes) { buffer = Buffer(context, name, bytes); }
    };
    fit(buffers.pixels, "presented pixels", size_px);
    if (with_depth) { fit(buffers.depths, "presented depths", size_px); }
    fit(buffers.turned, "turned pixels", view_px);
}

void Presenter::record(Commands& commands, const PresentedEye& eye, double near) {
    const bool with_depth = eye.depth && (eye.picture->words.bytes() > 0 || eye.picture->depths.bytes() > 0);
    // They only grow before anything in this submission uses them, since both eyes have the same size.
    reserve(eye.size_px, with_depth);
    gpu::PresentPass pass{};
    pass.colours = eye.picture->colours.address<gpu::vec4>();
    pass.half_colours = eye.picture->colours.address<gpu::uvec2>();
    pass.depths = eye.picture->depths.address<float>();
    pass.words = eye.picture->words.address<gpu::uint>();
    pass.of_surface = eye.picture->of_surface ? 1 : 0;
    if (eye.tinted_by != nullptr) {
        pass.tile_kinds = eye.tinted_by->tileKinds();
        pass.pixel_classes = eye.tinted_by->pixelClasses();
    }
    pass.pixels = buffers_.pixels.address<gpu::uint>();
    if (with_depth) { pass.device_depths = buffers_.depths.address<float>(); }
    pass.size_px = eye.size_px;
    pass.depth_scale = static_cast<float>(near);
    pass.blue_first = blue_first_ ? 1 : 0;
    pass.linear = linear_ ? 1 : 0;
    pass.see_through = eye.see_through ? 1 : 0;
    pass.kept_bits = eye.kept_bits;
    commands.beginPass({Role::kNone, PresentKernel::kStage, PresentKernel::kShader});
    commands.dispatch(kernels_.get(PresentKernel{.half_colours = eye.picture->half_floats}), pass,
                      (eye.size_px.x + 15) / 16, (eye.size_px.y + 7) / 8);
    commands.copyToImage(buffers_.pixels, eye.colour, eye.size_px, vk::ImageAspectFlagBits::eColor);
    if (with_depth) {
        commands.copyToImage(buffers_.depths, eye.depth, eye.size_px, vk::ImageAspectFlagBits::eDepth);
    }
}

const Buffer& Presenter::turn(Commands& commands, glm::uvec2 picture_px, glm::uvec2 view_px,
                              const glm::dmat3& picture_from_view) {
    grow(context_, buffers_, picture_px, false, view_px);
    const glm::mat3 matrix(picture_from_view);
    const gpu::TurnPass pass{.pixels = buffers_.pixels.address<gpu::uint>(),
                             .shown = buffers_.turned.address<gpu::uint>(),
                             .column_x = matrix[0],
                             .column_y = matrix[1],
                             .column_z = matrix[2],
                             .picture_px = picture_px,
                             .view_px = view_px,
                             .linear = linear_ ? 1u : 0u};
    commands.beginPass({Role::kNone, TurnKernel::kStage, TurnKernel::kShader});
    commands.dispatch(kernels_.get(TurnKernel{}), pass, (view_px.x + 15) / 16, (view_px.y + 7) / 8);
    return buffers_.turned;
}

}  // namespace binosplat
