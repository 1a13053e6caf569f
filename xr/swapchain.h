// Images that the runtime lends to be drawn into.
#pragma once

#include "xr/session.h"

#include <glm/glm.hpp>

#include <vector>

namespace binosplat::xr {

// How images are used.
enum class ImageUse {
    kCopy,   // pictures and depths, copied in
    kDraw,   // the overlay, drawn and copied in
    kFar,    // like kDraw, also seen from afar: with mips by makeMips, if device and runtime have them
    kDepth,  // like kCopy, of a depth format
};

// The first of `wanted` that the runtime has; eUndefined if it has none of them.
vk::Format chooseFormat(const Session& session, std::span<const vk::Format> wanted);

// Move-only owner.
class Swapchain {
public:
    Swapchain() = default;
    Swapchain(const Session& session, const std::string& name, glm::uvec2 size_px, vk::Format format,
              ImageUse use);

    // Lends an image and waits until it is free; it must be released before the frame ends. Throws Lost, or
    // Error if it is not free within ten seconds.
    vk::Image acquire();
    void release();

    // No frame in flight writes the images: freeing them need not wait for any.
    void noteIdle() { swapchain_.get_deleter().waits = false; }

    [[nodiscard]] XrSwapchain handle() const { return swapchain_.get(); }
    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    [[nodiscard]] vk::Format format() const { return format_; }
    // Mip levels of each image: 1, or down to a single pixel.
    [[nodiscard]] std::uint32_t levels() const { return levels_; }
    // The image from its top left corner on, for a layer.
    [[nodiscard]] XrSwapchainSubImage subImage(glm::uvec2 part_px) const;

private:
    // Waits until no frame in flight writes the images.
    struct DestroyIdle {
        const Context* context;
        bool waits;
        void operator()(XrSwapchain swapchain) const;
    };

    const Session* session_ = nullptr;
    Owned<XrSwapchain, DestroyIdle> swapchain_;
    std::vector<vk::Image> images_;
    glm::uvec2 size_px_{0, 0};
    vk::Format format_ = vk::Format::eUndefined;
    std::uint32_t levels_ = 1;
};

}  // namespace binosplat::xr
