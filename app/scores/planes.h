// One channel of a picture, separable filters over it, and scores per pixel: the common part of SSIM and
// FLIP.
#pragma once

#include "engine/picture/image.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace binosplat {

// One float per pixel, rows top to bottom.
struct Plane {
    glm::uvec2 size_px{0, 0};
    std::vector<float> values;
};

// The values that a filter sees beyond the border.
enum class Border {
    kClamp,  // the nearest pixel of the picture
    kZero,   // zeros
    // nothing: the weights inside are scaled to the kernel's sum (only for kernels with positive weights)
    kCutWindow,
};

// Odd-sized weights, centre in the middle; the filter is a correlation: out(x) = sum over i of kernel[i] *
// in(x + i - radius).
using Weights = std::vector<float>;

// Weights exp(-x^2 / (2 sigma^2)) at integer x from -radius to radius, scaled to a sum of 1.
Weights gaussianKernel(double sigma, int radius);

// `across` along rows, then `down` along columns. Same size as `in`; the result does not depend on the number
// of threads.
Plane filterPlane(const Plane& in, const Weights& across, const Weights& down, Border border, int threads);

// One score per pixel, rows top to bottom.
struct PixelScores {
    glm::uvec2 size_px{0, 0};
    std::vector<float> values;

    // Over all pixels; nothing if there are none.
    [[nodiscard]] std::optional<double> mean() const;
    // Over the pixels whose class (one per pixel, as from pixelOrigins) is `chosen`; nothing if there are
    // none. Throws Error if there are not as many classes as pixels.
    [[nodiscard]] std::optional<double> meanWhere(std::span<const std::uint8_t> classes,
                                                  std::uint8_t chosen) const;
};

// Throws Error unless both pictures have the same size and three channels or more.
void requireComparable(const Image& a, const Image& b);

}  // namespace binosplat
