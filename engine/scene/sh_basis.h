// Real spherical harmonics of degree 0 to 3 with the constants and signs that 3DGS and 2DGS scenes are
// trained with.
#pragma once

#include <glm/glm.hpp>

#include <array>

namespace binosplat {

// All sixteen in the unit direction d, band by band.
inline std::array<double, 16> shBasis(const glm::dvec3& d) {
    const double x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
    return {
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
}

}  // namespace binosplat
