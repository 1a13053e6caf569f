// LDR-FLIP: the difference an observer sees who flips between two pictures. Andersson, Nilsson,
// Akenine-Moeller, Oskarsson, Astroem, Fairchild, "FLIP: A Difference Evaluator for Alternating Images",
// Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020, sections 4 and 5.
#pragma once

#include "app/scores/planes.h"

namespace binosplat {

// The paper's assumption: a screen of 3840 pixels, as far away as it is wide, so that a pixel in its middle
// is 1/3840 rad.
inline constexpr double kFlipPixelsPerDegree = 3840.0 * 3.14159265358979323846 / 180.0;  // 67.02

// Pixels wider than a degree, or a thousand to a degree: nothing that the paper's filters are made for.
inline constexpr double kFlipLeastPixelsPerDegree = 1.0, kFlipMostPixelsPerDegree = 1000.0;

// In the middle of a picture whose focal length is `focal_px`, as a headset shows it.
double pixelsPerDegree(double focal_px);

// Scores from 0 (alike) to 1, of R, G and B as they are encoded (sRGB), clamped to 0 to 1; further channels
// are ignored. Symmetric in both pictures. Filters see the nearest pixel of the picture beyond its border. A
// pixel with a value that is not finite in either picture scores 1, and its neighbours see that value as 0.
// Throws Error if sizes differ, a picture has fewer than three channels, or pixels_per_degree is beyond these
// limits.
PixelScores flip(const Image& a, const Image& b, double pixels_per_degree = kFlipPixelsPerDegree,
                 int threads = 2);

// The colour part of the score alone, for two colours that fill the picture: linear sRGB from 0 to 1.
float flipColourDifference(const glm::vec3& linear_a, const glm::vec3& linear_b);

}  // namespace binosplat
