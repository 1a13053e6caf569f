// The small pictures that hang in the room beside the panel: rays, controllers, where a wearer will stand. Drawn by the program.
#pragma once

#include "app/view/room/strips.h"

#include <vulkan/vulkan_raii.hpp>

#include <cstdint>
#include <vector>

namespace binosplat {

enum class Sprite {
    kRay,        // bottom to top alike
    kFadingRay,  // its top is seen, its bottom is not
    kHandle,     // of a controller; its top is the lower end
    kKnob,       // at a controller's front
    kTarget,     // on the floor
    kVignette,   // clear in the middle
};

// One that hangs in the room.
struct Thing {
    Sprite sprite;
    Strip strip;
};

// Where a picture is in the sheet of all of them.
struct SpritePlace {
    glm::uvec2 from_px, size_px;
};
SpritePlace placeOf(Sprite sprite);

// How a swapchain's image wants its texels.
struct TexelLayout {
    bool blue_first, linear;  // BGRA in place of RGBA; bytes that are light, not sRGB
};
TexelLayout texelLayoutOf(vk::Format format);

// Light of 0 to 1, not yet multiplied by alpha; the bytes are, as layers are blended.
std::uint32_t texelOf(const glm::dvec3& light, double alpha, const TexelLayout& layout);

// Rows top to bottom.
struct TexelPicture {
    glm::uvec2 size_px{0, 0};
    std::vector<std::uint32_t> texels;
};
TexelPicture drawSprites(const TexelLayout& layout);

}  // namespace binosplat
