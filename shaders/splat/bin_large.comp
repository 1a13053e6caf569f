// bin, second step: the pairs of the splats that bin listed. A subgroup per splat and a lane per row of
// tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/address.glsl"
#include "lib/group.glsl"
#include "lib/tile_set.glsl"
#include "lib/tile_mask.glsl"
#include "lib/list.glsl"
#include "lib/target.glsl"

layout(local_size_x = kBinLargeSize) in;
layout(push_constant, scalar) uniform Push { BinPass pass; };
layout(constant_id = 0) const uint kSplatKind = kDiscs;

const bool kPlaced = false;  // no splat of the scene is read
#include "lib/splat.glsl"
#include "lib/outline.glsl"
#include "lib/pair.glsl"

// Like maskBits; without a mask all tiles count.
uint bitsOf(Uints mask, uvec2 size_tiles, int row, uint begin, uint end) {
    if (isThere(uvec2(mask))) { return maskBits(mask, size_tiles, row, begin, end); }
    return 0xffffffffu >> (32 - (end - begin));
}

// How many of a row's tiles from `begin` to `end` count.
uint countRow(Uints mask, uvec2 size_tiles, int row, uint begin, uint end) {
    uint tiles = 0, x = begin;
    if (x < end) {
        [[dont_unroll]] do {
            tiles += bitCount(bitsOf(mask, size_tiles, row, x, wordEnd(x, end)));
            x = wordEnd(x, end);
        }
        while (x < end)
            ;
    }
    return tiles;
}

void putRow(Uints mask, uvec2 size_tiles, uvec2 pairs, int row, uint begin, uint end, uint rank) {
    const uint first = TARGET.first_tile + uint(row) * size_tiles.x;
    uint x = begin;
    if (x >= end) { return; }
    [[dont_unroll]] do {
        uint bits = bitsOf(mask, size_tiles, row, x, wordEnd(x, end));
        if (bits != 0) {
            [[dont_unroll]] do {
                putPair(pairs, first + x + findLSB(bits), rank);
                bits &= bits - 1;
            }
            while (bits != 0)
                ;
        }
        x = wordEnd(x, end);
    }
    while (x < end)
        ;
}

// The pairs of the splat at place `i` of the list. Every lane of a subgroup must call it.
void putLarge(uint i, uint lanes) {
    const uint rank = pass.large_splats.at[i], splat = firstSplat() + rank;
    const ivec4 box = largeBox(pass.tile_sets.at[splat]);
    const Outline outline =
        outlineOfProjected(pass.splats.at[splat], pass.eyes.at[gl_WorkGroupID.z].low_pass);
    const uvec2 size_tiles = pass.eyes.at[gl_WorkGroupID.z].size_tiles;
    Uints mask = Uints(TARGET.tile_mask);
    uvec2 pairs = pairsFrom(pass.large_begins.at[i], pass.tile_counts.at[splat]);
    int first_row = box.y;
    [[dont_unroll]] do {
        const int row = first_row + int(gl_SubgroupInvocationID);
        const ivec2 in_row = row < box.w ? tilesInRow(outline, uint(row), box) : ivec2(0);
        const uint begin = uint(in_row.x), end = uint(max(in_row.x, in_row.y));
        const uint tiles = countRow(mask, size_tiles, row, begin, end);
        putRow(mask, size_tiles, uvec2(pairs.x + subgroupExclusiveAdd(tiles), pairs.y), row, begin, end,
               rank);
        pairs.x += subgroupAdd(tiles);
        first_row += int(lanes);
    }
    while (first_row < box.w)
        ;
    // project counted at least as many. If it counted more, the rest become pairs of no tile, which are
    // sorted last and never blended.
    for (uint pair = pairs.x + gl_SubgroupInvocationID; pair < pairs.y; pair += lanes) {
        pass.tiles.at[pair] = pass.all_tiles;
        pass.ranks.at[pair] = splat;
    }
}

void main() [[subgroup_uniform_control_flow]] {
    const uint lanes = laneCount();
    const uint large = TARGET.counters.large_splats;
    uint i = gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID;
    if (i >= large) { return; }
    const uint first = pairsBefore(0);
    [[dont_unroll]] do {
        putLarge(first + i, lanes);
        i += gl_NumWorkGroups.x * gl_NumSubgroups;
    }
    while (i < large)
        ;
}
