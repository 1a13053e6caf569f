// Images in float32 on the host, rows top to bottom.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

namespace binosplat {

// `channels` interleaved floats per pixel: values[(y * size_px.x + x) * channels + channel].
struct Image {
    glm::uvec2 size_px{0, 0};
    int channels = 4;
    std::vector<float> values;

    [[nodiscard]] std::size_t pixelCount() const { return std::size_t{size_px.x} * size_px.y; }
};

}  // namespace binosplat
