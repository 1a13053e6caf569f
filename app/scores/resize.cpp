// Scales pictures up.
#include "app/scores/resize.h"

#include "engine/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace binosplat {
namespace {

// A sample of the new row or column: four of the old, and their weights.
struct Sample {
    std::array<std::size_t, 4> at;
    std::array<float, 4> weights;
};

float cubicWeight(float x) {
    x = std::abs(x);
    return x < 1.0f   ? (1.5f * x - 2.5f) * x * x + 1.0f
           : x < 2.0f ? ((-0.5f * x + 2.5f) * x - 4.0f) * x + 2.0f
                      : 0.0f;
}

std::vector<Sample> samplesOf(std::uint32_t from, std::uint32_t to) {
    std::vector<Sample> samples(to);
    for (std::uint32_t i = 0; i < to; ++i) {
        const double place = (i + 0.5) * from / to - 0.5;
        const double first = std::floor(place) - 1.0;
        float sum = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            const double at = first + static_cast<double>(k);
            const bool inside = at >= 0.0 && at < from;
            samples[i].at[k] = inside ? static_cast<std::size_t>(at) : 0;
            samples[i].weights[k] = inside ? cubicWeight(static_cast<float>(at - place)) : 0.0f;
            sum += samples[i].weights[k];
        }
        for (float& weight : samples[i].weights) { weight /= sum; }
    }
    return samples;
}

}  // namespace

Image scaleUp(const Image& picture, glm::uvec2 size_px) {
    const glm::uvec2 own = picture.size_px;
    check(size_px.x >= own.x && size_px.y >= own.y, "a picture of {}x{} cannot be scaled up to {}x{}", own.x,
          own.y, size_px.x, size_px.y);
    const auto channels = static_cast<std::size_t>(picture.channels);
    const std::vector<Sample> across = samplesOf(own.x, size_px.x), down = samplesOf(own.y, size_px.y);
    Image wide{{size_px.x, own.y}, picture.channels, {}}, scaled{size_px, picture.channels, {}};
    wide.values.resize(wide.pixelCount() * channels);
    scaled.values.resize(scaled.pixelCount() * channels);
    const auto fill = [&](Image& out, const Image& in, auto&& sampleAt, auto&& indexIn) {
        float* value = out.values.data();
        for (std::uint32_t y = 0; y < out.size_px.y; ++y) {
            for (std::uint32_t x = 0; x < out.size_px.x; ++x) {
                const Sample& sample = sampleAt(x, y);
                for (std::size_t c = 0; c < channels; ++c) {
                    float sum = 0.0f;
                    for (std::size_t k = 0; k < 4; ++k) {
                        sum += sample.weights[k] * in.values[channels * indexIn(x, y, sample.at[k]) + c];
                    }
                    *value++ = sum;
                }
            }
        }
    };
    fill(
        wide, picture, [&](std::uint32_t x, std::uint32_t) -> const Sample& { return across[x]; },
        [&](std::uint32_t, std::uint32_t y, std::size_t at) { return std::size_t{y} * own.x + at; });
    fill(
        scaled, wide, [&](std::uint32_t, std::uint32_t y) -> const Sample& { return down[y]; },
        [&](std::uint32_t x, std::uint32_t, std::size_t at) { return at * size_px.x + x; });
    for (float& value : scaled.values) { value = std::max(value, 0.0f); }
    return scaled;
}

}  // namespace binosplat
