// Real spherical harmonics of degree 0 to 3 with the constants and signs that 3DGS and 2DGS scenes are trained with.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace binosplat::reference {

// The device holds coefficients and colours as half floats, which end here: what lies beyond counts as this.
inline constexpr double kMaxHalf = 65504.0;

// Sum of the bands up to `degree` in the unit direction d; `sh` holds three channels per coefficient. Not finite if one of them is not.
inline glm::dvec3 evaluateHarmonics(const float* sh, int degree, const glm::dvec3& d) {
    const double x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
    const double basis[16] = {
        0.28209479177387814,      // sqrt(1 / pi) / 2
        -0.4886025119029199 * y,  // sqrt(3 / pi) / 2
        0.4886025119029199 * z,
        -0.4886025119029199 * x,
        1.0925484305920792 * x * y,  // sqrt(15 / pi) / 2
        -1.0925484305920792 * y * z,
        0.31539156525252005 * (2.0 * zz - xx - yy),  // sqrt(5 / pi) / 4
        -1.0925484305920792 * x * z,
        0.5462742152960396 * (xx - yy),                             // sqrt(15 / pi) / 4
        -0.5900435899266435 * y * (3.0 * xx - yy),                  // sqrt(35 / (2 pi)) / 4
        2.890611442640554 * x * y * z,                              // sqrt(105 / pi) / 2
        -0.4570457994644658 * y * (4.0 * zz - xx - yy),             // sqrt(21 / (2 pi)) / 4
        0.3731763325901154 * z * (2.0 * zz - 3.0 * xx - 3.0 * yy),  // sqrt(7 / pi) / 4
        -0.4570457994644658 * x * (4.0 * zz - xx - yy),
        1.445305721320277 * z * (xx - yy),  // sqrt(105 / pi) / 4
        -0.5900435899266435 * x * (xx - 3.0 * yy),
    };
    const auto limit = [](float value) {
        return std::isfinite(value) ? std::clamp(static_cast<double>(value), -kMaxHalf, kMaxHalf) : static_cast<double>(value);
    };
    glm::dvec3 sum(0.0);
    for (int k = 0; k < (degree + 1) * (degree + 1); ++k) {
        sum += basis[k] * glm::dvec3(limit(sh[3 * k]), limit(sh[3 * k + 1]), limit(sh[3 * k + 2]));
    }
    return sum;
}

}  // namespace binosplat::reference
