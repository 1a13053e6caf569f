// 8g: the tiles that are rendered again. Where errors are predicted: all that lie outside the dominant eye's view, and the worst of
// the others up to the budget, found by radix selection. In one workgroup, which also lists them and sums the list up.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/list.glsl"
#include "lib/stereo.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { SelectPass pass; };
layout(constant_id = 1) const bool kPredicted = false;  // otherwise tile_kinds says which
layout(constant_id = 2) const bool kHiddenTiles = false;  // parts of the dominant picture were not rendered

shared uint digit_counts[256];
shared uint chosen_digit, left_to_choose;

// Where sums stop growing (8f), the order of threads decides by how much they went beyond.
uint errorOf(uint tile) {
    const uint kind = pass.tile_kinds.at[tile];
    return kind == kTileEdge || kind == kTileHidden ? 0 : min(pass.tile_errors.at[tile], 0x7fffffffu);
}

bool isHiddenAt(StereoView stereo, vec2 place_px) {
    const uvec2 at = uvec2(clamp(place_px, vec2(0), vec2(stereo.size_px) - 1)) / kTileSize;
    const uint tile = at.y * stereo.size_tiles.x + at.x;
    return pass.shown_before.at[tile + 1] == pass.shown_before.at[tile];
}

// Whether a corner of the tile lies outside the dominant picture by more than a gap even if all is infinitely far: so much of a
// headset's eye, whose view is wider outwards than inwards, nothing but rendering can fill, and it would eat up the budget. Likewise
// where the dominant eye's lens hides what it would need, which the paper's borders do not know of.
bool isUnseen(StereoView stereo, uint tile) {
    const uvec2 first = uvec2(tile % stereo.size_tiles.x, tile / stereo.size_tiles.x) * kTileSize;
    const uvec2 last = min(first + kTileSize, stereo.size_px) - 1;
    const vec2 low = vec2(-float(stereo.gap_px)), high = vec2(stereo.size_px) - low;
    bool unseen = false;
    for (uint corner = 0; corner < 4; ++corner) {
        const vec2 at = vec2((corner & 1) == 0 ? first.x : last.x, corner < 2 ? first.y : last.y) + 0.5;
        const vec3 moved = movePixel(stereo.dominant_from_affiliated, at, 0);
        const bool beyond = !(moved.z > 0) || any(lessThan(moved.xy, low)) || any(greaterThan(moved.xy, high));
        unseen = unseen || (kPredicted ? beyond : false) || (kHiddenTiles && !beyond && isHiddenAt(stereo, moved.xy));
    }
    return unseen;
}

// The error that the `wanted`-th worst tile has (1 counts from the worst), and how many tiles of just that error are wanted.
uint findThreshold(uint tiles, uint wanted, out uint of_threshold) {
    const uint thread = threadIndex();
    uint prefix = 0;
    left_to_choose = wanted;
    for (int shift = 24; shift >= 0; shift -= 8) {
        barrier();
        digit_counts[gl_LocalInvocationIndex] = 0;
        barrier();
        for (uint tile = gl_LocalInvocationIndex; tile < tiles; tile += kGroupSize) {
            const uint error = errorOf(tile);
            if (shift == 24 || (error >> (shift + 8)) == (prefix >> (shift + 8))) { atomicAdd(digit_counts[(error >> shift) & 255], 1); }
        }
        barrier();
        // From the greatest digit down: thread t holds digit 255 - t.
        const uint digit = 255 - thread;
        const uint count = digit_counts[digit];
        const uint wanted_here = left_to_choose;
        uint total;
        const uint before = scanGroup(count, total);
        if (before < wanted_here && before + count >= wanted_here) {
            chosen_digit = digit;
            left_to_choose = wanted_here - before;
        }
        barrier();
        prefix |= chosen_digit << shift;
    }
    barrier();
    of_threshold = left_to_choose;
    return prefix;
}

void main() {
    const StereoView stereo = pass.stereo.at[0];
    const uint tiles = stereo.size_tiles.x * stereo.size_tiles.y;
    const uint wanted = min(stereo.budget_tiles, tiles);
    if (kPredicted || kHiddenTiles) {
        for (uint tile = gl_LocalInvocationIndex; tile < tiles; tile += kGroupSize) {
            const uint kind = pass.tile_kinds.at[tile];
            if (kind == kTileHidden || (!kPredicted && kind != 0)) { continue; }
            const bool unseen = isUnseen(stereo, tile);
            pass.tile_kinds.at[tile] = unseen ? kTileEdge : 0;
            if (unseen && !kPredicted) { atomicAdd(pass.counters.at[0].edge_tiles, 1); }
        }
        memoryBarrierBuffer();
        barrier();
    }
    uint of_threshold = 0;
    const uint threshold = kPredicted && wanted > 0 ? findThreshold(tiles, wanted, of_threshold) : 0;

    const uint thread = threadIndex();
    uint listed = 0, at_threshold = 0, unseen = 0;
    for (uint begin = 0; begin < tiles; begin += kGroupSize) {
        const uint tile = begin + thread;
        bool selected = false;
        if (kPredicted) {
            const uint error = tile < tiles ? errorOf(tile) : 0;
            const bool equal = error == threshold && error > 0;
            uint equal_here;
            const uint equal_before = at_threshold + scanGroup(equal ? 1 : 0, equal_here);
            at_threshold += equal_here;
            selected = wanted > 0 && error > 0 && (error > threshold || (equal && equal_before < of_threshold));
            if (selected) { pass.tile_kinds.at[tile] = kTilePredicted; }
            const bool edge = tile < tiles && pass.tile_kinds.at[tile] == kTileEdge;
            uint unseen_here;
            scanGroup(edge ? 1 : 0, unseen_here);
            unseen += unseen_here;
            selected = selected || edge;
        } else {
            const uint kind = tile < tiles ? pass.tile_kinds.at[tile] : 0;
            selected = kind != 0 && kind != kTileHidden;
        }
        uint listed_here;
        const uint place = listed + scanGroup(selected ? 1 : 0, listed_here);
        if (tile < tiles) { pass.tiles_before.at[tile] = place; }
        if (selected) { pass.tile_list.at[place] = tile; }
        listed += listed_here;
    }
    if (gl_LocalInvocationIndex == 0) {
        pass.tiles_before.at[tiles] = listed;
        pass.masked_tiles.at[0] = makeList(listed, tiles);
        const uint visible = listed > 0 ? pass.visible.at[0].count : 0;
        pass.masked_visible.at[0] = makeList(visible, visible);
        if (kPredicted) {
            pass.counters.at[0].predicted_tiles = listed - unseen;
            pass.counters.at[0].edge_tiles = unseen;
        }
    }
}
