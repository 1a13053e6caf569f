// tile_ranges: finds each tile's pairs, once they are sorted by tile: one thread per tile searches for its
// first pair and for the next tile's. Under a mask, tiles with pairs are listed for rasterize; the others
// become background here, which is cheaper than a workgroup for each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/list.glsl"
#include "lib/last_group.glsl"
#include "lib/gaze.glsl"
#include "lib/target.glsl"
#include "lib/pair_word.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { TileRangesPass pass; };
layout(constant_id = 0) const bool kMasked = false;  // only the tiles of its target's list
layout(constant_id = 1) const bool kHalfColours = false;

#include "lib/picture.glsl"
#include "lib/moving_pixel.glsl"

const uint kTilePixels = kTileSize * kTileSize;

shared uint empty_tiles[kMasked ? kGroupSize : 1];
shared uint empty_count;

// The first pair, from `begin` on, in this tile or a later one.
uint firstPairFrom(uint tile, uint begin) {
    uint end = pass.pairs.at[0].count;
    while (begin < end) {
        const uint middle = begin + (end - begin) / 2;
        if (tileOfPair(pass.tiles.at[middle], pass.rank_bits) < tile) {
            begin = middle + 1;
        } else {
            end = middle;
        }
    }
    return begin;
}

// True if the tile has any pairs.
bool findPairs(uint tile) {
    const uint number = TARGET.first_tile + tile, begin = firstPairFrom(number, 0),
               end = firstPairFrom(number + 1, begin);
    pass.ranges.at[number] = uvec2(begin, end);
    return begin < end;
}

// True if the picture is going to be a history.
bool leavesHistory() { return isThere(TARGET.history_tiles); }

uvec2 sizeTiles() { return pass.eyes.at[gl_WorkGroupID.z].size_tiles; }
uvec2 sizePx() { return pass.eyes.at[gl_WorkGroupID.z].size_px; }

// True if samples of the tile may be enough: the eye does not see it sharply, and it is within the picture.
bool mayBeCoarse(uint tile) {
    const uint columns = sizeTiles().x;
    const uvec2 at = uvec2(tile % columns, tile / columns);
    return all(lessThanEqual((at + 1) * kTileSize, sizePx())) &&
           seenShareThere(TARGET.counters.gaze, at) <= kCoarseShare;
}

// Every thread of the workgroup must call it.
void listFull(bool full, bool coarse, uint tile) {
    const uvec4 lanes = subgroupBallot(full && !coarse);
    uint place = 0;
    if (subgroupElect()) { place = atomicAdd(TARGET.counters.full_tiles, subgroupBallotBitCount(lanes)); }
    place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(lanes);
    if (full && !coarse) { Uints(TARGET.full_tiles).at[place] = tile; }
    const uvec4 coarse_lanes = subgroupBallot(full && coarse);
    if (coarse_lanes == uvec4(0)) { return; }
    if (subgroupElect()) {
        place = atomicAdd(TARGET.counters.coarse_tiles, subgroupBallotBitCount(coarse_lanes));
    }
    place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(coarse_lanes);
    if (full && coarse) { Uints(TARGET.full_tiles).at[sizeTiles().x * sizeTiles().y - 1 - place] = tile; }
}

void clear(uint tile, uint pixel_of_tile) {
    const uint columns = sizeTiles().x;
    const uvec2 pixel = uvec2(tile % columns, tile / columns) * kTileSize +
                        uvec2(pixel_of_tile % kTileSize, pixel_of_tile / kTileSize);
    const uvec2 size_px = sizePx();
    if (any(greaterThanEqual(pixel, size_px))) { return; }
    const uint at = pixel.y * size_px.x + pixel.x;
    putColour(FloatColours(TARGET.colours), HalfColours(TARGET.colours), at, vec4(pass.background, 0));
    if (isThere(TARGET.depths)) { Floats(TARGET.depths).at[at] = 0; }
    if (leavesHistory()) { Uints(TARGET.moving).at[at] = movingPixel(0, kLanded, 0); }
}

void main() [[subgroup_uniform_control_flow]] {
    const uint item = groupIndex() * kGroupSize + threadIndex();
    const uint tiles = sizeTiles().x * sizeTiles().y;
    if (!kMasked) {
        if (item < tiles) { findPairs(item); }
        return;
    }
    if (gl_LocalInvocationIndex == 0) { empty_count = 0; }
    barrier();
    // If the capacity for pairs was not enough, what was made from the history stays.
    const bool is_void = TARGET.is_made != 0 && (pass.pairs.at[0].needed != pass.pairs.at[0].count ||
                                                 pass.visible.at[0].needed != pass.visible.at[0].count);
    const bool of_list = isThere(TARGET.tile_list);
    const bool listed = item < (of_list ? TARGET.chosen_tiles.count : tiles) && !is_void;
    const uint tile = !listed ? 0 : of_list ? Uints(TARGET.tile_list).at[item] : item;
    bool full = false;
    if (listed) {
        full = findPairs(tile);
        if (!full) { empty_tiles[atomicAdd(empty_count, 1)] = tile; }
        if (leavesHistory() && !full) {
            HistoryTiles(TARGET.history_tiles).at[tile] =
                HistoryTile(0, 0, vec4(0), vec4(0), uvec4(0), 0, 0, 0);
        }
    }
    listFull(full, full && TARGET.counters.may_be_coarse != 0 && mayBeCoarse(tile), tile);
    barrier();
    uint cleared = gl_LocalInvocationIndex;
    if (cleared < empty_count * kTilePixels) {
        [[dont_unroll]] do {
            clear(empty_tiles[cleared / kTilePixels], cleared % kTilePixels);
            cleared += kGroupSize;
        }
        while (cleared < empty_count * kTilePixels)
            ;
    }
    if (!isLastGroup(pass.pairs) || gl_LocalInvocationIndex != 0) { return; }
    uint groups = 0;
    for (uint target = 0; target < gl_NumWorkGroups.z; ++target) {
        const uint coarse = atomicOr(pass.targets.at[target].counters.coarse_tiles, 0);
        groups = max(groups, groupsOver(coarse, kCellsPerTile) +
                                 atomicOr(pass.targets.at[target].counters.full_tiles, 0));
    }
    const DispatchSize size = dispatchOver(groups, 1);
    FIRST.counters.per_full_tile = DispatchSize(size.x, size.y, gl_NumWorkGroups.z);
}
