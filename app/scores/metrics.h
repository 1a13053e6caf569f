// How much two pictures differ: several figures from one pass over both. (Figures per tile, SSIM and FLIP
// have files of their own.)
#pragma once

#include "engine/picture/image.h"

#include <cstdint>

namespace binosplat {

// Two steps of an 8-bit display: the rounding that a comparison tolerates before a value counts as wrong.
inline constexpr double kTwoDisplaySteps = 2.0 / 255.0;

// Over all values, that is, pixels times the channels compared. A pair in which either value is not finite
// counts as wrong, with an infinite difference, even if both are the same: neither picture may contain such a
// value.
struct Difference {
    std::uint64_t values = 0;
    std::uint64_t not_finite = 0;  // pairs with a NaN or an infinity
    std::uint64_t off = 0;         // pairs that differ by more than the threshold
    double largest = 0.0;          // largest |a - b|
    double mean_square = 0.0;      // mean (a - b)^2

    // Against a peak of 1: infinity for equal pictures, -infinity if any value is not finite.
    [[nodiscard]] double psnrDb() const;
    // Share of the values that are wrong, 0 to 1.
    [[nodiscard]] double shareOff() const {
        return values > 0 ? static_cast<double>(off) / static_cast<double>(values) : 0.0;
    }
};

// Compares the first `channels` channels of each pixel as they are: nothing is clamped or rounded.
// Throws Error if sizes differ or a picture has fewer channels.
Difference compare(const Image& a, const Image& b, int channels = 3, double threshold = kTwoDisplaySteps);

}  // namespace binosplat
