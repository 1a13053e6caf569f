// 8d: the dominant eye's pixels go to where the affiliated eye sees them. The greatest inverse depth stays, whatever the order of
// threads; the source's place follows from it again in 8f, so that 32-bit atomics suffice (paper, section 3.4, equations 3 to 5).
// A surface may be stretched: pixels that fall between a pixel and its neighbours, at most gap_px apart, are interpolated here
// already, since what lies behind would otherwise show through the cracks. Where colours are copied nothing is: in the paper pixels alone
// move (section 3.1, stage 2), and what they leave open is a hole to be filled afterwards (stage 3). It does not say which pixel a place
// belongs to nor which of two surfaces stays: the pixel that holds it, and the nearer one; nor what becomes of pixels without any splat,
// whose D of 0 is no depth: they are infinitely far.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/tile_mask.glsl"
#include "lib/stereo.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/unseen.glsl"

layout(local_size_x = 16, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ReprojectPass pass; };
layout(constant_id = 1) const bool kHiddenTiles = false;  // parts of the dominant picture were not rendered
layout(constant_id = 2) const bool kForward = false;      // colours are going to be copied

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
    const bool seen = !kHiddenTiles || !isNearHidden(stereo, pixel);
    const uint spread = kForward ? parityOf(pixel) : moving & kSpreadBits;
    return Moved(moved.xy, inverse_depth / moved.z, spread, seen && moving != 0 && moved.z > 0);
}

void put(StereoView stereo, ivec2 at, float inverse_depth, uint landed, uint spread) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(stereo.size_px)))) { return; }
    atomicMax(pass.arrivals.at[uint(at.y) * stereo.row_words + uint(at.x)], movingPixel(inverse_depth, landed, spread));
}

// Along a row: the pixels between `here` and its right neighbour.
void putBetween(StereoView stereo, Moved here, Moved right, int row) {
    const float reach = right.place_px.x - here.place_px.x;
    if (!(right.valid && reach > 1 && reach <= float(stereo.gap_px + 1))) { return; }
    const int first = int(floor(here.place_px.x)) + 1, end = int(floor(right.place_px.x));
    for (int x = first; x < end; ++x) {
        put(stereo, ivec2(x, row), mix(here.inverse_depth, right.inverse_depth, (float(x) + 0.5 - here.place_px.x) / reach), 0,
            max(here.spread, right.spread));
    }
}

// In any direction: the pixels whose centres lie in the parallelogram between `here`, its right and its lower neighbour.
void putWithin(StereoView stereo, Moved here, Moved right, Moved below) {
    const vec2 u = right.place_px - here.place_px, v = below.place_px - here.place_px;
    const float area = u.x * v.y - u.y * v.x;
    const vec2 low = min(vec2(0), u) + min(vec2(0), v), high = max(vec2(0), u) + max(vec2(0), v);
    if (!(right.valid && below.valid && area > 0 && all(lessThanEqual(high - low, vec2(stereo.gap_px + 2))))) { return; }
    // The neighbours cover their own pixels.
    const ivec2 own = ivec2(floor(here.place_px)), own_right = ivec2(floor(right.place_px)), own_below = ivec2(floor(below.place_px));
    const ivec2 first = ivec2(floor(here.place_px + low)), last = ivec2(floor(here.place_px + high));
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const ivec2 at = ivec2(x, y);
            if (at == own || at == own_right || at == own_below) { continue; }
            const vec2 d = vec2(at) + 0.5 - here.place_px;
            const float s = (d.x * v.y - d.y * v.x) / area, t = (u.x * d.y - u.y * d.x) / area;
            if (s < 0 || t < 0 || s > 1 || t > 1) { continue; }
            put(stereo, at, here.inverse_depth + s * (right.inverse_depth - here.inverse_depth) + t * (below.inverse_depth - here.inverse_depth), 0,
                max(here.spread, max(right.spread, below.spread)));
        }
    }
}

void main() {
    const StereoView stereo = pass.stereo.at[0];
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, stereo.size_px))) { return; }
    const Moved here = moveDominant(stereo, pixel);
    // Too far out to reach the picture even where the surface is stretched.
    const float reach_px = float(stereo.gap_px + 2);
    if (!here.valid || any(lessThan(here.place_px, vec2(-reach_px))) || any(greaterThan(here.place_px, vec2(stereo.size_px) + reach_px))) { return; }
    put(stereo, ivec2(floor(here.place_px)), here.inverse_depth, kLanded, here.spread);
    if (kForward || pixel.x + 1 >= stereo.size_px.x || stereo.gap_px == 0) { return; }
    const Moved right = moveDominant(stereo, pixel + uvec2(1, 0));
    if (kRectified) {
        putBetween(stereo, here, right, int(pixel.y));
    } else if (pixel.y + 1 < stereo.size_px.y) {
        putWithin(stereo, here, right, moveDominant(stereo, pixel + uvec2(0, 1)));
    }
}
