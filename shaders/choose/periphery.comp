// periphery: chooses the resolution of an eye's picture where it does not look. First, which tiles of a half-size picture are needed: those
// where the eye resolves nothing finer than its samples. Then, once that picture exists, which tiles are rendered at the eye's own size:
// the others, and those in which the eye would see what is lost at half the size.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/list.glsl"
#include "lib/tile_mask.glsl"
#include "lib/gaze.glsl"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { PeripheryPass pass; };
layout(constant_id = 0) const bool kOfHalf = false;  // the tiles of the half-size picture; otherwise of the eye's own
layout(constant_id = 1) const bool kHalfColours = false;

#include "lib/picture.glsl"

const uint kGroupTiles = kWarpGroup / kHalfTileRows;
shared uint details[kGroupTiles];

bool isShown(uvec2 size_tiles, uvec2 tile) {
    return all(equal(uvec2(pass.shown_mask), uvec2(0))) || isInMask(pass.shown_mask, size_tiles, tile);
}

// True if the tile lies so far beyond the clear angle that the eye resolves nothing finer there than a half-size sample.
bool isBeyond(uvec2 tile) { return seenShareThere(pass.gaze, tile) <= kCoarseShare; }

// True if a tile of the half-size picture is needed: a tile of the eye's may be made from it, or reads it beyond its own border. A tile of
// 8x8 samples reads two beyond, so that it meets no more than the half-size tile that it lies in and the adjacent ones.
bool isNeeded(uvec2 half_tile, uvec2 size_tiles) {
    bool needed = false;
    [[unroll]] for (int i = 0; i < 16; ++i) {
        const ivec2 tile = 2 * ivec2(half_tile) + ivec2(i % 4, i / 4) - 1;
        const bool inside = all(greaterThanEqual(tile, ivec2(0))) && all(lessThan(tile, ivec2(size_tiles)));
        needed = needed || (inside && isShown(size_tiles, uvec2(tile)) && isBeyond(uvec2(tile)));
    }
    return needed;
}

vec3 sampleAt(ivec2 at, ivec2 last) {
    const ivec2 held = clamp(at, ivec2(0), last);
    return colourAt(pass.colours, pass.half_colours, uint(held.y * (last.x + 1) + held.x)).rgb;
}

// The squared second differences of one row of a tile's samples, in kErrorSteps.
uint detailOfRow(ivec2 at, ivec2 last) {
    if (at.y > last.y) { return 0; }
    vec3 left = sampleAt(at - ivec2(1, 0), last), here = sampleAt(at, last);
    float sum = 0;
    for (uint i = 0; i < kTileSize / 2; ++i) {
        const vec3 right = sampleAt(at + ivec2(1, 0), last);
        const vec3 across = left - 2 * here + right;
        const vec3 down = sampleAt(at - ivec2(0, 1), last) - 2 * here + sampleAt(at + ivec2(0, 1), last);
        sum += at.x <= last.x ? min(dot(across, across) + dot(down, down), kMaxPixelError) : 0;
        left = here;
        here = right;
        ++at.x;
    }
    return uint(sum * kErrorSteps);
}

bool isFromPast() { return any(notEqual(uvec2(pass.tile_kinds), uvec2(0))); }

// Every thread must call it.
void listTile(bool exists, bool chosen, uint tile, uvec2 size_tiles) {
    const uvec4 lanes = subgroupBallot(chosen);
    const uint count = subgroupBallotBitCount(lanes);
    uint place = 0;
    if (subgroupElect() && count > 0) { place = atomicAdd(pass.chosen_tiles.at[0].needed, count); }
    place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(lanes);
    if (isFromPast() && exists) { pass.tile_kinds.at[tile] = chosen ? 0 : kTileHidden; }
    if (chosen) {
        pass.tile_list.at[place] = tile;
        const uvec2 at = uvec2(tile % size_tiles.x, tile / size_tiles.x);
        atomicOr(pass.tile_mask.at[at.y * maskWords(size_tiles) + at.x / 32], 1u << (at.x & 31));
    }
    if (!isLastGroup(pass.chosen_tiles) || gl_LocalInvocationIndex != 0) { return; }
    ListState list = makeList(atomicOr(pass.chosen_tiles.at[0].needed, 0), size_tiles.x * size_tiles.y);
    if (isFromPast()) { list.per_item = dispatchOver(max(list.count, 1), kPastTiles); }  // warp_past, which has more to do than its tiles
    pass.chosen_tiles.at[0] = list;
}

void main() [[subgroup_uniform_control_flow]] {
    const uvec2 size_tiles = (pass.size_px + kTileSize - 1) / kTileSize, half_px = (pass.size_px + 1) / 2;
    if (kOfHalf) {
        const uvec2 half_tiles = (half_px + kTileSize - 1) / kTileSize;
        const uint tile = gl_WorkGroupID.x * kWarpGroup + gl_LocalInvocationIndex;
        const bool exists = tile < half_tiles.x * half_tiles.y;
        listTile(exists, exists && isNeeded(uvec2(tile % half_tiles.x, tile / half_tiles.x), size_tiles), tile, half_tiles);
        return;
    }
    // kHalfTileRows threads per tile.
    const uint in_group = gl_LocalInvocationIndex / kHalfTileRows, row = gl_LocalInvocationIndex % kHalfTileRows;
    const uint tile = gl_WorkGroupID.x * kGroupTiles + in_group;
    const uvec2 at = uvec2(tile % size_tiles.x, tile / size_tiles.x);
    const bool shown = tile < size_tiles.x * size_tiles.y && isShown(size_tiles, at);
    const bool may_be_half = shown && isBeyond(at);
    if (row == 0) { details[in_group] = 0; }
    barrier();
    if (may_be_half) { atomicAdd(details[in_group], detailOfRow(ivec2(at * (kTileSize / 2) + uvec2(0, row)), ivec2(half_px) - 1)); }
    barrier();
    const float lost = kHalfLoss * float(details[in_group]), seen = seenShareThere(pass.gaze, at) * lost;
    if (row == 0 && may_be_half) { pass.tile_losses.at[tile] = uint(lost); }
    listTile(row == 0 && tile < size_tiles.x * size_tiles.y, row == 0 && shown && !(may_be_half && seen < kLeastSeenError * kErrorSteps), tile, size_tiles);
}
