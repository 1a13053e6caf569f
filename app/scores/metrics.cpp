// Pixel by pixel differences of two pictures, summed in double.
#include "app/scores/metrics.h"

#include "engine/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binosplat {

double Difference::psnrDb() const {
    return mean_square == 0.0 ? std::numeric_limits<double>::infinity() : -10.0 * std::log10(mean_square);
}

Difference compare(const Image& a, const Image& b, int channels, double threshold) {
    check(a.size_px == b.size_px, "cannot compare a picture of {}x{} pixels with one of {}x{}", a.size_px.x,
          a.size_px.y, b.size_px.x, b.size_px.y);
    check(channels <= std::min(a.channels, b.channels),
          "cannot compare {} channels of pictures with {} and {}", channels, a.channels, b.channels);
    Difference result;
    double sum = 0.0;
    for (std::size_t pixel = 0; pixel < a.pixelCount(); ++pixel) {
        const float* in_a = a.values.data() + pixel * static_cast<std::size_t>(a.channels);
        const float* in_b = b.values.data() + pixel * static_cast<std::size_t>(b.channels);
        for (int channel = 0; channel < channels; ++channel) {
            const bool finite = std::isfinite(in_a[channel]) && std::isfinite(in_b[channel]);
            const double error =
                finite ? std::abs(static_cast<double>(in_a[channel]) - static_cast<double>(in_b[channel]))
                       : std::numeric_limits<double>::infinity();
            ++result.values;
            result.not_finite += finite ? 0 : 1;
            result.off += error > threshold ? 1 : 0;
            result.largest = std::max(result.largest, error);
            sum += error * error;
        }
    }
    result.mean_square = result.values > 0 ? sum / static_cast<double>(result.values) : 0.0;
    return result;
}

}  // namespace binosplat
