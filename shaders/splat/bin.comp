// bin: makes a (tile, splat) pair for each tile that a splat touches, front to back. A small splat's tiles
// are one bit each; the few larger splats are listed for bin_large, so that one that covers the whole screen
// does not stall the others.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/tile_set.glsl"
#include "lib/list.glsl"
#include "lib/target.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { BinPass pass; };

#include "lib/pair.glsl"

// Every lane of a workgroup must call it; none returns early, see lib/group.glsl.
void listLarge(bool is_large, uint rank, uint begin, uint first_pair) {
    const uvec4 large_lanes = subgroupBallot(is_large);
    const uint large = subgroupBallotBitCount(large_lanes);
    uint place = 0;
    if (large > 0 && subgroupElect()) { place = atomicAdd(TARGET.counters.large_splats, large); }
    place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(large_lanes);
    if (is_large) {
        pass.large_splats.at[first_pair + place] = rank;
        pass.large_begins.at[first_pair + place] = begin;
    }
}

const uint kPerThread = kListBlock / kGroupSize;

void main() [[subgroup_uniform_control_flow]] {
    const uint splats = pass.visible.at[0].count;
    const uint group = groupIndex();
    const uint first = group * kListBlock + threadIndex() * kPerThread;
    uint counts[kPerThread];
    uint own = 0;
    [[unroll]] for (uint i = 0; i < kPerThread; ++i) {
        counts[i] = first + i < splats ? pass.tile_counts.at[firstSplat() + first + i] : 0;
        own += counts[i];
    }
    uint of_group;
    uint begin = scanGroup(own, of_group);
    if (group * kListBlock < splats) { begin += pairsBefore(group); }
    const uint columns = pass.eyes.at[gl_WorkGroupID.z].size_tiles.x, first_tile = TARGET.first_tile,
               first_pair = pairsBefore(0);
    [[unroll]] for (uint i = 0; i < kPerThread; ++i) {
        const uint rank = first + i;
        uvec2 pairs = pairsFrom(begin, counts[i]);
        bool is_large = false;
        if (pairs.x < pairs.y) {
            const uvec2 tile_set = pass.tile_sets.at[firstSplat() + rank];
            is_large = !isSmall(tile_set);
            uint bits = smallTiles(tile_set);
            if (bits != 0) {
                [[dont_unroll]] do {
                    const uvec2 tile = uvec2(tileOfBit(tile_set, findLSB(bits)));
                    putPair(pairs, first_tile + tile.y * columns + tile.x, rank);
                    bits &= bits - 1;
                }
                while (bits != 0)
                    ;
            }
        }
        listLarge(is_large, rank, begin, first_pair);
        begin += counts[i];
    }
}
