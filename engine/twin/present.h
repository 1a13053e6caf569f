// The float64 twin of present: an eye's picture in the headset's format.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace binosplat::reference {

struct Presentation {
    bool blue_first = false;  // BGRA instead of RGBA
    bool linear = false;      // bytes that count as light, from a display-encoded value (IEC 61966-2-1)
    double near = 0.2;
    bool see_through = false;  // alpha is written, too, and the bytes' light is multiplied by it
    double depth_offset = 0.0;
    bool is_cut = false;      // splats were tested against the meshes one by one, so pixels are not
    bool by_inverse = false;  // A/D is a pixel's mean 1/z; otherwise D/A is its mean z
};

// A word a pixel, the first channel lowest: rounded to 0 to 255, NaN as 0; opaque, or with the pixel's own
// alpha.
std::vector<std::uint32_t> present(std::span<const glm::dvec4> rgba, const Presentation& presentation);
// In these words, the bits that are kept stay as they were.
void keepBits(std::span<std::uint32_t> words, std::span<const std::uint32_t> before, std::uint32_t kept_bits);
// The same over `behind`, existing words; splats do not show where its content is nearer, by its depths as
// presentDepths has them, if there are any.
std::vector<std::uint32_t> presentOver(std::span<const glm::dvec4> rgba, std::span<const double> depth_sums,
                                       std::span<const std::uint32_t> behind,
                                       std::span<const double> mesh_depths, const Presentation& presentation);
// near over the depth, plus the offset: 1 at the near plane and in front of it, 0 where alpha is under a
// half. The depth is D/A or, where that lies between the ends of slopes that leave the pixel along its row or
// column, the end at which blending passes a half: a slope has steps of more than 2 % of 1/z, fifteen at
// most, and ends with the first smaller one; and ends differ by more than 10 %. Rows of `width` pixels.
std::vector<double> presentDepths(std::span<const glm::dvec4> rgba, std::span<const double> depth_sums,
                                  std::uint32_t width, const Presentation& presentation);

// turn: such words as a view with other axes shows them, each from the four around its place, in linear
// light. `linear`: bytes are light.
std::vector<std::uint32_t> turn(std::span<const std::uint32_t> words, glm::uvec2 picture_px,
                                glm::uvec2 view_px, const glm::dmat3& picture_from_view, bool linear);

}  // namespace binosplat::reference
