// 5: a (tile, splat) pair for each tile a splat meets, front to back. A thread a pair: it looks its splat up in the prefix sums
// of the tile counts, so that a splat over the whole screen costs no thread more than another.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/splat.glsl"
#include "lib/outline.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { BinPass pass; };
layout(constant_id = 0) const bool kMasked = false;  // pairs in tiles of the mask alone

shared uint group_splats[2];  // the splats of this group's first and last pair

// The last splat in [first, end) whose pairs begin at or before `pair`.
uint splatOfPair(uint pair, uint first, uint end) {
    while (end - first > 1) {
        const uint middle = first + (end - first) / 2;
        if (pass.pair_offsets.at[middle] <= pair) {
            first = middle;
        } else {
            end = middle;
        }
    }
    return first;
}

void main() {
    const uint splats = pass.visible.at[0].count;
    const uint pairs = pass.pairs.at[0].count;
    const uint first_pair = groupIndex() * kGroupSize;
    if (gl_LocalInvocationIndex < 2 && first_pair < pairs) {
        const uint pair = gl_LocalInvocationIndex == 0 ? first_pair : min(first_pair + kGroupSize, pairs) - 1;
        group_splats[gl_LocalInvocationIndex] = splatOfPair(pair, 0, splats);
    }
    barrier();
    const uint pair = first_pair + gl_LocalInvocationIndex;
    if (pair >= pairs) { return; }
    const uint rank = splatOfPair(pair, group_splats[0], group_splats[1] + 1);
    const uvec2 packed_box = pass.tile_boxes.at[rank];
    const ivec4 box = ivec4(unpackTiles(packed_box.x), unpackTiles(packed_box.y));
    const Outline outline = outlineOfProjected(pass.splats.at[rank]);
    const uvec2 size_tiles = pass.eyes.at[pass.eye].size_tiles;

    uint left = pair - pass.pair_offsets.at[rank];
    uint tile = size_tiles.x * size_tiles.y;  // no tile: sorted behind all others, blended nowhere
    for (int row = box.y; row < box.w; ++row) {
        const ivec2 in_row = tilesInRow(outline, uint(row), box);
        if (in_row.y <= in_row.x) { continue; }
        const uint row_begin = uint(row) * size_tiles.x;
        const uint before = kMasked ? pass.tiles_before.at[row_begin + in_row.x] : row_begin + in_row.x;
        const uint tiles = kMasked ? pass.tiles_before.at[row_begin + in_row.y] - before : uint(in_row.y - in_row.x);
        if (left < tiles) {
            tile = kMasked ? pass.tile_list.at[before + left] : before + left;
            break;
        }
        left -= tiles;
    }
    pass.tiles.at[pair] = tile;
    pass.ranks.at[pair] = rank;
}
