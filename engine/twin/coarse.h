// The float64 twin of coarse tiles: where an eye does not see sharply, 8x8 samples in 16x16 pixels. Tiles are listed by rows; `hidden` has
// a byte a tile, 1 where nobody sees it; empty: all are seen.
#pragma once

#include "engine/twin/reference.h"
#include "engine/twin/stereo.h"

namespace binosplat::reference {

// Of the square of an error that is spread over everything that pixels of this solid angle may show, the share that the eye sees: as
// findSeenShares, at this angle from where it looks, and `clear_rad` around that everything. By tiles, at their middles. Where it is at
// most a quarter, the finest cycle that the eye resolves has four pixels: then the tile lies beyond.
double seenShare(double pixel_sr, double angle_rad, double clear_rad);
std::vector<double> findSharesThere(const Eye& eye, const Gaze& gaze);
std::vector<std::uint8_t> findBeyond(const Eye& eye, const Gaze& gaze);

// A tile's samples: 8 rows of 8, the outermost in the middles of its outermost pixels.
inline constexpr int kTileSamples = 8;
// A pixel of a tile by Catmull and Rom's cubic (1974), one axis after the other; before and behind the outermost sample the parabola
// through it and the next two goes on.
glm::dvec4 fillAt(std::span<const glm::dvec4> samples, glm::ivec2 pixel);
// The loss of a tile as a squared error summed over its pixels and their channels: 0.3 of its samples' second differences along both axes,
// squared and summed (at most 4 a sample), of which the border's count as those within.
double expectLoss(std::span<const glm::dvec4> samples);

// A picture some of whose tiles are coarse: of those that lie beyond, are seen, and have all of their pixels and a splat, the ones of which
// the eye is expected to see less of the loss than a hundredth in each pixel. Colours not below 0, and alpha not above 1; depths, per
// weight, are those of the nearest sample.
struct CoarsePicture {
    Picture picture;
    std::vector<std::uint8_t> coarse, tried;
    std::vector<double> losses;  // of tiles that were tried
};
CoarsePicture rasterizeCoarse(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs, std::span<const TileRange> ranges,
                              const Eye& eye, const Gaze& gaze, const Settings& settings);
CoarsePicture renderCoarse(const Scene& scene, const Eye& eye, const Gaze& gaze, const Settings& settings,
                           std::span<const std::uint8_t> hidden = {});

}  // namespace binosplat::reference
