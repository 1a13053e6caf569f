// SSIM channel by channel, from five filtered planes each.
#include "app/scores/ssim.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace binosplat {

namespace {

constexpr float kStabilizeMean = 0.01f * 0.01f;      // C1
constexpr float kStabilizeVariance = 0.03f * 0.03f;  // C2
constexpr double kSigma_px = 1.5;
constexpr int kRadius_px = 5;

Plane channelOf(const Image& image, int channel) {
    Plane plane{image.size_px, std::vector<float>(image.pixelCount())};
    for (std::size_t pixel = 0; pixel < plane.values.size(); ++pixel) {
        const float value =
            image
                .values[pixel * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(channel)];
        plane.values[pixel] = std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f;
    }
    return plane;
}

Plane product(const Plane& a, const Plane& b) {
    Plane result{a.size_px, std::vector<float>(a.values.size())};
    std::transform(a.values.begin(), a.values.end(), b.values.begin(), result.values.begin(),
                   [](float x, float y) { return x * y; });
    return result;
}

bool isFinite(const Image& image, std::size_t pixel) {
    const float* values = image.values.data() + pixel * static_cast<std::size_t>(image.channels);
    return std::isfinite(values[0]) && std::isfinite(values[1]) && std::isfinite(values[2]);
}

}  // namespace

PixelScores ssim(const Image& a, const Image& b, Border border, int threads) {
    assert(border != Border::kClamp);
    requireComparable(a, b);
    PixelScores scores{a.size_px, std::vector<float>(a.pixelCount(), 0.0f)};
    const Weights kernel = gaussianKernel(kSigma_px, kRadius_px);
    const auto blur = [&](const Plane& plane) { return filterPlane(plane, kernel, kernel, border, threads); };
    for (int channel = 0; channel < 3; ++channel) {
        const Plane of_a = channelOf(a, channel), of_b = channelOf(b, channel);
        const Plane mean_a = blur(of_a), mean_b = blur(of_b);
        const Plane mean_aa = blur(product(of_a, of_a)), mean_bb = blur(product(of_b, of_b)),
                    mean_ab = blur(product(of_a, of_b));
        for (std::size_t i = 0; i < scores.values.size(); ++i) {
            const float mu_a = mean_a.values[i], mu_b = mean_b.values[i];
            const float variance_a = mean_aa.values[i] - mu_a * mu_a,
                        variance_b = mean_bb.values[i] - mu_b * mu_b;
            const float covariance = mean_ab.values[i] - mu_a * mu_b;
            const float above =
                (2.0f * mu_a * mu_b + kStabilizeMean) * (2.0f * covariance + kStabilizeVariance);
            const float below =
                (mu_a * mu_a + mu_b * mu_b + kStabilizeMean) * (variance_a + variance_b + kStabilizeVariance);
            scores.values[i] += above / below / 3.0f;
        }
    }
    for (std::size_t pixel = 0; pixel < scores.values.size(); ++pixel) {
        if (!isFinite(a, pixel) || !isFinite(b, pixel)) { scores.values[pixel] = -1.0f; }
    }
    return scores;
}

}  // namespace binosplat
