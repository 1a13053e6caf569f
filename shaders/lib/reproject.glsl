// A pixel of the source on its way to where the target sees it: for reproject, and for resample if it moves
// pixels itself. For shaders that know pass.moving and pass.shown_mask, include lib/warp.glsl,
// lib/moving_pixel.glsl and lib/unseen.glsl, and define whether parts of the source were not rendered,
// whether colours are copied, and where pixels arrive.

bool hidesTiles();
bool copiesColours();
void put(WarpView warp, ivec2 at, uint arrival);

struct Moved {
    vec2 place_px;
    vec2 move_px;  // relative to where it was; keeps all digits of small differences
    float inverse_depth;
    uint spread;
    bool valid;
};

// True if the pixel or one within kHiddenMargin of it is in a hidden tile; testing corners is enough, since
// tiles are larger than that.
bool isNearHidden(WarpView warp, uvec2 pixel) {
    const vec2 low = vec2(pixel) - kHiddenMargin, high = vec2(pixel) + kHiddenMargin;
    return isHiddenAt(warp, pass.shown_mask, low) || isHiddenAt(warp, pass.shown_mask, high) ||
           isHiddenAt(warp, pass.shown_mask, vec2(low.x, high.y)) ||
           isHiddenAt(warp, pass.shown_mask, vec2(high.x, low.y));
}

// A pixel of the source as the target sees it. A pixel that blends two depths moves with the one in front:
// with the nearest of itself and its neighbours in the row. The rows above and below may not exist, or may
// already be colours of the target.
Moved moveSource(WarpView warp, uvec2 pixel) {
    const uint at = pixel.y * warp.row_words + pixel.x, moving = pass.moving.at[at];
    uint front = moving;
    if (!copiesColours() && (moving & kSpreadBits) >= kMixedCode) {
        if (pixel.x > 0) { front = max(front, pass.moving.at[at - 1]); }
        if (pixel.x + 1 < warp.size_px.x) { front = max(front, pass.moving.at[at + 1]); }
    }
    const float inverse_depth = front == 0 ? 0 : inverseDepthOf(front);
    const vec3 move = moveBetweenEyes(warp.target_from_source, vec2(pixel) + 0.5, inverse_depth);
    const bool seen = !hidesTiles() || !isNearHidden(warp, pixel);
    const uint spread = copiesColours() ? parityOf(pixel) : moving & kSpreadBits;
    return Moved(vec2(pixel) + 0.5 + move.xy, move.xy, inverse_depth / move.z, spread,
                 seen && moving != 0 && move.z > 0);
}

// Too far out to reach the picture even if the surface is stretched.
bool isOut(WarpView warp, Moved pixel) {
    const float reach_px = float(warp.gap_px + 2);
    return any(lessThan(pixel.place_px, vec2(-reach_px))) ||
           any(greaterThan(pixel.place_px, vec2(warp.size_px) + reach_px));
}

void putLanded(WarpView warp, Moved pixel) {
    put(warp, ivec2(floor(pixel.place_px)), movingPixel(pixel.inverse_depth, kLanded, pixel.spread));
}

// Along a row: the pixels between `here` and its right neighbour.
void putBetween(WarpView warp, Moved here, Moved right, int row) {
    const float reach = right.place_px.x - here.place_px.x;
    if (!(right.valid && reach > 1 && reach <= float(warp.gap_px + 1))) { return; }
    int x = int(floor(here.place_px.x)) + 1;
    const int end = int(floor(right.place_px.x));
    if (x >= end) { return; }
    [[dont_unroll]] do {
        const float share = (float(x) + 0.5 - here.place_px.x) / reach;
        put(warp, ivec2(x, row),
            movingPixel(mix(here.inverse_depth, right.inverse_depth, share), 0,
                        max(here.spread, right.spread)));
        ++x;
    }
    while (x < end)
        ;
}
