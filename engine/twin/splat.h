// The equations that several passes share: a splat in camera space, its pixel rows, and where the ray of a
// pixel meets it.
#pragma once

#include "engine/twin/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace binosplat::reference {

inline constexpr int kTileSize = 16;
inline constexpr double kMaxAlpha = 0.99;
inline constexpr double kMinTransmittance = 1e-4;
// sigma = sqrt(2)/2 px, so rho2 = |offset|^2 / sigma^2 = 2 |offset|^2.
inline constexpr double kLowPassFactor = 2.0;
// 3DGS's low-pass: the variance in px^2 that is added on the screen.
inline constexpr double kScreenVariance = 0.3;
// A 3D Gaussian's depth at a pixel stays within this ratio of its centre's.
inline constexpr double kDepthReach = 2.0;
// Below this sine of the angle between the line of sight and the plane, the eye is in the plane as far as
// float64 can tell.
inline constexpr double kMinPlaneSine = 1e-14;

inline bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline glm::uvec2 tileGrid(glm::uvec2 size_px) {
    return {(size_px.x + kTileSize - 1) / kTileSize, (size_px.y + kTileSize - 1) / kTileSize};
}

// What an eye contributes to every splat.
struct EyeFrame {
    explicit EyeFrame(const Eye& eye)
        : camera_from_world(glm::mat3_cast(glm::conjugate(eye.world_from_camera.orientation))),
          position_world(eye.world_from_camera.position),
          intrinsics(eye.intrinsics),
          size_px(eye.size_px),
          own_pixel_px(eye.own_pixel_px) {}

    glm::dmat3 camera_from_world;
    glm::dvec3 position_world;
    Intrinsics intrinsics;
    glm::dvec2 size_px;
    double own_pixel_px;  // the pixel size for which splats have their low-pass
};

// The disc u a + v b + c in camera space, u^2 + v^2 < cut; or a 3D Gaussian about c with the axes a, b and w.
struct CameraSplat {
    glm::dvec3 a, b, c;
    double cut;  // 2 ln(255 o), positive
    glm::dvec3 w;
};

// A 3D Gaussian on the screen: Sigma2 = J Sigma J^T + kScreenVariance, with J the projection's derivative at
// the centre, and x/z and y/z held within the picture enlarged by 0.3 of its half width and height on each
// side.
struct ScreenGaussian {
    double xx, xy, yy, det;
    double sharp_det;  // without the low-pass
    // The covariance of 1/z, to first order, with the place on the screen: -(J Sigma) e_z / z^2.
    glm::dvec2 with_depth;
};

inline ScreenGaussian screenGaussian(const CameraSplat& splat, const EyeFrame& eye) {
    const Intrinsics& k = eye.intrinsics;
    const glm::dvec2 focal(k.fx, k.fy), principal(k.cx, k.cy), border = 0.3 * 0.5 * eye.size_px;
    const glm::dvec2 slope = glm::clamp(glm::dvec2(splat.c) / splat.c.z, (-principal - border) / focal,
                                        (eye.size_px - principal + border) / focal);
    const auto project = [&](const glm::dvec3& axis) {
        return focal / splat.c.z * (glm::dvec2(axis) - slope * axis.z);
    };
    const glm::dvec2 a = project(splat.a), b = project(splat.b), w = project(splat.w);
    const auto cross = [](const glm::dvec2& p, const glm::dvec2& q) { return p.x * q.y - p.y * q.x; };
    const double variance = kScreenVariance * eye.own_pixel_px * eye.own_pixel_px;
    ScreenGaussian g{};
    const double sharp_xx = a.x * a.x + b.x * b.x + w.x * w.x, sharp_yy = a.y * a.y + b.y * b.y + w.y * w.y;
    g.xx = sharp_xx + variance;
    g.xy = a.x * a.y + b.x * b.y + w.x * w.y;
    g.yy = sharp_yy + variance;
    g.with_depth = -(splat.a.z * a + splat.b.z * b + splat.w.z * w) / (splat.c.z * splat.c.z);
    // xx yy - xy^2 as a sum of squares (Cauchy and Binet): for a needle the difference would lose all digits.
    const double ab = cross(a, b), aw = cross(a, w), bw = cross(b, w);
    g.sharp_det = ab * ab + aw * aw + bw * bw;
    g.det = g.sharp_det + variance * (sharp_xx + sharp_yy) + variance * variance;
    return g;
}

// Empty for a splat that is not visible anywhere: its opacity is at most 1/255, or an attribute is not
// finite.
inline std::optional<CameraSplat> toCamera(const Scene& scene, std::size_t splat, const EyeFrame& eye) {
    const double cut = 2.0 * std::log(255.0 * static_cast<double>(scene.opacities[splat]));
    if (!(cut > 0.0) || !std::isfinite(cut)) { return std::nullopt; }
    const glm::dvec3 from_eye = glm::dvec3(scene.positions[splat]) - eye.position_world;
    const glm::quat& stored = scene.rotations[splat];
    // A quaternion of length zero becomes NaN here, and makes the splat invisible.
    const glm::dmat3 disc = glm::mat3_cast(
        glm::dquat(stored.w, stored.x, stored.y, stored.z) /
        std::sqrt(static_cast<double>(stored.w) * stored.w + static_cast<double>(stored.x) * stored.x +
                  static_cast<double>(stored.y) * stored.y + static_cast<double>(stored.z) * stored.z));
    const CameraSplat result{static_cast<double>(scene.scales[splat].x) * (eye.camera_from_world * disc[0]),
                             static_cast<double>(scene.scales[splat].y) * (eye.camera_from_world * disc[1]),
                             eye.camera_from_world * from_eye, cut,
                             scene.isGaussian3d() ? static_cast<double>(scene.thicknesses[splat]) *
                                                        (eye.camera_from_world * disc[2])
                                                  : glm::dvec3(0.0)};
    if (!isFinite(result.a) || !isFinite(result.b) || !isFinite(result.c) || !isFinite(result.w)) {
        return std::nullopt;
    }
    return result;
}

// Pixel rows about an origin: (u, v, 1) . u / (u, v, 1) . w is the pixel x, relative to origin.x, of a point
// on the disc; with v its y.
struct PixelRows {
    glm::dvec3 u, v, w;
    glm::dvec2 origin_px;
};

// About the projected centre, where precision is best, unless there is none or it is so far out that the
// pixels themselves would lose digits; then about the middle of the image.
inline PixelRows pixelRows(const ProjectedSplat& splat, glm::uvec2 size_px) {
    const glm::dvec2 size(size_px), middle = 0.5 * size;
    const glm::dvec2 away = glm::abs(splat.reference_px - middle);
    const bool at_centre = splat.low_pass && std::max(away.x, away.y) <= 4.0 * std::max(size.x, size.y);
    const glm::dvec2 origin = at_centre ? splat.reference_px : middle;
    PixelRows rows{splat.row_u - origin.x * splat.row_w, splat.row_v - origin.y * splat.row_w, splat.row_w,
                   origin};
    if (at_centre) { rows.u.z = rows.v.z = 0.0; }
    return rows;
}

// (u/z, v/z, 1/z) as a linear function of the pixel: q / det, where q = x (V x W) + y (W x U) + (U x V) and
// det = U . (V x W).
struct RayPlane {
    glm::dvec2 origin_px;
    glm::dvec3 at_origin, along_x, along_y;
    glm::dvec2 centre_px;
    double centre_depth, cut, near;
    bool disc, low_pass;
    bool gaussian = false;
    double low_pass_factor = kLowPassFactor;
    glm::dvec2 depth_slope{0.0};  // of a 3D Gaussian: of 1/z, which rho does not depend on
};

inline RayPlane rayPlane(const ProjectedSplat& splat, glm::uvec2 size_px, double near) {
    if (splat.gaussian) {
        const glm::dvec3 plane = splat.plane_from_pixel * splat.inverse_depth;
        return {splat.reference_px,
                {0.0, 0.0, splat.inverse_depth},
                {plane.x, 0.0, 0.0},
                {plane.y, plane.z, 0.0},
                splat.reference_px,
                splat.depth,
                splat.cut,
                near,
                true,
                false,
                true,
                splat.low_pass_factor,
                splat.perspective};
    }
    const PixelRows rows = pixelRows(splat, size_px);
    const glm::dvec3 across = glm::cross(rows.u, rows.v);
    const double inverse_det = 1.0 / glm::dot(rows.w, across);
    return {rows.origin_px,
            across * inverse_det,
            glm::cross(rows.v, rows.w) * inverse_det,
            glm::cross(rows.w, rows.u) * inverse_det,
            splat.reference_px,
            splat.depth,
            splat.cut,
            near,
            splat.disc,
            splat.low_pass,
            false,
            splat.low_pass_factor};
}

// How a pixel sees a splat.
struct Hit {
    double rho, depth;
};

// False if the ray misses. A hit of the disc that is nearer than `near` (or behind the eye, or not finite)
// does not count, which leaves the low-pass, if any. Every comparison is written to fail for NaN.
inline bool meet(const RayPlane& plane, const glm::dvec2& pixel, Hit& hit) {
    bool met = false;
    hit = {plane.cut, 0.0};
    if (plane.disc) {
        const glm::dvec2 d = pixel - plane.origin_px;
        const double u = plane.at_origin.x + plane.along_x.x * d.x + plane.along_y.x * d.y;
        const double v = plane.at_origin.y + plane.along_x.y * d.x + plane.along_y.y * d.y;
        const double inverse_depth = plane.at_origin.z + plane.along_x.z * d.x + plane.along_y.z * d.y;
        const double square = u * u + v * v, scale = inverse_depth * inverse_depth;
        if (inverse_depth > 0.0 && plane.near * inverse_depth <= 1.0 && square < plane.cut * scale) {
            hit = {square / scale, 1.0 / inverse_depth};
            if (plane.gaussian) {
                hit.depth = 1.0 / std::clamp(inverse_depth + glm::dot(plane.depth_slope, d),
                                             inverse_depth / kDepthReach, inverse_depth * kDepthReach);
            }
            met = true;
        }
    }
    if (plane.low_pass) {
        const glm::dvec2 d = pixel - plane.centre_px;
        const double rho2 = plane.low_pass_factor * (d.x * d.x + d.y * d.y);
        if (rho2 < hit.rho) {
            hit = {rho2, plane.centre_depth};
            met = true;
        }
    }
    return met;
}

}  // namespace binosplat::reference
