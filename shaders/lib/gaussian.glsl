// A 3D Gaussian on the screen, as it was trained: its covariance through the projection's derivative at its
// centre, and a low-pass (Zwicker et al. 2001, sections 4 and 5; Kerbl et al. 2023, section 4). Needs
// lib/splat.glsl.
//
// The axes s_u t_u, s_v t_v, s_w t_w become three vectors m on the screen, and Sigma2 = sum m m^T +
// kScreenVariance. Its determinant is a sum of squares, kScreenVariance^2 + kScreenVariance sum |m|^2 + sum
// (m_i x m_j)^2 (Cauchy and Binet), which keeps its digits for needles and for sheets seen edge-on, and needs
// only roots, no squares of large numbers.

struct ScreenGaussian {
    float xx, xy, yy;  // Sigma2, px^2
    float root_det;    // of Sigma2
    float root_sharp;  // of Sigma2 without the low-pass
    vec2 with_depth;   // the covariance of 1/z with the place on the screen, px
};

// Without squares of large numbers.
float lengthOf(vec3 areas, float rest) {
    const float most = max(max(abs(areas.x), abs(areas.y)), max(max(abs(areas.z), rest), 1e-30));
    return most * length(vec4(areas, rest) / most);
}

// For a centre beyond the eye's plane.
ScreenGaussian screenGaussian(CameraSplat splat, EyeView eye) {
    const vec2 size_px = vec2(eye.size_px);
    const vec2 low = -(eye.principal_px + kDerivativeBorder * size_px) / eye.focal_px;
    const vec2 high = (size_px - eye.principal_px + kDerivativeBorder * size_px) / eye.focal_px;
    const vec2 slope = clamp(splat.centre.xy / splat.centre.z, low, high);
    const vec2 px_per_unit = eye.focal_px / splat.centre.z;
    const vec3 t_w = cross(splat.t_u, splat.t_v);
    const vec3 scales =
        min(vec3(splat.scale, splat.thickness), kMaxSigma / max(px_per_unit.x, px_per_unit.y));
    const vec2 u = scales.x * px_per_unit * (splat.t_u.xy - slope * splat.t_u.z);
    const vec2 v = scales.y * px_per_unit * (splat.t_v.xy - slope * splat.t_v.z);
    const vec2 w = scales.z * px_per_unit * (t_w.xy - slope * t_w.z);
    // The area that two axes span, seen along the line of sight: u x v and the like.
    const vec3 along =
        vec3(dot(splat.t_u, vec3(slope, 1)), dot(splat.t_v, vec3(slope, 1)), dot(t_w, vec3(slope, 1)));
    const vec3 areas = vec3(scales.y * px_per_unit.x, scales.x * px_per_unit.x, scales.x * px_per_unit.x) *
                       (vec3(scales.z, scales.z, scales.y) * px_per_unit.y) * along;
    ScreenGaussian g;
    g.xx = u.x * u.x + v.x * v.x + w.x * w.x + eye.screen_variance;
    g.xy = u.x * u.y + v.x * v.y + w.x * w.y;
    g.yy = u.y * u.y + v.y * v.y + w.y * w.y + eye.screen_variance;
    const vec3 climb = scales * vec3(splat.t_u.z, splat.t_v.z, t_w.z) / splat.centre.z;
    g.with_depth = -(climb.x * u + climb.y * v + climb.z * w) / splat.centre.z;
    // xx + yy contains the variance of the low-pass twice.
    const float blurred = sqrt(eye.screen_variance) * sqrt(g.xx + g.yy - eye.screen_variance);
    g.root_det = lengthOf(areas, blurred);
    g.root_sharp = lengthOf(areas, 0);
    return g;
}

// What the low-pass leaves of an opacity that was trained with it (Yu et al. 2024, section 5.2).
float dimmedOpacity(float opacity, ScreenGaussian g) { return opacity * min(g.root_sharp / g.root_det, 1); }

// The geometry of ProjectedSplat; see there. `has_reference`: the centre is beyond the near plane, and the
// splat is visible at all.
ProjectedSplat projectGaussian(CameraSplat splat, EyeView eye, bool dimmed, out bool has_reference) {
    const vec3 c = splat.centre;
    has_reference = c.z > eye.near;
    const ScreenGaussian g = screenGaussian(splat, eye);
    ProjectedSplat p;
    p.reference_px = eye.focal_px * c.xy / c.z + eye.principal_px;
    p.inverse_depth = 1 / c.z;
    // rho = d^T Sigma2^-1 d = u^2 + v^2, where v does not depend on dx.
    const float a = sqrt(g.yy) / g.root_det;
    p.plane_from_pixel = vec3(a, -(g.xy / g.yy) * a, 1 / sqrt(g.yy));
    // The mean of 1/z along a ray, which to first order is where the Gaussian is greatest there: its
    // covariance with the place on the screen over the variance of the place, Sigma2. The low-pass keeps it
    // finite for a sheet seen edge-on.
    const float along_u = p.plane_from_pixel.x * g.with_depth.x + p.plane_from_pixel.y * g.with_depth.y;
    p.perspective = along_u * p.plane_from_pixel.xy +
                    vec2(0, p.plane_from_pixel.z * p.plane_from_pixel.z * g.with_depth.y);
    p.opacity = packOpacity(dimmed ? dimmedOpacity(splat.opacity, g) : splat.opacity, has_reference);
    p.colour = uvec2(0);
    return p;
}

// For a splat of the scene's kind; `dimmed`: Gaussians are.
ProjectedSplat projectSplat(CameraSplat splat, EyeView eye, bool dimmed, out bool has_reference) {
    if (kSplatKind == kDiscs) { return projectGeometry(splat, eye, has_reference); }
    return projectGaussian(splat, eye, dimmed, has_reference);
}
