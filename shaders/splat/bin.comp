// bin: a (tile, splat) pair for each tile that a splat meets, front to back. A small splat's tiles are one
// bit each. The few larger ones of a workgroup follow, a subgroup for each and a lane for each of its rows.
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

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { BinPass pass; };
layout(constant_id = 0) const uint kSplatKind = kDiscs;

const bool kPlaced = false;  // no splat of the scene is read
#include "lib/splat.glsl"
#include "lib/outline.glsl"
#include "lib/pair.glsl"

// Those of the workgroup's splats, and where the pairs of each begin.
shared uint large_count, large_ranks[kListBlock], large_begins[kListBlock];

void putSmall(uvec2 tile_set, uvec2 pairs, uint rank, uint first_tile, uint columns) {
    uint bits = smallTiles(tile_set);
    if (bits == 0) { return; }
    [[dont_unroll]] do {
        const uvec2 tile = uvec2(tileOfBit(tile_set, findLSB(bits)));
        putPair(pairs, first_tile + tile.y * columns + tile.x, rank);
        bits &= bits - 1;
    }
    while (bits != 0)
        ;
}

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

// The pairs of a large splat. Every lane of a subgroup must call it.
void putLarge(uint rank, uint first_pair, uint lanes) {
    const uint splat = firstSplat() + rank;
    const uvec2 tile_set = pass.tile_sets.at[splat];
    const ivec4 box = largeBox(tile_set);
    const Outline outline =
        outlineOfProjected(pass.splats.at[splat], pass.eyes.at[gl_WorkGroupID.z].low_pass);
    const uvec2 size_tiles = pass.eyes.at[gl_WorkGroupID.z].size_tiles;
    Uints mask = Uints(TARGET.tile_mask);
    uvec2 pairs = pairsFrom(first_pair, tileCount(tile_set));
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
    // project counted no fewer. If it counted more, the rest become pairs of no tile, which are sorted last
    // and never blended.
    for (uint pair = pairs.x + gl_SubgroupInvocationID; pair < pairs.y; pair += lanes) {
        putPairAt(pair, pass.all_tiles, rank);
    }
}

const uint kPerThread = kListBlock / kGroupSize;

void main() [[subgroup_uniform_control_flow]] {
    const uint lanes = laneCount();
    const uint splats = pass.visible.at[0].count;
    const uint group = groupIndex();
    const uint first = group * kListBlock + threadIndex() * kPerThread;
    if (gl_LocalInvocationIndex == 0) { large_count = 0; }
    uvec2 tile_sets[kPerThread];
    uint own = 0;
    [[unroll]] for (uint i = 0; i < kPerThread; ++i) {
        tile_sets[i] = first + i < splats ? pass.tile_sets.at[firstSplat() + first + i] : uvec2(0);
        own += tileCount(tile_sets[i]);
    }
    uint of_group;
    uint begin = scanGroup(own, of_group);  // with barriers
    if (group * kListBlock < splats) { begin += pairsBefore(group); }
    const uint columns = pass.eyes.at[gl_WorkGroupID.z].size_tiles.x, first_tile = TARGET.first_tile;
    [[unroll]] for (uint i = 0; i < kPerThread; ++i) {
        const uvec2 pairs = pairsFrom(begin, tileCount(tile_sets[i]));
        if (pairs.x < pairs.y) {
            if (isSmall(tile_sets[i])) {
                putSmall(tile_sets[i], pairs, first + i, first_tile, columns);
            } else {
                const uint place = atomicAdd(large_count, 1);
                large_ranks[place] = first + i;
                large_begins[place] = begin;
            }
        }
        begin += tileCount(tile_sets[i]);
    }
    barrier();
    for (uint i = gl_SubgroupID; i < large_count; i += gl_NumSubgroups) {
        putLarge(large_ranks[i], large_begins[i], lanes);
    }
}
