// The float64 twin of coarse tiles: 8x8 samples in 16x16 pixels, where an eye does not see sharply. Tiles are
// listed by rows. `hidden` has a byte a tile, 1 for a hidden one; empty: none is.
#pragma once

#include "engine/twin/reference.h"
#include "engine/twin/stereo.h"

namespace binosplat::reference {

// The share that the eye sees of a squared error spread over everything that pixels of this solid angle may
// show: as findSeenShares, at this angle from the gaze, with `clear_rad` around everything. By tiles, at
// their middles. At a quarter or less, the finest cycle that the eye resolves covers four pixels, and the
// tile lies beyond.
double seenShare(double pixel_sr, double angle_rad, double clear_rad);
std::vector<double> findSharesThere(const Eye& eye, const Gaze& gaze);
std::vector<std::uint8_t> findBeyond(const Eye& eye, const Gaze& gaze);

// A tile's samples: 8 rows of 8, the outermost in the middles of its outermost pixels.
inline constexpr int kTileSamples = 8;
// A pixel of a tile by Catmull and Rom's cubic (1974), one axis after the other; outside the outermost
// sample, the parabola through it and the next two continues.
glm::dvec4 fillAt(std::span<const glm::dvec4> samples, glm::ivec2 pixel);
// A tile's loss as a squared error summed over its pixels and their channels: 0.3 of its samples' second
// differences along both axes, squared and summed (at most 4 a sample). Those at the border count like those
// within.
double expectLoss(std::span<const glm::dvec4> samples);

// A picture some of whose tiles are coarse. Candidates lie beyond, are not hidden, are whole and have a
// splat; those become coarse of whose loss the eye is expected to see less than a hundredth in each pixel.
// Colours are not below 0, and alpha not above 1; depths, per weight, are those of the nearest sample.
struct CoarsePicture {
    Picture picture;
    std::vector<std::uint8_t> coarse, tried;
    std::vector<double> losses;  // of the candidates
};
CoarsePicture rasterizeCoarse(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                              std::span<const TileRange> ranges, const Eye& eye, const Gaze& gaze,
                              const Settings& settings);
CoarsePicture renderCoarse(const Scene& scene, const Eye& eye, const Gaze& gaze, const Settings& settings,
                           std::span<const std::uint8_t> hidden = {});

}  // namespace binosplat::reference
