// 5, second step: the pairs of the splats that 5_bin listed. A subgroup a splat and a lane a row of tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/splat.glsl"
#include "lib/outline.glsl"
#include "lib/tile_set.glsl"

layout(local_size_x = kBinLargeSize) in;
layout(push_constant, scalar) uniform Push { BinPass pass; };
layout(constant_id = 0) const bool kMasked = false;  // pairs in tiles of the mask alone

#include "lib/pair.glsl"

void main() {
    const uint lanes = laneCount();
    const uint large = pass.counters.at[0].large_splats;
    for (uint i = gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID; i < large; i += gl_NumWorkGroups.x * gl_NumSubgroups) {
        const uint rank = pass.large_splats.at[i];
        const ivec4 box = largeBox(pass.tile_sets.at[rank]);
        const Outline outline = outlineOfProjected(pass.splats.at[rank]);
        uvec2 pairs = pairsOf(rank);
        for (int first_row = box.y; first_row < box.w; first_row += int(lanes)) {
            const int row = first_row + int(gl_SubgroupInvocationID);
            const ivec2 in_row = row < box.w ? tilesInRow(outline, uint(row), box) : ivec2(0);
            const uint begin = tileIndex(ivec2(in_row.x, row)), end = tileIndex(ivec2(max(in_row.x, in_row.y), row));
            uint tiles = end - begin;
            if (kMasked && tiles > 0) { tiles = pass.tiles_before.at[end] - pass.tiles_before.at[begin]; }
            uvec2 own = uvec2(pairs.x + subgroupExclusiveAdd(tiles), pairs.y);
            for (uint tile = begin; tile < end; ++tile) { putPair(own, tile, rank); }
            pairs.x += subgroupAdd(tiles);
        }
        // 4_project counted no fewer; should it ever: pairs of no tile are sorted behind all others and blended nowhere.
        for (uint pair = pairs.x + gl_SubgroupInvocationID; pair < pairs.y; pair += lanes) {
            pass.tiles.at[pair] = pass.size_tiles.x * pass.size_tiles.y;
            pass.ranks.at[pair] = rank;
        }
    }
}
