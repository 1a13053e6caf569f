// SSIM: how alike two pictures are in local mean, contrast and structure. Wang, Bovik, Sheikh, Simoncelli,
// "Image Quality Assessment:
// From Error Visibility to Structural Similarity", IEEE Transactions on Image Processing 13(4), 2004, section
// III.
#pragma once

#include "app/scores/planes.h"

namespace binosplat {

// The window is 11x11, Gaussian with sigma 1.5 px; constants (K1 L)^2 and (K2 L)^2 with K1 = 0.01, K2 = 0.03,
// L = 1. The paper leaves out windows that reach beyond the border. Here every pixel has a score, and the
// border is one of two:
//   kCutWindow  only the part of the window inside counts, with its weights scaled to sum 1: no pixel knows
//               of the border;
//   kZero       zeros beyond the border in both pictures, as the evaluations of 3DGS and 2DGS do: for
//               comparison with their figures.
//
// Scores from -1 to 1 (alike), each the mean over R, G and B as they are encoded, clamped to 0 to 1. Further
// channels are ignored. A pixel with a value that is not finite in either picture scores -1, and its
// neighbours see that value as 0. Throws Error if sizes differ or a picture has fewer than three channels.
PixelScores ssim(const Image& a, const Image& b, Border border = Border::kCutWindow, int threads = 2);

}  // namespace binosplat
