// 5: a (tile, splat) pair for each tile a splat meets, front to back. A thread a splat, where the splat's tiles are a bit each; the few
// larger splats are listed for 5_bin_large, so that one over the whole screen stalls nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/tile_set.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { BinPass pass; };
layout(constant_id = 0) const bool kMasked = false;  // pairs in tiles of the mask alone

#include "lib/pair.glsl"

void main() {
    const uint rank = groupIndex() * kGroupSize + gl_LocalInvocationIndex;
    uvec2 pairs = pairsOf(rank);
    bool is_large = false;
    if (pairs.x < pairs.y) {
        const uvec2 tile_set = pass.tile_sets.at[rank];
        is_large = !isSmall(tile_set);
        for (uint bits = smallTiles(tile_set); bits != 0; bits &= bits - 1) { putPair(pairs, tileIndex(tileOfBit(tile_set, findLSB(bits))), rank); }
    }
    const uvec4 large_lanes = subgroupBallot(is_large);
    const uint large = subgroupBallotBitCount(large_lanes);
    if (large == 0) { return; }
    uint place = 0;
    if (subgroupElect()) { place = atomicAdd(pass.counters.at[0].large_splats, large); }
    place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(large_lanes);
    if (is_large) { pass.large_splats.at[place] = rank; }
}
