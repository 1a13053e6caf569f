// 5, second step: the pairs of the splats that 5_bin listed. A subgroup a splat and a lane a row of tiles.
// Also clears the ranges of tiles for the next pass.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/tile_set.glsl"
#include "lib/tile_mask.glsl"

layout(local_size_x = kBinLargeSize) in;
layout(push_constant, scalar) uniform Push { BinPass pass; };
layout(constant_id = 0) const bool kMasked = false;  // pairs in tiles of the mask alone
layout(constant_id = 1) const uint kSplatKind = kDiscs;  // dimmed or not is all the same here

#include "lib/splat.glsl"
#include "lib/outline.glsl"
#include "lib/pair.glsl"

void main() {
    // Beside that there are threads to spare.
    const uint threads = gl_NumWorkGroups.x * kBinLargeSize, places = pass.size_tiles.x * pass.size_tiles.y + 1;
    for (uint i = gl_GlobalInvocationID.x; i < places; i += threads) { pass.ranges.at[i] = uvec2(0); }

    const uint lanes = laneCount();
    const uint large = pass.counters.at[0].large_splats;
    for (uint i = gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID; i < large; i += gl_NumWorkGroups.x * gl_NumSubgroups) {
        const uint rank = pass.large_splats.at[i];
        const ivec4 box = largeBox(pass.tile_sets.at[rank]);
        const Outline outline = outlineOfProjected(pass.splats.at[rank]);
        uvec2 pairs = pairsFrom(pass.large_begins.at[i], pass.tile_counts.at[rank]);
        for (int first_row = box.y; first_row < box.w; first_row += int(lanes)) {
            const int row = first_row + int(gl_SubgroupInvocationID);
            const ivec2 in_row = row < box.w ? tilesInRow(outline, uint(row), box) : ivec2(0);
            const uint begin = uint(in_row.x), end = uint(max(in_row.x, in_row.y));
            uint tiles = kMasked ? 0 : end - begin;
            if (kMasked) {
                for (uint x = begin; x < end; x = wordEnd(x, end)) { tiles += bitCount(maskBits(pass.tile_mask, pass.size_tiles, row, x, wordEnd(x, end))); }
            }
            uvec2 own = uvec2(pairs.x + subgroupExclusiveAdd(tiles), pairs.y);
            pairs.x += subgroupAdd(tiles);
            if (!kMasked) {
                for (uint x = begin; x < end; ++x) { putPair(own, uvec2(x, row), rank); }
                continue;
            }
            for (uint x = begin; x < end; x = wordEnd(x, end)) {
                for (uint bits = maskBits(pass.tile_mask, pass.size_tiles, row, x, wordEnd(x, end)); bits != 0; bits &= bits - 1) {
                    putPair(own, uvec2(x + findLSB(bits), row), rank);
                }
            }
        }
        // 4_project counted no fewer; should it ever: pairs of no tile are sorted behind all others and blended nowhere.
        for (uint pair = pairs.x + gl_SubgroupInvocationID; pair < pairs.y; pair += lanes) {
            pass.tiles.at[pair] = pass.size_tiles.x * pass.size_tiles.y;
            pass.ranks.at[pair] = rank;
        }
    }
}
