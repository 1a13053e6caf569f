// A dominant pixel on its way to where the affiliated eye sees it: reproject, and resample where it moves pixels itself. For shaders that know
// pass.moving, pass.shown_mask and kForward, include lib/stereo.glsl, lib/moving_pixel.glsl and lib/unseen.glsl, and say
// whether parts of the dominant picture were not rendered, and where pixels arrive.

bool hidesTiles();
void put(StereoView stereo, ivec2 at, uint arrival);

struct Moved {
    vec2 place_px;
    float inverse_depth;
    uint spread;
    bool valid;
};

// Whether the pixel or one within kHiddenMargin of it lies in a hidden tile; tiles are larger than that.
bool isNearHidden(StereoView stereo, uvec2 pixel) {
    const vec2 low = vec2(pixel) - kHiddenMargin, high = vec2(pixel) + kHiddenMargin;
    return isHiddenAt(stereo, pass.shown_mask, low) || isHiddenAt(stereo, pass.shown_mask, high) ||
           isHiddenAt(stereo, pass.shown_mask, vec2(low.x, high.y)) || isHiddenAt(stereo, pass.shown_mask, vec2(high.x, low.y));
}

// A dominant pixel as the affiliated eye sees it.
Moved moveDominant(StereoView stereo, uvec2 pixel) {
    const uint moving = pass.moving.at[pixel.y * stereo.row_words + pixel.x];
    const float inverse_depth = moving == 0 ? 0 : inverseDepthOf(moving);
    const vec3 moved = movePixel(stereo.affiliated_from_dominant, vec2(pixel) + 0.5, inverse_depth);
    const bool seen = !hidesTiles() || !isNearHidden(stereo, pixel);
    const uint spread = kForward ? parityOf(pixel) : moving & kSpreadBits;
    return Moved(moved.xy, inverse_depth / moved.z, spread, seen && moving != 0 && moved.z > 0);
}

// Too far out to reach the picture even where the surface is stretched.
bool isOut(StereoView stereo, Moved pixel) {
    const float reach_px = float(stereo.gap_px + 2);
    return any(lessThan(pixel.place_px, vec2(-reach_px))) || any(greaterThan(pixel.place_px, vec2(stereo.size_px) + reach_px));
}

void putLanded(StereoView stereo, Moved pixel) {
    put(stereo, ivec2(floor(pixel.place_px)), movingPixel(pixel.inverse_depth, kLanded, pixel.spread));
}

// Along a row: the pixels between `here` and its right neighbour.
void putBetween(StereoView stereo, Moved here, Moved right, int row) {
    const float reach = right.place_px.x - here.place_px.x;
    if (!(right.valid && reach > 1 && reach <= float(stereo.gap_px + 1))) { return; }
    int x = int(floor(here.place_px.x)) + 1;
    const int end = int(floor(right.place_px.x));
    if (x >= end) { return; }
    [[dont_unroll]] do {
        const float share = (float(x) + 0.5 - here.place_px.x) / reach;
        put(stereo, ivec2(x, row), movingPixel(mix(here.inverse_depth, right.inverse_depth, share), 0, max(here.spread, right.spread)));
        ++x;
    } while (x < end);
}
