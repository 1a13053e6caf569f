// Differences between tiles made at different times that two eyes notice and PSNR does not.
#pragma once

#include "engine/picture/image.h"

#include <array>

namespace binosplat {

// How much more an error image (a picture less the full render, R, G, B) changes from pixel to pixel across the borders of tiles
// of kTileSize than within them: mean |difference| of neighbours, in values of 0 to 1. 0: nothing shows where tiles end.
double tileSteps(const Image& error);

// By how much a surface is sharper in one eye than in the other: over the full renders' textured tiles that are found in the other eye
// in the same rows, the mean difference of the eyes' sharpness, which is the sum of a tile's gradients over those of its full render.
// 0 to about 1; also 0 if no tile is found, as between canted eyes.
double sharpnessGap(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full);

}  // namespace binosplat
