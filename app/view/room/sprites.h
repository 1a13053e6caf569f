// The small pictures that hang in the room beside the panel: rays, controllers, the teleport target. Drawn by
// the program.
#pragma once

#include "app/view/room/strips.h"

#include <vulkan/vulkan_raii.hpp>

#include <cstdint>
#include <vector>

namespace binosplat {

enum class Sprite {
    kRay,        // uniform along its length
    kFadingRay,  // fades out from top to bottom
    kHandle,     // of a controller; its top is the lower end
    kKnob,       // at a controller's front
    kTarget,     // on the floor
    kBlocked,    // the same where one cannot stand
    kRing,       // where a ray meets the scene
    kVignette,   // clear in the middle
    kShade,      // black, and transparent: the first of kShades, from the faintest to the darkest
};
inline constexpr int kShades = 16;
inline constexpr glm::uvec2 kMessagePx(768, 104);
inline constexpr glm::dvec3 kRayLight(1.0, 0.7, 0.1), kBlockedLight(1.0, 0.05, 0.02);

// A sprite that hangs in the room.
struct Thing {
    Sprite sprite;
    Strip strip;
};

// Where a picture is in the sheet of all sprites.
struct SpritePlace {
    glm::uvec2 from_px, size_px;
};
SpritePlace placeOf(Sprite sprite);
// For messages: "a ray".
const char* nameOf(Sprite sprite);
// That of a shade of so much darkness, above 0 up to 1.
SpritePlace placeOfShade(double darkness);

// The layout of texels in a swapchain's images.
struct TexelLayout {
    bool blue_first, linear;  // BGRA in place of RGBA; bytes are linear light, not sRGB
};
TexelLayout texelLayoutOf(vk::Format format);

// `light` is 0 to 1 and not premultiplied by alpha; the bytes are, as layers are blended.
std::uint32_t texelOf(const glm::dvec3& light, double alpha, const TexelLayout& layout);

// Rows top to bottom.
struct TexelPicture {
    glm::uvec2 size_px{0, 0};
    std::vector<std::uint32_t> texels;
};
TexelPicture drawSprites(const TexelLayout& layout);

}  // namespace binosplat
