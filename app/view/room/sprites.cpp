// Draws small pictures, texel by texel.
#include "app/view/room/sprites.h"

#include "app/view/room/vignette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace binosplat {

namespace {

using Format = vk::Format;

constexpr glm::uvec2 kSheetPx(512, 256);
// Filters read a texel beyond the edge. Pictures are more than two rims apart.
constexpr glm::uvec2 kRimPx(2, 2);
constexpr glm::dvec3 kTargetLight(0.2, 0.8, 1.0), kHandleLight(0.16, 0.17, 0.2), kKnobLight(0.35, 0.38, 0.42);
constexpr double kVignetteAlpha = 0.92;
constexpr unsigned kShadePx = 8;

struct Texel {
    glm::dvec3 light;
    double alpha;
};

// Smoothstep: 0 below `from`, 1 above `to`.
double rise(double from, double to, double at) {
    const double t = std::clamp((at - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Round things are brighter where they face the eye; `aside` is 0 in their middle and 1 at their border.
Texel roundThing(const glm::dvec3& light, double aside) {
    const double facing_eye = std::sqrt(std::max(0.0, 1.0 - aside * aside));
    return {light * (0.35 + 0.65 * facing_eye), 1.0 - rise(0.9, 1.0, aside)};
}

// `at` is -1 to 1 in each direction, from the left and from the top.
Texel draw(Sprite sprite, const glm::dvec2& at) {
    const double radius = glm::length(at);
    switch (sprite) {
        case Sprite::kRay:
        case Sprite::kFadingRay: {
            // It begins softly, too.
            const double ray = rise(-1.0, -0.9, at.y) * (1.0 - rise(0.5, 1.0, std::abs(at.x)));
            return {kRayLight, sprite == Sprite::kRay ? ray : ray * (1.0 - rise(-0.8, 1.0, at.y))};
        }
        case Sprite::kHandle: {
            // Round ends, a little thinner below; four times as long as wide.
            const double beyond = std::max(0.0, std::abs(at.y) - 0.75) / 0.25;
            return roundThing(kHandleLight, std::hypot(at.x / (0.9 + 0.1 * at.y), beyond));
        }
        case Sprite::kKnob:
            return roundThing(kKnobLight, radius);
        case Sprite::kRing:
            return {kRayLight, rise(0.5, 0.62, radius) * (1.0 - rise(0.84, 0.98, radius))};
        case Sprite::kTarget:
        case Sprite::kBlocked: {
            const double ring = rise(0.72, 0.78, radius) * (1.0 - rise(0.92, 1.0, radius)),
                         dot = 1.0 - rise(0.12, 0.2, radius);
            return {sprite == Sprite::kTarget ? kTargetLight : kBlockedLight,
                    std::max({ring, dot, 0.25 * (1.0 - rise(0.72, 0.78, radius))})};
        }
        case Sprite::kShade:
            return {glm::dvec3(0.0),
                    std::clamp(std::ceil(0.5 * (at.x + 1.0) * kShades), 1.0, double{kShades}) / kShades};
        case Sprite::kVignette:
            return {glm::dvec3(0.0), kVignetteAlpha * rise(kVignetteClear, kVignetteDark, radius)};
    }
    return {};
}

double encode(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

std::uint32_t byteOf(double value) {
    return static_cast<std::uint32_t>(std::clamp(value, 0.0, 1.0) * 255.0 + 0.5);
}

}  // namespace

SpritePlace placeOf(Sprite sprite) {
    static constexpr std::array<SpritePlace, 9> kBySprite{{{{440, 0}, {16, 64}},
                                                           {{464, 0}, {16, 64}},
                                                           {{400, 0}, {32, 128}},
                                                           {{264, 136}, {64, 64}},
                                                           {{264, 0}, {128, 128}},
                                                           {{344, 156}, {96, 96}},
                                                           {{448, 156}, {48, 48}},
                                                           {{0, 0}, {256, 256}},
                                                           {{344, 140}, {kShades * kShadePx, kShadePx}}}};
    static_assert(kBySprite.size() == static_cast<std::size_t>(Sprite::kShade) + 1);
    return kBySprite[static_cast<std::size_t>(sprite)];
}

const char* nameOf(Sprite sprite) {
    switch (sprite) {
        case Sprite::kRay:
        case Sprite::kFadingRay:
            return "a ray";
        case Sprite::kHandle:
        case Sprite::kKnob:
            return "a controller";
        case Sprite::kRing:
            return "a ring where a ray ends";
        case Sprite::kTarget:
        case Sprite::kBlocked:
            return "the place to teleport to";
        case Sprite::kVignette:
            return "the vignette";
        case Sprite::kShade:
            break;
    }
    return "the dark";
}

SpritePlace placeOfShade(double darkness) {
    const auto shade =
        static_cast<unsigned>(std::clamp(std::ceil(kShades * darkness), 1.0, double{kShades})) - 1;
    // Only its middle, since another one is next to it.
    return {placeOf(Sprite::kShade).from_px + glm::uvec2(shade * kShadePx + 2, 2), glm::uvec2(kShadePx - 4)};
}

TexelLayout texelLayoutOf(vk::Format format) {
    return {format == Format::eB8G8R8A8Srgb || format == Format::eB8G8R8A8Unorm,
            format == Format::eR8G8B8A8Unorm || format == Format::eB8G8R8A8Unorm};
}

std::uint32_t texelOf(const glm::dvec3& light, double alpha, const TexelLayout& layout) {
    std::array<std::uint32_t, 3> bytes{};
    for (int c = 0; c < 3; ++c) {
        const double seen = alpha * light[c];
        bytes[static_cast<std::size_t>(c)] = byteOf(layout.linear ? seen : encode(seen));
    }
    if (layout.blue_first) { std::swap(bytes[0], bytes[2]); }
    return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | byteOf(alpha) << 24;
}

TexelPicture drawSprites(const TexelLayout& layout) {
    TexelPicture sheet{kSheetPx, std::vector<std::uint32_t>(std::size_t{kSheetPx.x} * kSheetPx.y, 0)};
    for (const Sprite sprite :
         {Sprite::kRay, Sprite::kFadingRay, Sprite::kHandle, Sprite::kKnob, Sprite::kTarget, Sprite::kBlocked,
          Sprite::kRing, Sprite::kVignette, Sprite::kShade}) {
        const SpritePlace place = placeOf(sprite);
        // The picture is continued into a rim around it.
        const glm::uvec2 low = place.from_px - glm::min(kRimPx, place.from_px),
                         high = place.from_px + place.size_px + kRimPx;
        for (std::uint32_t y = low.y; y < std::min(high.y, kSheetPx.y); ++y) {
            for (std::uint32_t x = low.x; x < std::min(high.x, kSheetPx.x); ++x) {
                const glm::dvec2 at = 2.0 * (glm::dvec2(x + 0.5, y + 0.5) - glm::dvec2(place.from_px)) /
                                          glm::dvec2(place.size_px) -
                                      1.0;
                const Texel texel = draw(sprite, at);
                std::uint32_t& target = sheet.texels[std::size_t{y} * kSheetPx.x + x];
                const bool is_inside = x >= place.from_px.x && y >= place.from_px.y &&
                                       x < place.from_px.x + place.size_px.x &&
                                       y < place.from_px.y + place.size_px.y;
                if (is_inside || target == 0) { target = texelOf(texel.light, texel.alpha, layout); }
            }
        }
    }
    return sheet;
}

}  // namespace binosplat
