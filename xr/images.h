// Copies between images on their way to a headset's runtime or a window: outside any pass, in a caller's
// commands.
#pragma once

#include "engine/gpu/context.h"

#include <glm/glm.hpp>

namespace binosplat {

// The written image is left as an attachment; its old content is lost. `from` must be readable by copies
// (eTransferSrcOptimal).
void copyImage(const vk::raii::CommandBuffer& commands, vk::Image from, vk::Image to, glm::uvec2 size_px);
// The same for display-encoded pixels (sRGB), as light. On the way they are in `encoded`, an image of the
// sRGB format with their bytes.
void decodeImage(const vk::raii::CommandBuffer& commands, vk::Image from, vk::Image encoded, vk::Image to,
                 glm::uvec2 size_px);
// A whole texture from tightly packed rows, which shaders may read before and after.
void copyToTexture(const vk::raii::CommandBuffer& commands, vk::Buffer texels, vk::Image texture,
                   glm::uvec2 size_px);
void clearImage(const vk::raii::CommandBuffer& commands, vk::Image image, const glm::vec4& colour);
// Fills the other `levels` with smaller copies of level 0, each from the one before. All are attachments
// before and after.
void makeMips(const vk::raii::CommandBuffer& commands, vk::Image image, glm::uvec2 size_px,
              std::uint32_t levels);
// True if the device can do that with images of this format.
bool canMakeMips(const Context& context, vk::Format format);

}  // namespace binosplat
