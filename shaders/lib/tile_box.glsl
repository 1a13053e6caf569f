// The tiles on the screen that contain all of a splat: x0, y0, x1, y1, half open.

ivec4 tilesWithin(vec4 bounds_px, uvec2 size_tiles) {
    const ivec2 x_tiles = unitsBetween(bounds_px.xz, kTileSize, size_tiles.x);
    const ivec2 y_tiles = unitsBetween(bounds_px.yw, kTileSize, size_tiles.y);
    return ivec4(x_tiles.x, y_tiles.x, x_tiles.y, y_tiles.y);
}

// The bounds of an ellipse and its low-pass in pixels.
vec4 ellipseBounds(Outline outline) {
    const vec2 x_px = boundsBetweenRows(outline, -1e9, 1e9);
    const vec2 y_px = vec2(min(outline.rows.x, -outline.circle_px), max(outline.rows.y, outline.circle_px)) +
                      outline.centre_px.y;
    return vec4(x_px.x, y_px.x, x_px.y, y_px.y);
}

ivec4 tileBox(CameraSplat splat, EyeView eye, Outline outline) {
    if (kSplatKind != kDiscs) {
        return outline.ellipse ? tilesWithin(ellipseBounds(outline), eye.size_tiles) : ivec4(0);
    }
    vec4 bounds_px = outline.ellipse ? ellipseBounds(outline) : vec4(-1e9, -1e9, 1e9, 1e9);
    const float radius = sqrt(outline.cut);
    const float reach = radius * length(splat.scale * vec2(splat.t_u.z, splat.t_v.z));
    if (!outline.ellipse || splat.centre.z - reach < eye.near) {
        vec4 front_px = frontPartBounds(splat, eye, radius);
        if (outline.circle_px > 0) {
            const vec2 circle_px = vec2(outline.circle_px);
            front_px = vec4(min(front_px.xy, outline.centre_px - circle_px),
                            max(front_px.zw, outline.centre_px + circle_px));
        }
        bounds_px = vec4(max(bounds_px.xy, front_px.xy), min(bounds_px.zw, front_px.zw));
    }
    return tilesWithin(bounds_px, eye.size_tiles);
}
