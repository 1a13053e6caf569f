// Between the eyes: where a pixel with a given inverse depth lies in the other eye, and what is known of its depth.

// Pixels move along their row alone and keep their depth; see isRectified.
layout(constant_id = 0) const bool kRectified = false;

// Third component: depth there over depth here; not positive behind the other eye.
vec3 movePixel(PixelMap map, vec2 pixel_px, float inverse_depth) {
    const vec3 at = vec3(pixel_px, 1);
    if (kRectified) { return vec3(pixel_px.x + (dot(map.excess_x, at) + map.shift.x * inverse_depth), pixel_px.y, 1); }
    const vec3 excess = vec3(dot(map.excess_x, at), dot(map.excess_y, at), dot(map.excess_z, at)) + map.shift * inverse_depth;
    const float depth_ratio = 1 + excess.z;
    return vec3(pixel_px + (excess.xy - pixel_px * excess.z) / depth_ratio, depth_ratio);
}

// Pixels that the other eye's view moves by for a unit of inverse depth, as a vector.
vec2 disparityPerInverseDepth(PixelMap map, vec2 pixel_px) { return kRectified ? vec2(map.shift.x, 0) : map.shift.xy - pixel_px * map.shift.z; }

// The inverse depth that stands for a dominant pixel; 0, i.e. infinitely far, where nothing was blended.
float chosenInverseDepth(uint choice, float alpha, float depth_sum, float inverse_depth_sum) {
    if (!(alpha > 0)) { return 0; }
    if (choice == kDepthInverse) { return inverse_depth_sum / alpha; }
    return choice == kDepthMean ? alpha / depth_sum : 1 / depth_sum;
}

// What StereoPixel::nearest says while pixels arrive: greater for what is nearer, the lowest bit tells a pixel that arrived from
// one interpolated between two; 0: nothing arrived.
uint packNearest(float inverse_depth, bool covered) { return ((floatBitsToUint(inverse_depth) + 2) & ~1u) | (covered ? 1 : 0); }
float inverseDepthOf(uint nearest) { return uintBitsToFloat((nearest & ~1u) - 2); }

// What StereoPixel::nearest says once the pixel is resolved: covered pixels keep what reached them, the others have the highest
// bit set, and below it their class and the column whose place they repeat.
uint packUncovered(uint column, uint pixel_class) { return 0x80000000u | (pixel_class << 24) | column; }
bool isUncovered(uint packed) { return (packed & 0x80000000u) != 0; }
uint anchorColumn(uint packed) { return packed & 0xffffffu; }
uint pixelClass(uint packed) { return isUncovered(packed) ? (packed >> 24) & 3 : (packed & 1) != 0 ? kCovered : kGap; }
