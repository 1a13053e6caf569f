// The part of the screen that a splat covers: the outline rho < cut of its disc, a conic, and the circle of
// the low-pass around its projected centre. Both are convex, so the pixels that they cover in a band of rows
// lie between two bounds.
//
// Offsets y from the centre, s = A x + B y (= u/z), h = e + gamma y (1/z at s = 0), phi = f/A, gamma = g -
// phi B: the outline s^2 + D^2 y^2 = cut (h + phi s)^2 has for each y the ends
//   s = (cut phi h -+ S) / kappa,   S^2 = cut h^2 - kappa D^2 y^2,   kappa = 1 - cut phi^2.
// S^2 is a parabola R^2 - m (y - y_c)^2 in y; x = (s - B y)/A is greatest where dS/dy = P := kappa B - cut
// phi gamma, which is y_c - P R / sqrt(m (m + P^2)), and least at y_c + the same. All is `precise`: two
// passes must count the same tiles.

struct Outline {
    vec2 centre_px;
    float circle_px;  // radius of the low-pass; 0: none
    bool ellipse;     // false: the disc reaches the eye's plane, or nothing of it is visible
    float a, b, d, e, phi, gamma, kappa, cut;
    vec2 rows;  // y of the lowest and highest point, offsets
    float y_leftmost, y_rightmost;
};

Outline outlineOf(vec2 centre_px, vec3 plane, vec2 perspective, float inverse_depth, float cut,
                  float low_pass) {
    Outline o;
    o.centre_px = centre_px;
    precise const float circle_px = sqrt(cut / low_pass);
    o.circle_px = circle_px;
    o.a = plane.x;
    o.b = plane.y;
    o.d = abs(plane.z);
    o.e = inverse_depth;
    o.cut = cut;
    precise const float phi = perspective.x / plane.x;
    precise const float gamma = perspective.y - phi * plane.y;
    precise const float kappa = 1 - cut * phi * phi;
    precise const float slope = sqrt(max(kappa, 0) / cut) * o.d;
    o.phi = phi;
    o.gamma = gamma;
    o.kappa = kappa;
    o.ellipse = kappa > 0 && slope > abs(gamma) && inverse_depth > 0;
    precise const vec2 rows = vec2(-inverse_depth / (slope + gamma), inverse_depth / (slope - gamma));
    o.rows = rows;
    precise const float m = cut * (slope - gamma) * (slope + gamma);
    precise const float y_c = cut * inverse_depth * gamma / m;
    precise const float p = kappa * plane.y - cut * phi * gamma;
    precise const float r = cut * inverse_depth * slope / sqrt(m);
    precise const float reach = p / sqrt(m + p * p) * r / sqrt(m);
    o.y_leftmost = y_c + reach;
    o.y_rightmost = y_c - reach;
    return o;
}

// The bounds in x, in pixels, of what `o` covers between the rows y0 and y1 (in pixels); empty if x > y.
vec2 boundsBetweenRows(Outline o, float y0, float y1) {
    precise const float top = y0 - o.centre_px.y, bottom = y1 - o.centre_px.y;
    precise vec2 bounds = vec2(1e9, -1e9);
    if (o.ellipse) {
        const float first = max(top, o.rows.x), last = min(bottom, o.rows.y);
        if (first <= last) {
            const float y_left = clamp(o.y_leftmost, first, last),
                        y_right = clamp(o.y_rightmost, first, last);
            precise const float h_left = o.e + o.gamma * y_left, h_right = o.e + o.gamma * y_right;
            precise const float dy_left = o.d * y_left, dy_right = o.d * y_right;
            precise const float s_left =
                (o.cut * o.phi * h_left -
                 sqrt(max(0, o.cut * h_left * h_left - o.kappa * dy_left * dy_left))) /
                o.kappa;
            precise const float s_right =
                (o.cut * o.phi * h_right +
                 sqrt(max(0, o.cut * h_right * h_right - o.kappa * dy_right * dy_right))) /
                o.kappa;
            bounds = vec2((s_left - o.b * y_left) / o.a, (s_right - o.b * y_right) / o.a);
        }
    }
    const float nearest = clamp(0, top, bottom);
    if (abs(nearest) <= o.circle_px) {
        precise const float half_chord = sqrt(o.circle_px * o.circle_px - nearest * nearest);
        bounds = vec2(min(bounds.x, -half_chord), max(bounds.y, half_chord));
    }
    precise const vec2 result = bounds + o.centre_px.x;
    return result;
}

// The units of `size` pixels whose pixel centres lie between the bounds: first and end, clipped to [0,
// count).
ivec2 unitsBetween(vec2 bounds_px, uint size, uint count) {
    precise const vec2 padded = vec2(bounds_px.x - kOutlinePadding, bounds_px.y + kOutlinePadding) - 0.5;
    const float first_pixel = ceil(padded.x), last_pixel = floor(padded.y);
    if (!(first_pixel <= last_pixel)) { return ivec2(0, 0); }
    precise const vec2 units = vec2(floor(first_pixel / float(size)), floor(last_pixel / float(size)) + 1);
    const vec2 clipped = clamp(units, vec2(0), vec2(count));
    // Also for NaN, which the clamp above may turn into anything.
    return clamp(ivec2(clipped), ivec2(0), ivec2(count));
}

// The tiles of a row that a splat touches, within its box of tiles; for a disc that reaches the eye's plane,
// all tiles of the box.
ivec2 tilesInRow(Outline o, uint row, ivec4 tile_box) {
    if (!o.ellipse) { return tile_box.xz; }
    const float first_row = float(row * kTileSize) + 0.5;
    const vec2 bounds =
        boundsBetweenRows(o, first_row - kOutlinePadding, first_row + float(kTileSize - 1) + kOutlinePadding);
    const ivec2 tiles = unitsBetween(bounds, kTileSize, 0x7fffffu);
    return ivec2(max(tiles.x, tile_box.x), min(tiles.y, tile_box.z));
}

// `low_pass`: as in EyeView.
Outline outlineOfProjected(ProjectedSplat p, float low_pass) {
    const float cut = (kLog2Of255 - negativeLog2Opacity(p)) / kLog2PerRho;
    if (kSplatKind != kDiscs) {  // an ellipse around its centre, if anything of it is visible
        Outline o = outlineOf(p.reference_px, p.plane_from_pixel, vec2(0), 1, cut, low_pass);
        o.circle_px = 0;
        o.ellipse = o.ellipse && cut > 0 && hasReference(p);
        return o;
    }
    Outline o = outlineOf(p.reference_px, p.plane_from_pixel, p.perspective, p.inverse_depth, cut, low_pass);
    if (!hasReference(p)) {
        o.ellipse = false;
        o.circle_px = 0;
    }
    return o;
}
