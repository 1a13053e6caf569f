// Pictures whose comparison has a known result.
#pragma once

#include "engine/picture/image.h"

#include <cmath>
#include <cstdint>

namespace binosplat::test {

inline Image makeFlat(glm::uvec2 size_px, const glm::vec3& rgb, int channels = 3) {
    Image image{size_px, channels, std::vector<float>(std::size_t{size_px.x} * size_px.y * static_cast<std::size_t>(channels), 1.0f)};
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        for (int i = 0; i < 3; ++i) { image.values[pixel * static_cast<std::size_t>(channels) + static_cast<std::size_t>(i)] = rgb[i]; }
    }
    return image;
}

inline void setPixel(Image& image, std::uint32_t x, std::uint32_t y, const glm::vec3& rgb) {
    float* values = image.values.data() + (std::size_t{y} * image.size_px.x + x) * static_cast<std::size_t>(image.channels);
    for (int i = 0; i < 3; ++i) { values[i] = rgb[i]; }
}

// Waves in three colours, as a left or right eye would see them if moved by `shift_px` to the right.
inline Image makeWaves(glm::uvec2 size_px, double shift_px) {
    Image image = makeFlat(size_px, glm::vec3(0.0f));
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        for (std::uint32_t x = 0; x < size_px.x; ++x) {
            const double at = x - shift_px;
            setPixel(image, x, y,
                     glm::vec3(glm::dvec3(0.5 + 0.4 * std::sin(0.7 * at + 0.2 * y), 0.5 + 0.4 * std::sin(0.3 * at - 0.4 * y),
                                          0.5 + 0.3 * std::sin(0.11 * at))));
        }
    }
    return image;
}

// The same picture mirrored left to right.
inline Image mirror(const Image& image) {
    Image result = image;
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t y = 0; y < image.size_px.y; ++y) {
        for (std::size_t x = 0; x < image.size_px.x; ++x) {
            const std::size_t to = (y * image.size_px.x + x) * channels, from = (y * image.size_px.x + image.size_px.x - 1 - x) * channels;
            for (std::size_t i = 0; i < channels; ++i) { result.values[to + i] = image.values[from + i]; }
        }
    }
    return result;
}

}  // namespace binosplat::test
