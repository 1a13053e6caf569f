// The bounds on the screen of a disc that reaches through the near plane. They are those of its part beyond
// that plane, which is convex: they lie where its outline is tangent to the axes, or at the ends of the chord
// that the near plane cuts.

// `slack`: how far off the point may be, by the rounding of its sum.
void widenBy(inout vec4 bounds, EyeView eye, vec3 p, float slack) {
    const vec2 pixel = eye.focal_px * p.xy / p.z + eye.principal_px;
    const vec2 slack_px = eye.focal_px * (slack / p.z) * (1 + abs(p.xy) / p.z);
    bounds = vec4(min(bounds.xy, pixel - slack_px), max(bounds.zw, pixel + slack_px));
}

vec3 pointOf(CameraSplat splat, vec2 uv) {
    return uv.x * splat.scale.x * splat.t_u + uv.y * splat.scale.y * splat.t_v + splat.centre;
}

// A point of the outline, if it is not nearer than the near plane.
void widen(inout vec4 bounds, CameraSplat splat, EyeView eye, vec2 uv, float slack) {
    const vec3 p = pointOf(splat, uv);
    if (p.z >= eye.near - slack) { widenBy(bounds, eye, vec3(p.xy, max(p.z, eye.near)), slack); }
}

// Both points of the outline where its tangent on the screen is parallel to an axis; `along` is that axis's
// row of (a, b, c).
void widenByTangents(inout vec4 bounds, CameraSplat splat, EyeView eye, float radius, vec3 along,
                     float slack) {
    const vec3 w = vec3(splat.scale.x * splat.t_u.z, splat.scale.y * splat.t_v.z, splat.centre.z);
    const vec3 form = vec3(radius * radius, radius * radius, -1);
    // along - x w is tangent to the dual conic: (w.w) x^2 - 2 (along.w) x + along.along = 0 in that form.
    const float ww = dot(form, w * w), aw = dot(form, along * w), aa = dot(form, along * along);
    const float root = sqrt(max(aw * aw - ww * aa, 0));
    for (int side = -1; side <= 1; side += 2) {
        const vec3 line = along - (aw + float(side) * root) / ww * w;
        widen(bounds, splat, eye, -radius * radius * line.xy / line.z, slack);
    }
}

// x0, y0, x1, y1 in pixels; empty (x0 > x1) if nothing lies beyond the near plane.
vec4 frontPartBounds(CameraSplat splat, EyeView eye, float radius) {
    const float slack = 1e-6 * (radius * max(splat.scale.x, splat.scale.y) + length(splat.centre));
    if (!(slack < 0.25 * eye.near)) { return vec4(-1e9, -1e9, 1e9, 1e9); }
    vec4 bounds = vec4(1e9, 1e9, -1e9, -1e9);
    const vec3 x = vec3(splat.scale.x * splat.t_u.x, splat.scale.y * splat.t_v.x, splat.centre.x);
    const vec3 y = vec3(splat.scale.x * splat.t_u.y, splat.scale.y * splat.t_v.y, splat.centre.y);
    widenByTangents(bounds, splat, eye, radius, x, slack);
    widenByTangents(bounds, splat, eye, radius, y, slack);
    const vec2 climb = splat.scale * vec2(splat.t_u.z, splat.t_v.z);  // by which z grows along u and v
    const float steepness = length(climb);
    const float along = (eye.near - splat.centre.z) / steepness;
    if (steepness > 0 && abs(along) <= radius) {
        const vec2 direction = climb / steepness;
        const float half_chord = sqrt(radius * radius - along * along);
        // The chord's ends are on the near plane, whatever their sum says.
        const vec2 across = half_chord * vec2(-direction.y, direction.x);
        widenBy(bounds, eye, vec3(pointOf(splat, along * direction + across).xy, eye.near), slack);
        widenBy(bounds, eye, vec3(pointOf(splat, along * direction - across).xy, eye.near), slack);
    }
    return bounds;
}
