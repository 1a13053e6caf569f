// The float64 twins of periphery and fill_periphery: an eye's picture away from its gaze, from one of half the size. Tiles and pixels
// are listed by rows; `hidden` has a byte a tile, 1 where nobody sees it; empty: all are seen.
#pragma once

#include "engine/reference/past.h"
#include "engine/reference/reference.h"
#include "engine/reference/stereo.h"

namespace binosplat::reference {

// The same view with pixels of twice the width and height, as many as cover the picture; splats have the low-pass of the smaller ones.
Eye halfOf(const Eye& eye);

// periphery: of the square of an error that is spread over everything that pixels of this solid angle may show, the share that the eye
// sees: as findSeenShares, at this angle from where it looks, and `clear_rad` around that everything. By tiles, at their middles. Where it
// is at most a quarter, the finest cycle that the eye resolves has four pixels, or two samples of half the size: then the tile lies beyond.
double seenShare(double pixel_sr, double angle_rad, double clear_rad);
std::vector<double> findSharesThere(const Eye& eye, const Gaze& gaze);
std::vector<std::uint8_t> findBeyond(const Eye& eye, const Gaze& gaze);
// Also periphery, first run: the tiles of the half-size picture that hold a sample from which a tile beyond is made, if that is seen.
std::vector<std::uint8_t> findHalfTiles(const Eye& eye, const Gaze& gaze, std::span<const std::uint8_t> hidden = {});
// Also periphery, second run: each tile's loss, as a squared error summed over its pixels and their channels: 0.3 of its samples' second
// differences along both axes, squared and summed (at most 4 a sample). The loss that the eye is expected to see: that times its share.
std::vector<double> expectLosses(std::span<const glm::dvec4> half, const Eye& eye);
std::vector<double> expectSeenLosses(std::span<const glm::dvec4> half, const Eye& eye, const Gaze& gaze);
// And hence the tiles that are rendered at their own size: those not beyond, and those in which a hundredth would be seen in each pixel.
std::vector<std::uint8_t> findOwnTiles(std::span<const glm::dvec4> half, const Eye& eye, const Gaze& gaze,
                                       std::span<const std::uint8_t> hidden = {});

// fill_periphery: all tiles but `own_tiles`, colours by Catmull and Rom's cubic (1974), not below 0, and alpha not above 1; D as alpha
// times the depth D/A of the half-size picture between four samples, both linearly. Hidden tiles become background.
void fillPeriphery(Picture& picture, const Picture& half, std::span<const std::uint8_t> own_tiles,
                   std::span<const std::uint8_t> hidden = {}, const glm::dvec3& background = glm::dvec3(0.0));

// Also fill_periphery, for a picture that later ones are made from: a pixel has its sample's depth. Rendering a tile costs 0.6 of what
// the half-size tile it lies in costs; its error is that tile's error there plus its own loss. `losses`: from expectLosses.
void fillPast(Past& picture, const Past& half, std::span<const double> losses, std::span<const std::uint8_t> own_tiles,
              std::span<const std::uint8_t> hidden = {});

// Both pictures, and the tiles chosen of each.
struct PeripheryPictures {
    Picture picture, half;
    std::vector<std::uint8_t> own_tiles;
};
PeripheryPictures renderPeriphery(const Scene& scene, const Eye& eye, const Gaze& gaze, const Settings& settings,
                                  std::span<const std::uint8_t> hidden = {});

}  // namespace binosplat::reference
