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
    double depth_offset = 0.0;
    bool is_cut = false;  // splats were tested against the meshes one by one, and pixels are not
};

// A word a pixel, the first channel lowest: nearest of 0 to 255, NaN as 0; opaque, or with the pixel's own alpha.
std::vector<std::uint32_t> present(std::span<const glm::dvec4> rgba, const Presentation& presentation);
// Words of which the bits that are kept stay as they were before.
void keepBits(std::span<std::uint32_t> words, std::span<const std::uint32_t> before, std::uint32_t kept_bits);
// The same over `behind`, such words; splats do not show where what is there is nearer, by its depths as presentDepths has them, if there
// are any.
std::vector<std::uint32_t> presentOver(std::span<const glm::dvec4> rgba, std::span<const double> depth_sums,
                                       std::span<const std::uint32_t> behind, std::span<const double> mesh_depths,
                                       const Presentation& presentation);
// near / (D/A), and the offset: 1 at the near plane and before it, 0 where alpha stays under 1/255.
std::vector<double> presentDepths(std::span<const glm::dvec4> rgba, std::span<const double> depth_sums, const Presentation& presentation);

// turn: such words as a view with other axes shows them, each from the four around its place, in light. `linear`: bytes are light.
std::vector<std::uint32_t> turn(std::span<const std::uint32_t> words, glm::uvec2 picture_px, glm::uvec2 view_px,
                                const glm::dmat3& picture_from_view, bool linear);

}  // namespace binosplat::reference
