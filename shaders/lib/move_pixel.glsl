// Between any two cameras: where a pixel with a given inverse depth lies in the other one.

// By how much it moves; third component: depth there over depth here, not positive behind the other camera.
vec3 moveOfPixel(PixelMap map, vec2 pixel_px, float inverse_depth) {
    const vec3 at = vec3(pixel_px, 1);
    const vec3 excess =
        vec3(dot(map.excess_x, at), dot(map.excess_y, at), dot(map.excess_z, at)) + map.shift * inverse_depth;
    const float depth_ratio = 1 + excess.z;
    return vec3((excess.xy - pixel_px * excess.z) / depth_ratio, depth_ratio);
}
vec3 movePixelAnywhere(PixelMap map, vec2 pixel_px, float inverse_depth) {
    return moveOfPixel(map, pixel_px, inverse_depth) + vec3(pixel_px, 0);
}
