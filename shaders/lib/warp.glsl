// Between the eyes: where a pixel with a given inverse depth is in the other eye.

#include "lib/move_pixel.glsl"

// Pixels move only along their row and keep their depth; see EyeRelation.
layout(constant_id = 0) const bool kRectified = false;

// By how much; third component: depth there over depth here; not positive behind the other eye.
vec3 moveBetweenEyes(PixelMap map, vec2 pixel_px, float inverse_depth) {
    if (kRectified) { return vec3(dot(map.excess_x, vec3(pixel_px, 1)) + map.shift.x * inverse_depth, 0, 1); }
    return moveOfPixel(map, pixel_px, inverse_depth);
}
vec3 movePixel(PixelMap map, vec2 pixel_px, float inverse_depth) {
    return moveBetweenEyes(map, pixel_px, inverse_depth) + vec3(pixel_px, 0);
}

// By how many pixels the other eye's view is shifted per unit of inverse depth, as a vector.
vec2 disparityPerInverseDepth(PixelMap map, vec2 pixel_px) {
    return kRectified ? vec2(map.shift.x, 0) : map.shift.xy - pixel_px * map.shift.z;
}

// If errors are predicted, an odd row is warped like the even row above it, with that row's depths.
bool movesEvenRows(WarpView warp) { return kRectified && warp.rows_apart == 2; }
