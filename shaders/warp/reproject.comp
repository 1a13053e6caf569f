// reproject: moves the source's pixels to where the target sees them (paper, section 3.4, equations 3 to 5).
// If several meet, the one with the greatest inverse depth stays, whatever the order of the threads. resample
// finds the source from it, so 32-bit atomics suffice.
// A surface may be stretched. Pixels that fall between a pixel and its neighbours, at most gap_px apart, are
// interpolated here already, since what lies behind would otherwise show through the cracks. Where colours
// are copied, this is not done: in the paper only pixels move (section 3.1, stage 2), and what they leave
// open is a hole to be filled afterwards (stage 4).
// The paper does not say which pixel a place belongs to: here, the one that contains it. Nor does it say
// which of two surfaces stays (here, the nearer one), or what becomes of pixels without any splat, whose D of
// 0 is no depth (here, they are infinitely far away).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/tile_mask.glsl"
#include "lib/warp.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/unseen.glsl"

layout(local_size_x = 16, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ReprojectPass pass; };
layout(constant_id = 1) const bool kForward = false;  // colours are going to be copied

#include "lib/reproject.glsl"

bool hidesTiles() { return isThere(uvec2(pass.shown_mask)); }
bool copiesColours() { return kForward; }

void put(WarpView warp, ivec2 at, uint arrival) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(warp.size_px)))) { return; }
    atomicMax(pass.arrivals.at[uint(at.y) * warp.row_words + uint(at.x)], arrival);
}

// In any direction: the pixels whose centres lie in the parallelogram between `here`, its right and its lower
// neighbour.
void putWithin(WarpView warp, uvec2 pixel, Moved here, Moved right, Moved below) {
    const vec2 u = vec2(1, 0) + (right.move_px - here.move_px),
               v = vec2(0, 1) + (below.move_px - here.move_px);
    const float area = u.x * v.y - u.y * v.x;
    const vec2 low = min(vec2(0), u) + min(vec2(0), v), high = max(vec2(0), u) + max(vec2(0), v);
    if (!(right.valid && below.valid && area > 0 && all(lessThanEqual(high - low, vec2(warp.gap_px + 2))))) {
        return;
    }
    // The neighbours cover their own pixels.
    const ivec2 own = ivec2(floor(here.place_px)), own_right = ivec2(floor(right.place_px)),
                own_below = ivec2(floor(below.place_px));
    const ivec2 first = ivec2(floor(here.place_px + low)), last = ivec2(floor(here.place_px + high));
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const ivec2 at = ivec2(x, y);
            if (at == own || at == own_right || at == own_below) { continue; }
            const vec2 d = vec2(at - ivec2(pixel)) - here.move_px;
            const float s = (d.x * v.y - d.y * v.x) / area, t = (u.x * d.y - u.y * d.x) / area;
            if (s < 0 || t < 0 || s > 1 || t > 1) { continue; }
            const float inverse_depth = here.inverse_depth + s * (right.inverse_depth - here.inverse_depth) +
                                        t * (below.inverse_depth - here.inverse_depth);
            put(warp, at, movingPixel(inverse_depth, 0, max(here.spread, max(right.spread, below.spread))));
        }
    }
}

void main() {
    const WarpView warp = pass.warp.at[0];
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, warp.size_px)) || (movesEvenRows(warp) && (pixel.y & 1) != 0)) { return; }
    const Moved here = moveSource(warp, pixel);
    if (!here.valid || isOut(warp, here)) { return; }
    putLanded(warp, here);
    if (kForward || pixel.x + 1 >= warp.size_px.x || warp.gap_px == 0) { return; }
    const Moved right = moveSource(warp, pixel + uvec2(1, 0));
    if (kRectified) {
        putBetween(warp, here, right, int(pixel.y));
    } else if (pixel.y + 1 < warp.size_px.y) {
        putWithin(warp, pixel, here, right, moveSource(warp, pixel + uvec2(0, 1)));
    }
}
