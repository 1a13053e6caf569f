// Between the eyes: where a pixel with a given inverse depth lies in the other eye.

#include "lib/move_pixel.glsl"

// Pixels move along their row alone and keep their depth; see EyeRelation.
layout(constant_id = 0) const bool kRectified = false;

// Third component: depth there over depth here; not positive behind the other eye.
vec3 movePixel(PixelMap map, vec2 pixel_px, float inverse_depth) {
    const vec3 at = vec3(pixel_px, 1);
    if (kRectified) { return vec3(pixel_px.x + (dot(map.excess_x, at) + map.shift.x * inverse_depth), pixel_px.y, 1); }
    return movePixelAnywhere(map, pixel_px, inverse_depth);
}

// By how many pixels the other eye's view is shifted per unit of inverse depth, as a vector.
vec2 disparityPerInverseDepth(PixelMap map, vec2 pixel_px) { return kRectified ? vec2(map.shift.x, 0) : map.shift.xy - pixel_px * map.shift.z; }

// Where errors are predicted, an odd row is warped like the even one above it, with that one's depths.
bool movesEvenRows(WarpView warp) { return kRectified && warp.rows_apart == 2; }
