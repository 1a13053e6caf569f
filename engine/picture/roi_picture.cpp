// Origins of pixels from tile kinds and pixel classes, and the picture that shows them.
#include "engine/picture/roi_picture.h"

#include "engine/error.h"
#include "shaders/shared/constants.h"

#include <algorithm>

namespace binosplat {

namespace {

PixelOrigin originOfTile(std::uint32_t kind) {
    switch (kind) {
        case gpu::kTileEdge:
            return PixelOrigin::kEdgeRoi;
        case gpu::kTileCenter:
            return PixelOrigin::kCenterRoi;
        case gpu::kTilePredicted:
            return PixelOrigin::kPredictedRoi;
        case gpu::kTileCheap:
            return PixelOrigin::kCheap;
        case gpu::kTileHidden:  // nobody sees it
            return PixelOrigin::kReprojected;
        default:
            fail("tile kind is {}, must be 0 to {}", kind, gpu::kTileCheap);
    }
}

PixelOrigin originOfClass(std::uint8_t pixel_class) {
    switch (pixel_class) {
        case gpu::kCovered:
            return PixelOrigin::kReprojected;
        case gpu::kGap:
            return PixelOrigin::kGap;
        case gpu::kHole:
            return PixelOrigin::kHole;
        default:
            fail("pixel class is {}, must be 0 to {}", pixel_class, gpu::kHole);
    }
}

}  // namespace

std::vector<std::uint8_t> pixelOrigins(glm::uvec2 size_px, std::span<const std::uint32_t> tile_kinds,
                                       std::span<const std::uint8_t> pixel_classes) {
    const glm::uvec2 tiles = (size_px + gpu::kTileSize - 1u) / gpu::kTileSize;
    const std::size_t tile_count = std::size_t{tiles.x} * tiles.y,
                      pixel_count = std::size_t{size_px.x} * size_px.y;
    check(tile_kinds.empty() || tile_kinds.size() == tile_count,
          "{} tile kinds for a picture of {}x{} pixels, must be {}", tile_kinds.size(), size_px.x, size_px.y,
          tile_count);
    check(pixel_classes.empty() || pixel_classes.size() == pixel_count,
          "{} pixel classes for a picture of {}x{} pixels, must be {}", pixel_classes.size(), size_px.x,
          size_px.y, pixel_count);
    std::vector<std::uint8_t> origins(pixel_count, static_cast<std::uint8_t>(PixelOrigin::kReprojected));
    std::size_t pixel = 0;
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        for (std::uint32_t x = 0; x < size_px.x; ++x, ++pixel) {
            const std::size_t tile = std::size_t{y / gpu::kTileSize} * tiles.x + x / gpu::kTileSize;
            if (!tile_kinds.empty() && tile_kinds[tile] != 0) {
                origins[pixel] = static_cast<std::uint8_t>(originOfTile(tile_kinds[tile]));
            } else if (!pixel_classes.empty()) {
                origins[pixel] = static_cast<std::uint8_t>(originOfClass(pixel_classes[pixel]));
            }
        }
    }
    return origins;
}

glm::vec3 tintOf(PixelOrigin origin) {
    switch (origin) {
        case PixelOrigin::kGap:
            return {1.0f, 0.85f, 0.0f};
        case PixelOrigin::kHole:
            return {1.0f, 0.0f, 0.0f};
        case PixelOrigin::kEdgeRoi:
            return {0.0f, 0.35f, 1.0f};
        case PixelOrigin::kCenterRoi:
            return {0.0f, 0.8f, 0.2f};
        case PixelOrigin::kPredictedRoi:
            return {0.9f, 0.0f, 0.9f};
        case PixelOrigin::kCheap:
            return {0.0f, 0.8f, 0.9f};
        case PixelOrigin::kReprojected:
            break;
    }
    return glm::vec3(0.0f);
}

Image makeRoiPicture(const Image& affiliated, std::span<const std::uint32_t> tile_kinds,
                     std::span<const std::uint8_t> pixel_classes) {
    check(affiliated.channels >= 3, "the affiliated picture has {} channels, must have 3 or more",
          affiliated.channels);
    const std::vector<std::uint8_t> origins = pixelOrigins(affiliated.size_px, tile_kinds, pixel_classes);
    Image tinted{affiliated.size_px, 3, std::vector<float>(affiliated.pixelCount() * 3)};
    for (std::size_t pixel = 0; pixel < origins.size(); ++pixel) {
        const float* from = affiliated.values.data() + pixel * static_cast<std::size_t>(affiliated.channels);
        const auto origin = static_cast<PixelOrigin>(origins[pixel]);
        const float share = origin == PixelOrigin::kReprojected ? 0.0f : kTintShare;
        const glm::vec3 tint = tintOf(origin);
        for (int channel = 0; channel < 3; ++channel) {
            // A pixel brighter than the display must not drown its tint.
            const float shown = std::clamp(from[channel], 0.0f, 1.0f);
            tinted.values[pixel * 3 + static_cast<std::size_t>(channel)] =
                (1.0f - share) * shown + share * tint[channel];
        }
    }
    return tinted;
}

}  // namespace binosplat
