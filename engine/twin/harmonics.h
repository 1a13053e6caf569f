// The colour that spherical harmonics give in a direction.
#pragma once

#include "engine/scene/sh_basis.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace binosplat::reference {

// The device stores coefficients and colours as half floats, whose range ends here; larger values are clamped
// to it.
inline constexpr double kMaxHalf = 65504.0;

// The sum of the bands up to `degree` in the unit direction d; `sh` has three channels per coefficient. Not
// finite if any of them is not.
inline glm::dvec3 evaluateHarmonics(const float* sh, int degree, const glm::dvec3& d) {
    const std::array<double, 16> basis = shBasis(d);
    const auto limit = [](float value) {
        return std::isfinite(value) ? std::clamp(static_cast<double>(value), -kMaxHalf, kMaxHalf)
                                    : static_cast<double>(value);
    };
    glm::dvec3 sum(0.0);
    for (int k = 0; k < (degree + 1) * (degree + 1); ++k) {
        sum += basis[static_cast<std::size_t>(k)] *
               glm::dvec3(limit(sh[3 * k]), limit(sh[3 * k + 1]), limit(sh[3 * k + 2]));
    }
    return sum;
}

}  // namespace binosplat::reference
