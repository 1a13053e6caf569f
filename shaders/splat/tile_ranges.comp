// tile_ranges: where each tile's pairs lie, once they are sorted by tile: a thread per tile searches for its first pair and the next
// tile's. Under a mask tiles with pairs are listed for rasterize; others become background here, which takes less than a workgroup each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/list.glsl"
#include "lib/last_group.glsl"
#include "lib/gaze.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { TileRangesPass pass; };
layout(constant_id = 0) const bool kMasked = false;  // only the tiles of pass.tile_list
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
        if (pass.tiles.at[middle] < tile) {
            begin = middle + 1;
        } else {
            end = middle;
        }
    }
    return begin;
}

// True if the tile has any.
bool findPairs(uint tile) {
    const uint begin = firstPairFrom(tile, 0), end = firstPairFrom(tile + 1, begin);
    pass.ranges.at[tile] = uvec2(begin, end);
    return begin < end;
}

// True if the picture is going to be a past.
bool leavesPast() { return isThere(uvec2(pass.past_tiles)); }

uvec2 sizeTiles() { return (pass.size_px + kTileSize - 1) / kTileSize; }

// True if samples of the tile may do: an eye does not see it sharply, and it lies within the picture.
bool mayBeCoarse(uint tile) {
    const uint columns = sizeTiles().x;
    const uvec2 at = uvec2(tile % columns, tile / columns);
    return all(lessThanEqual((at + 1) * kTileSize, pass.size_px)) && seenShareThere(pass.counters.at[0].gaze, at) <= kCoarseShare;
}

// Every thread of the workgroup must call it.
void listFull(bool full, bool coarse, uint tile) {
    const uvec4 lanes = subgroupBallot(full && !coarse);
    uint place = 0;
    if (subgroupElect()) { place = atomicAdd(pass.counters.at[0].full_tiles, subgroupBallotBitCount(lanes)); }
    place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(lanes);
    if (full && !coarse) { pass.full_tiles.at[place] = tile; }
    const uvec4 coarse_lanes = subgroupBallot(full && coarse);
    if (coarse_lanes == uvec4(0)) { return; }
    if (subgroupElect()) { place = atomicAdd(pass.counters.at[0].coarse_tiles, subgroupBallotBitCount(coarse_lanes)); }
    place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(coarse_lanes);
    if (full && coarse) { pass.full_tiles.at[sizeTiles().x * sizeTiles().y - 1 - place] = tile; }
}

void clear(uint tile, uint pixel_of_tile) {
    const uint columns = sizeTiles().x;
    const uvec2 pixel = uvec2(tile % columns, tile / columns) * kTileSize + uvec2(pixel_of_tile % kTileSize, pixel_of_tile / kTileSize);
    if (any(greaterThanEqual(pixel, pass.size_px))) { return; }
    const uint at = pixel.y * pass.size_px.x + pixel.x;
    putColour(pass.colours, HalfColours(uvec2(pass.colours)), at, vec4(pass.background, 0));
    if (isThere(uvec2(pass.depths))) { pass.depths.at[at] = 0; }
    if (leavesPast()) { pass.moving.at[at] = movingPixel(0, kLanded, 0); }
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
    // If pairs had no room, what the past made stays.
    const bool is_void = pass.is_made != 0 && (pass.pairs.at[0].needed != pass.pairs.at[0].count || pass.visible.at[0].needed != pass.visible.at[0].count);
    const bool of_list = isThere(uvec2(pass.tile_list));
    const bool listed = item < (of_list ? pass.masked_tiles.at[0].count : tiles) && !is_void;
    const uint tile = !listed ? 0 : of_list ? pass.tile_list.at[item] : item;
    bool full = false;
    if (listed) {
        full = findPairs(tile);
        if (!full) { empty_tiles[atomicAdd(empty_count, 1)] = tile; }
        if (leavesPast() && !full) { pass.past_tiles.at[tile] = PastTile(0, 0, vec4(0), vec4(0), uvec4(0), 0); }
    }
    listFull(full, full && pass.counters.at[0].may_be_coarse != 0 && mayBeCoarse(tile), tile);
    barrier();
    uint cleared = gl_LocalInvocationIndex;
    if (cleared < empty_count * kTilePixels) {
        [[dont_unroll]] do {
            clear(empty_tiles[cleared / kTilePixels], cleared % kTilePixels);
            cleared += kGroupSize;
        } while (cleared < empty_count * kTilePixels);
    }
    if (!isLastGroup(pass.pairs) || gl_LocalInvocationIndex != 0) { return; }
    const uint coarse_groups = groupsOver(atomicOr(pass.counters.at[0].coarse_tiles, 0), kCellsPerTile);
    pass.counters.at[0].per_full_tile = dispatchOver(coarse_groups + atomicOr(pass.counters.at[0].full_tiles, 0), 1);
}
