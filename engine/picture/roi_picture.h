// The origin of each pixel of the affiliated picture, as one class per pixel and as a tinted picture
// (roi.png).
#pragma once

#include "engine/picture/image.h"

#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

// Where a pixel of the finished affiliated picture came from.
enum class PixelOrigin : std::uint8_t {
    kReprojected,   // reprojected from the dominant picture
    kGap,           // interpolated: a small gap between reprojected pixels
    kHole,          // interpolated: a wide hole for which no tile was rendered
    kEdgeRoi,       // rendered: at the picture's border
    kCenterRoi,     // rendered: a hole's box
    kPredictedRoi,  // rendered: large expected error
    kCheap,         // rendered: cheaper than reprojecting
};

// One PixelOrigin per pixel, row-major. `tile_kinds` has kTileEdge, kTileCenter, kTilePredicted, kTileCheap,
// or 0 for a tile that stays reprojected; tiles have kTileSize pixels and are row-major, ceil(width /
// kTileSize) to a row. `pixel_classes` has kCovered, kGap or kHole for each pixel, and counts if the tile's
// kind is 0. An empty list means 0 everywhere. Throws Error if a list does not have the length that the
// picture needs, or has an unknown value.
std::vector<std::uint8_t> pixelOrigins(glm::uvec2 size_px, std::span<const std::uint32_t> tile_kinds,
                                       std::span<const std::uint8_t> pixel_classes);

// The tint of an origin, RGB 0 to 1: gaps yellow, holes red, edge ROIs blue, centre ROIs green, predicted
// tiles magenta, cheap ones cyan. Reprojected pixels have none (black, unused).
glm::vec3 tintOf(PixelOrigin origin);

// The share of the tint in a tinted pixel; the rest is the picture, so that the tile's content stays visible.
inline constexpr float kTintShare = 0.4f;

// The picture (3 channels or more, display-encoded) with every pixel that was not reprojected tinted by its
// origin: 3 channels. Throws Error as pixelOrigins does.
Image makeRoiPicture(const Image& affiliated, std::span<const std::uint32_t> tile_kinds,
                     std::span<const std::uint8_t> pixel_classes);

}  // namespace binosplat
