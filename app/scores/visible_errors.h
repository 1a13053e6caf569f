// What a wearer notices of two eyes' pictures that were not rendered in full, and what PSNR over all pixels
// hides: tiles that are plainly wrong, edges that step or blur, a grid of tiles, and sharpness that differs
// between the eyes. Pictures are compared as a display shows them: clamped to 0 to 1, and rounded to 8 bits.
#pragma once

#include "engine/picture/image.h"

#include <array>
#include <cstdint>
#include <vector>

namespace binosplat {

// A tile is bad if its PSNR is under 30 dB, which shows at a glance.
inline constexpr double kBadTileSquare = 1e-3;

struct VisibleErrors {
    // Of each whole tile of kTileSize, left eye first: the mean squared error of R, G and B.
    std::vector<float> tile_squares;
    // Over the pixels where the full render's luma has a strong edge, the share whose gradient is off by more
    // than half of it. Mean of the eyes.
    double edge = 0.0;
    // How much more the error of the luma changes from pixel to pixel across the borders of tiles than within
    // tiles, in values of 0 to 1. 0: no grid shows; less if errors end within tiles.
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

// How one eye sees pictures that are not the rendered ones: LensView.
struct Sight {
    // For each pixel: which tile of the rendered picture this is; kNoTile: nothing is shown.
    std::vector<std::uint32_t> rendered_tiles;
    // For each tile of this picture, by rows: how much of the square of an error the eye sees.
    std::vector<double> shares;

    static constexpr std::uint32_t kNoTile = 0xffffffffu;
};
// The same of what each eye sees of the errors, by the model that `price` has of an eye: squares count by the
// tile's share, and not at all if this is less than 1 and less than kLeastSeenError is left of the tile's;
// gradients, steps and octaves count by its root, that of an octave by the smaller one of both eyes. Tiles
// with pixels that show nothing are left out, and so are such pixels. `seam` is across the borders of the
// rendered tiles, compared within each tile of this picture. Pictures are as shown (asShown), and not rounded
// again.
VisibleErrors findSeenErrors(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full,
                             const std::array<Sight, 2>& sights);

// The mean square of this share of tiles, the worst ones, at least one; 0 if there are none.
double worstTiles(std::vector<float> tile_squares, double share);

}  // namespace binosplat
