// The float64 twin of present: an eye's picture in the format that the headset takes.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace binosplat::reference {

struct Presentation {
    bool blue_first = false;  // BGRA in place of RGBA
    bool linear = false;      // bytes that count as light, of a display-encoded value (IEC 61966-2-1)
    double near = 0.2;
    bool see_through = false;  // alpha is output, too, and the bytes' light is multiplied by it
};

// A word a pixel, the first channel lowest: nearest of 0 to 255, NaN as 0; opaque, or with the pixel's own alpha.
std::vector<std::uint32_t> present(std::span<const glm::dvec4> rgba, const Presentation& presentation);
// near / (D/A): 1 at the near plane and before it, 0 where alpha stays under 1/255.
std::vector<double> presentDepths(std::span<const glm::dvec4> rgba, std::span<const double> depth_sums, const Presentation& presentation);

}  // namespace binosplat::reference
