// Scores of pictures.
#include "app/stability_cases/score_picture.h"

#include <algorithm>
#include <cmath>

namespace binosplat::stability {
namespace {

double peakOf(const std::vector<glm::dvec4>& twin) {
    double peak = 1.0;
    for (const glm::dvec4& value : twin) { peak = std::max({peak, value.r, value.g, value.b}); }
    return peak;
}

}  // namespace

std::uint64_t countNotFinite(const Image& image) {
    return static_cast<std::uint64_t>(
        std::ranges::count_if(image.values, [](float value) { return !std::isfinite(value); }));
}

void compareWithTwin(PictureScore& score, const Image& image, const std::vector<glm::dvec4>& twin,
                     const std::vector<bool>& counts) {
    const double peak = peakOf(twin);
    const std::size_t width = image.size_px.x, columns = tilesOf(image.size_px).x;
    double squares = 0.0;
    std::uint64_t off = 0, values = 0;
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        if (!counts.empty() && !counts[i / width / gpu::kTileSize * columns + i % width / gpu::kTileSize]) {
            continue;
        }
        for (int channel = 0; channel < 4; ++channel) {
            double error =
                std::abs(static_cast<double>(image.values[4 * i + static_cast<std::size_t>(channel)]) -
                         twin[i][channel]) /
                peak;
            if (std::isnan(error)) { error = HUGE_VAL; }
            squares += error * error;
            off += error > 2.0 / 255.0 ? 1 : 0;
            score.largest = std::max(score.largest, error);
            ++values;
        }
    }
    if (values == 0) { squares = 0.0, values = 1; }
    score.psnr_db = squares > 0.0 ? -10.0 * std::log10(squares / static_cast<double>(values)) : HUGE_VAL;
    score.share_off = static_cast<double>(off) / static_cast<double>(values);
}

}  // namespace binosplat::stability
