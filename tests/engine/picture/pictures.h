// Pictures whose comparison has a known result.
#pragma once

#include "engine/picture/image.h"
#include "tests/suite.h"

namespace binosplat::test {

inline Image makeGrey(glm::uvec2 size_px, int channels, float value) {
    return {size_px, channels, std::vector<float>(std::size_t{size_px.x} * size_px.y * channels, value)};
}

inline glm::vec3 colourOf(const Image& image, std::uint32_t x, std::uint32_t y) {
    const float* values = image.values.data() + (std::size_t{y} * image.size_px.x + x) * image.channels;
    return {values[0], values[1], values[2]};
}

inline void setPixel(Image& image, std::uint32_t x, std::uint32_t y, const glm::vec3& rgb) {
    float* values = image.values.data() + (std::size_t{y} * image.size_px.x + x) * image.channels;
    for (int i = 0; i < 3; ++i) { values[i] = rgb[i]; }
}

// The picture whose colour at (x, y) is `colour(x, y)`.
template <typename Colour>
Image makePicture(glm::uvec2 size_px, const Colour& colour, int channels = 3) {
    Image image = makeGrey(size_px, channels, 1.0f);
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        for (std::uint32_t x = 0; x < size_px.x; ++x) { setPixel(image, x, y, colour(x, y)); }
    }
    return image;
}

inline Image makeFlat(glm::uvec2 size_px, const glm::vec3& rgb, int channels = 3) {
    return makePicture(
        size_px, [&](double, double) { return rgb; }, channels);
}

// Waves in three colours, as a left or right eye would see them if they moved `shift_px` to the right.
inline Image makeWaves(glm::uvec2 size_px, double shift_px) {
    return makePicture(size_px, [&](double x, double y) {
        const double at = x - shift_px;
        return glm::vec3(glm::dvec3(0.5 + 0.4 * std::sin(0.7 * at + 0.2 * y),
                                    0.5 + 0.4 * std::sin(0.3 * at - 0.4 * y),
                                    0.5 + 0.3 * std::sin(0.11 * at)));
    });
}

}  // namespace binosplat::test
