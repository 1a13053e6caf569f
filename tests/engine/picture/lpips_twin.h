// LPIPS in float64, straight from its description: planes of channels, a loop for every index, zeros looked up beyond the border.
#pragma once

#include "engine/picture/image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace binosplat::test {

// A row-major plane for each channel.
struct FeaturePlanes {
    int width = 0, height = 0, channels = 0;
    std::vector<double> values;

    FeaturePlanes(int width_, int height_, int channels_)
        : width(width_),
          height(height_),
          channels(channels_),
          values(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * static_cast<std::size_t>(channels_), 0.0) {}
    [[nodiscard]] std::size_t indexOf(int channel, int x, int y) const {
        return (static_cast<std::size_t>(channel) * static_cast<std::size_t>(height) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
    double& at(int channel, int x, int y) { return values[indexOf(channel, x, y)]; }
    [[nodiscard]] double at(int channel, int x, int y) const {
        return x < 0 || y < 0 || x >= width || y >= height ? 0.0 : values[indexOf(channel, x, y)];
    }
};

// Reads its weights off the front of `values`.
inline FeaturePlanes convolveTwin(const FeaturePlanes& in, std::span<const float>& values, int outputs, int side, int stride, int padding) {
    const auto weights = static_cast<std::size_t>(outputs * in.channels * side * side);
    FeaturePlanes out((in.width + 2 * padding - side) / stride + 1, (in.height + 2 * padding - side) / stride + 1, outputs);
    for (int output = 0; output < outputs; ++output) {
        for (int y = 0; y < out.height; ++y) {
            for (int x = 0; x < out.width; ++x) {
                double sum = static_cast<double>(values[weights + static_cast<std::size_t>(output)]);
                for (int input = 0; input < in.channels; ++input) {
                    for (int row = 0; row < side; ++row) {
                        for (int column = 0; column < side; ++column) {
                            const int at = ((output * in.channels + input) * side + row) * side + column;
                            sum += static_cast<double>(values[static_cast<std::size_t>(at)]) *
                                   in.at(input, x * stride + column - padding, y * stride + row - padding);
                        }
                    }
                }
                out.at(output, x, y) = std::max(sum, 0.0);
            }
        }
    }
    values = values.subspan(weights + static_cast<std::size_t>(outputs));
    return out;
}

// Windows begin at 0, 2, 4, ... until one reaches the last pixel; what lies beyond that does not count.
inline FeaturePlanes poolTwin(const FeaturePlanes& in) {
    const auto sideOf = [](int side) { return static_cast<int>(std::ceil((side - 3) / 2.0)) + 1; };
    FeaturePlanes out(sideOf(in.width), sideOf(in.height), in.channels);
    for (int channel = 0; channel < in.channels; ++channel) {
        for (int y = 0; y < out.height; ++y) {
            for (int x = 0; x < out.width; ++x) {
                double most = in.at(channel, 2 * x, 2 * y);
                for (int row = 2 * y; row < std::min(2 * y + 3, in.height); ++row) {
                    for (int column = 2 * x; column < std::min(2 * x + 3, in.width); ++column) {
                        most = std::max(most, in.at(channel, column, row));
                    }
                }
                out.at(channel, x, y) = most;
            }
        }
    }
    return out;
}

inline FeaturePlanes fireTwin(const FeaturePlanes& in, std::span<const float>& values, int squeezed, int expanded) {
    const FeaturePlanes few = convolveTwin(in, values, squeezed, 1, 1, 0);
    const FeaturePlanes small = convolveTwin(few, values, expanded, 1, 1, 0), large = convolveTwin(few, values, expanded, 3, 1, 1);
    FeaturePlanes both(in.width, in.height, 2 * expanded);
    std::ranges::copy(large.values, std::ranges::copy(small.values, both.values.begin()).out);
    return both;
}

// The features after the first convolution and after Fire 2, 4, 5, 6, 7 and 8.
inline std::vector<FeaturePlanes> featuresTwin(const Image& picture, std::span<const float> values) {
    const double mean[] = {-0.030, -0.088, -0.188}, deviation[] = {0.458, 0.448, 0.450};
    FeaturePlanes in(static_cast<int>(picture.size_px.x), static_cast<int>(picture.size_px.y), 3);
    for (int channel = 0; channel < 3; ++channel) {
        for (int y = 0; y < in.height; ++y) {
            for (int x = 0; x < in.width; ++x) {
                const float value = picture.values[static_cast<std::size_t>((y * in.width + x) * picture.channels + channel)];
                in.at(channel, x, y) = (2.0 * std::clamp(static_cast<double>(value), 0.0, 1.0) - 1.0 - mean[channel]) / deviation[channel];
            }
        }
    }
    std::vector<FeaturePlanes> features{convolveTwin(in, values, 64, 3, 2, 0)};
    features.push_back(fireTwin(fireTwin(poolTwin(features[0]), values, 16, 64), values, 16, 64));
    features.push_back(fireTwin(fireTwin(poolTwin(features[1]), values, 32, 128), values, 32, 128));
    features.push_back(fireTwin(poolTwin(features[2]), values, 48, 192));
    features.push_back(fireTwin(features[3], values, 48, 192));
    features.push_back(fireTwin(features[4], values, 64, 256));
    features.push_back(fireTwin(features[5], values, 64, 256));
    return features;
}

inline double lengthTwin(const FeaturePlanes& features, int x, int y) {
    double squares = 0.0;
    for (int channel = 0; channel < features.channels; ++channel) { squares += std::pow(features.at(channel, x, y), 2.0); }
    return std::sqrt(squares) + 1e-10;
}

// `heads`: the seven, one behind the other.
inline double lpipsTwin(const std::vector<FeaturePlanes>& a, const std::vector<FeaturePlanes>& b, std::span<const float> heads) {
    double distance = 0.0;
    for (std::size_t layer = 0; layer < a.size(); ++layer) {
        double sum = 0.0;
        for (int y = 0; y < a[layer].height; ++y) {
            for (int x = 0; x < a[layer].width; ++x) {
                const double length_a = lengthTwin(a[layer], x, y), length_b = lengthTwin(b[layer], x, y);
                for (int channel = 0; channel < a[layer].channels; ++channel) {
                    const double difference = a[layer].at(channel, x, y) / length_a - b[layer].at(channel, x, y) / length_b;
                    sum += static_cast<double>(heads[static_cast<std::size_t>(channel)]) * difference * difference;
                }
            }
        }
        distance += sum / (static_cast<double>(a[layer].width) * a[layer].height);
        heads = heads.subspan(static_cast<std::size_t>(a[layer].channels));
    }
    return distance;
}

}  // namespace binosplat::test
