// Reading pictures of any format as linear light, and writing light as sRGB bytes.
#pragma once

#include "xr/simulated/compose/compose.h"

#include <glm/vec4.hpp>

#include <optional>

namespace simulated {

// A rectangle of a picture, seen as linear light with the alpha as stored. Throws std::invalid_argument if
// the rectangle is empty or not inside the picture, or if the picture does not have the bytes it should.
class Sampler {
public:
    Sampler(const Picture& picture, const Rect& rect);

    // Column and row within the rectangle.
    [[nodiscard]] glm::dvec4 texel(std::uint32_t x, std::uint32_t y) const;
    // Bilinear at u, v from 0 to 1, from the rectangle's left and top edges; texels beyond the rectangle are
    // those at its edge.
    [[nodiscard]] glm::dvec4 sample(double u, double v) const;
    // None beyond the rectangle's edges.
    [[nodiscard]] std::optional<glm::dvec4> sampleInside(double u, double v) const;

private:
    Picture picture_;
    Rect rect_;
};

// The nearest sRGB byte; below 0 and NaN are 0, above 1 is 255.
[[nodiscard]] std::uint8_t srgbByte(double linear);

}  // namespace simulated
