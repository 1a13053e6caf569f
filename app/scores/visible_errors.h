// What a wearer notices in both eyes' pictures that were not rendered in full, and what PSNR over all pixels
// hides: tiles that are plainly wrong, edges that step or blur, a visible grid of tiles, and sharpness that
// differs between the eyes. Pictures are compared as a display shows them: clamped to 0 to 1, and rounded to
// 8 bits.
#pragma once

#include "engine/picture/image.h"

#include <array>
#include <cstdint>
#include <vector>

namespace binosplat {

// A tile is bad if its PSNR is under 30 dB, which is obvious at a glance.
inline constexpr double kBadTileSquare = 1e-3;

struct VisibleErrors {
    // For each whole tile of kTileSize, left eye first: the mean squared error over R, G and B.
    std::vector<float> tile_squares;
    // Over the pixels where the full render's luma has a strong edge, the share whose gradient is wrong by
    // more than half. Mean of both eyes.
    double edge = 0.0;
    // How much more the error of the luma changes from pixel to pixel across the borders of tiles than within
    // tiles, for values from 0 to 1. 0: no grid is visible; less if errors end within tiles.
    double seam = 0.0;
    // Over the tiles with texture in both eyes: how far the eyes differ in sharpness, each relative to its
    // full render. The standard deviation in octaves of the gradient's amplitude: the same blur in both eyes
    // is none.
    double rival = 0.0;

    [[nodiscard]] double badShare() const;
};

// R, G and B as a display shows them.
Image asShown(const Image& picture);

// By Side. Throws Error unless a picture has the size of its full render.
VisibleErrors findVisibleErrors(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full);

// How one eye sees pictures other than those that were rendered; see LensView.
struct Sight {
    // For each pixel: which tile of the rendered picture this is; kNoTile: nothing is shown.
    std::vector<std::uint32_t> rendered_tiles;
    // For each tile of this picture, row by row: how much of a squared error the eye sees.
    std::vector<double> shares;

    static constexpr std::uint32_t kNoTile = 0xffffffffu;
};
// The same for the part of the errors that each eye sees, by `price`'s model of an eye. Squares are weighted
// by the tile's share, and do not count at all if this is less than 1 and less than kLeastSeenError remains
// of the tile's error. Gradients, steps and octaves are weighted by its root, octaves by the smaller root of
// both eyes. Tiles with pixels that show nothing are skipped, and so are such pixels. `seam` is across the
// borders of the rendered tiles, compared within each tile of this picture. Pictures are as shown (asShown),
// and not rounded again.
VisibleErrors findSeenErrors(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full,
                             const std::array<Sight, 2>& sights);

// The mean square of this share of the tiles, the worst ones, but at least one; 0 if there are none.
double worstTiles(std::vector<float> tile_squares, double share);

}  // namespace binosplat
