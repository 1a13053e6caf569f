// warp_pixels: the pixels of an eye's picture that warp_history has left out, one thread per pixel.
//
// A place is found backwards, by a fixed-point search (Bowles et al. 2012, Iterative Image Warping): the
// depth at a place says where the place should be. Such a search always finds something, so a place counts
// only if the history's pixel there, moved forwards, hits the pixel that is being made. The search starts
// from the nearest and from the farthest depth around; of the two results, the nearer one counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"

layout(constant_id = 0) const bool kHalfColours = false;
layout(constant_id = 1) const bool kHiddenTiles = false;  // a lens hides parts
layout(constant_id = 2) const bool kByAddress = false;    // lib/history.glsl; for software devices

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { WarpHistoryPass pass; };

#include "lib/tile_mask.glsl"
#include "lib/picture.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/move_pixel.glsl"
#include "lib/history.glsl"
#include "lib/cubic.glsl"
#include "lib/six_taps.glsl"

const uint kBlockPixels = kHistoryColumns * kHistoryRows;

// How wide a pixel of the history is at a place: more than one pixel if the view has turned towards it.
vec2 widthOfPixel(HistoryView view, vec2 wanted_px) {
    const PixelMap map = view.history_from_now;
    const vec3 place = movePixelAnywhere(map, wanted_px, 0);
    const vec2 across = (vec2(1 + map.excess_x.x, map.excess_y.x) - place.xy * map.excess_z.x) / place.z;
    const vec2 down = (vec2(map.excess_x.y, 1 + map.excess_y.y) - place.xy * map.excess_z.y) / place.z;
    return vec2(abs(down.x) + abs(down.y), abs(across.x) + abs(across.y)) /
           abs(across.x * down.y - across.y * down.x);
}

// Searches, from a first guess, for where the history shows what is wanted; true if found.
bool search(HistoryView view, vec2 wanted_px, float guess, vec2 agrees, out Seen seen, out vec2 place_px) {
    float inverse_depth = guess;
    bool found = false, inside = true;
    place_px = wanted_px;
    seen = Seen(0, guess, vec2(0));
    [[unroll]] for (uint step = 0; step < kHistorySteps; ++step) {
        if (!found && inside) {
            const vec3 place = movePixelAnywhere(view.history_from_now, wanted_px, inverse_depth);
            place_px = place.xy;
            inside = place.z > 0 && isInHistory(view, place_px);
            if (inside) {
                seen = look(view, place_px, wanted_px);
                found = seen.word != 0 && all(lessThanEqual(abs(seen.off_px), agrees));
                inverse_depth = seen.inverse_depth;
            }
        }
    }
    if (found) {
        const vec2 exact_px = movePixelAnywhere(view.history_from_now, wanted_px, inverse_depth).xy;
        if (!isHiddenInHistory(view, pixelAt(view.history_size_px, exact_px))) { place_px = exact_px; }
    }
    return found;
}

// The nearest content around a place, as inverse depth in the picture that is being made.
float frontAround(HistoryView view, vec2 place_px) {
    const ivec2 last = ivec2(view.history_size_px) - 1, middle = ivec2(clamp(place_px, vec2(0), vec2(last)));
    uint nearest = 0;
    [[unroll]] for (int y = -kFrontReach; y <= kFrontReach; ++y) {
        [[unroll]] for (int x = -kFrontReach; x <= kFrontReach; ++x) {
            const ivec2 at = clamp(middle + ivec2(x, y), ivec2(0), last);
            nearest = max(nearest, pass.source_words.at[at.y * (last.x + 1) + at.x]);
        }
    }
    if (nearest == 0) { return 0; }
    const float inverse_depth = inverseDepthOf(nearest);
    return inverse_depth / max(moveOfPixel(view.now_from_history, vec2(middle) + 0.5, inverse_depth).z, 1e-6);
}

// With the kernel of whole blocks.
Sample sampleSmoothly(vec2 place_px, ivec2 size, vec2 direction) {
    const vec2 from_first = clamp(place_px, vec2(0.5), vec2(size) - 0.5) - 0.5;
    const ivec2 base = ivec2(floor(from_first));
    float weights_x[kTaps], weights_y[kTaps];
    sixTapWeights(from_first.x - float(base.x), weights_x);
    sixTapWeights(from_first.y - float(base.y), weights_y);
    vec4 sum = vec4(0);
    vec3 across = vec3(0), down = vec3(0), lost_across = vec3(0), lost_down = vec3(0);
    [[unroll]] for (int y = 0; y < int(kTaps); ++y) {
        const int row = clamp(base.y + y - 2, 0, size.y - 1) * size.x;
        vec4 in_row = vec4(0);
        vec3 middle = vec3(0);
        [[unroll]] for (int x = 0; x < int(kTaps); ++x) {
            const vec4 tap = sourceAt(uint(row + clamp(base.x + x - 2, 0, size.x - 1)));
            in_row += weights_x[x] * tap;
            if (x == 2) { middle = tap.rgb; }
            if (y == 2) { lost_across += kFifthDifference[x] * tap.rgb; }
            if (y == 2 && (x == 1 || x == 3)) { across += (x == 1 ? -0.5 : 0.5) * tap.rgb; }
        }
        sum += weights_y[y] * in_row;
        lost_down += kFifthDifference[y] * middle;
        if (y == 1 || y == 3) { down += (y == 1 ? -0.5 : 0.5) * middle; }
    }
    lost_across *= lostShare(from_first.x - float(base.x));
    lost_down *= lostShare(from_first.y - float(base.y));
    return Sample(max(sum, vec4(0)), direction.x * across + direction.y * down,
                  dot(lost_across, lost_across) + dot(lost_down, lost_down),
                  dot(across, across) + dot(down, down));
}

// Makes one pixel; returns its expected squared error, with `unseen` the part of it due to what the history
// did not see.
float makePixel(HistoryView view, uvec2 pixel, vec2 depths, out float unseen, out float squared_gradient) {
    const vec2 wanted_px = vec2(pixel) + 0.5;
    Seen from_near, from_far;
    vec2 near_px, far_px;
    const vec2 disparity_px = disparity(view, wanted_px);
    const bool is_flat =
        max(abs(disparity_px.x), abs(disparity_px.y)) * (depths.y - depths.x) <= kHistorySameDepth;
    const vec2 agrees = kHistoryAgrees * max(vec2(1), widthOfPixel(view, wanted_px));
    const bool near_found = search(view, wanted_px, depths.y, agrees, from_near, near_px);
    const bool far_found = search(view, wanted_px, depths.x, agrees, from_far, far_px);
    const bool takes_near = near_found && (!far_found || from_near.inverse_depth >= from_far.inverse_depth);
    Seen seen = from_far;
    if (takes_near) { seen = from_near; }
    vec2 place_px = takes_near ? near_px : far_px;
    const bool found = near_found || far_found;
    unseen = found ? 0 : seen.word == 0 || !isInHistory(view, place_px) ? kUnseenError : kUncoveredError;
    // A pixel that blends two depths moves with the one in front, so that a silhouette keeps its shape.
    if (found && !is_flat) {
        const vec3 with_front =
            movePixelAnywhere(view.history_from_now, wanted_px, frontAround(view, place_px));
        if (with_front.z > 0 && isInHistory(view, with_front.xy)) {
            const Seen there = look(view, with_front.xy, wanted_px);
            if ((there.word & kSpreadBits) >= kMixedCode) {
                seen = there;
                place_px = with_front.xy;
            }
        }
    }
    const float own = kSpreadWeight * sqrt(varianceShareOf(seen.word)) * seen.inverse_depth;
    vec2 uncertain_px = uncertainMove(disparity_px, own + 0.5 * (depths.y - depths.x));
    // Next to what was hidden, a pixel is copied as it is, misplaced by up to half its width.
    const vec2 middle_px = floor(place_px) + 0.5;
    if (reachesHidden(view, ivec2(middle_px), ivec2(middle_px))) {
        uncertain_px = abs(uncertain_px) + abs(place_px - middle_px);
        place_px = middle_px;
    }
    const ivec2 size = ivec2(view.history_size_px);
    Sample one;
    if (is_flat) {
        one = sampleSmoothly(place_px, size, uncertain_px);
    } else {
        one = sampleAround(place_px, size, uncertain_px);
    }
    putWord(view, pixel, movingPixel(seen.inverse_depth, kLanded, seen.word & kSpreadBits));
    putPixel(view, pixel, one.colour);
    squared_gradient = one.squared_gradient;
    const float amplitude = sqrt(one.lost) + length(one.gradient);
    return min(amplitude * amplitude + unseen, kMaxPixelError);
}

void main() {
    const HistoryView view = pass.view.at[0];
    const uint pixels = pass.block_list.at[0].count * kBlockPixels;
    uint i = gl_WorkGroupID.x * kGroupSize + gl_LocalInvocationIndex;
    if (i >= pixels) { return; }
    [[dont_unroll]] do {
        const HistoryBlock block = pass.blocks.at[i / kBlockPixels];
        const uint in_block = i % kBlockPixels;
        const uvec2 pixel = uvec2(block.place & 0xffffu, block.place >> 16) * kBlock +
                            uvec2(in_block % kBlock.x, in_block / kBlock.x);
        if (all(lessThan(pixel, view.size_px))) {
            float unseen, squared_gradient;
            const float grown = makePixel(view, pixel, block.inverse_depths, unseen, squared_gradient);
            const uvec2 place = pixel / kTileSize, in_tile = pixel % kTileSize / kCellSize;
            const uint tile = place.y * view.size_tiles.x + place.x, quarter = 2 * in_tile.y + in_tile.x;
            atomicAdd(pass.tiles.at[tile].grown[quarter], uint(grown * kErrorSteps));
            atomicAdd(pass.tiles.at[tile].squared_gradient, uint(squared_gradient * kErrorSteps));
            if (unseen > 0) { atomicAdd(pass.tiles.at[tile].unseen, 1u << (8 * quarter)); }
        }
        i += gl_NumWorkGroups.x * kGroupSize;
    }
    while (i < pixels)
        ;
}
