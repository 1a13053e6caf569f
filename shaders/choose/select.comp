// select: the tiles to render, as a list and as a mask: those that earlier passes have marked and, where
// errors are predicted, those with the greatest error per pair, as many as the budget allows. Among equal
// tiles, the first are taken. A thread per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/list.glsl"
#include "lib/tile_mask.glsl"
#include "lib/last_group.glsl"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { SelectPass pass; };
layout(constant_id = 0) const bool kPredicted = false;  // otherwise tile_kinds says which
// All targets share a budget, and a tile that costs more than is left still gets its turn.
layout(constant_id = 1) const bool kHistory = false;
#include "lib/target.glsl"

const uint kTilesPerStep = 8;  // loaded at once, since one load takes as long as all of them

// Where the budget ends (price).
struct End {
    uint bin;
    uint left;  // of the budget, for its tiles
};

// True if the tile may use what is left of the budget in the last bin. A tile that the list counted in a
// higher bin, as if its error were seen whole (price), had its turn there, unless the budget is enough for
// all.
bool isOfLast(uint price, End end) {
    return price != 0 && price >> 22 == end.bin && ((price & kSeenInPart) == 0 || end.left == 0xffffffffu);
}

uint tilesOf(uint target) {
    return pass.targets.at[target].warp.size_tiles.x * pass.targets.at[target].warp.size_tiles.y;
}

// The cost of the last bin's tiles before this workgroup's, starting with those of earlier targets;
// `first_tile` is a multiple of its size.
uint costBefore(uint first_tile, End end) {
    uint own = 0;
    for (uint target = 0; target <= gl_WorkGroupID.z; ++target) {
        Uints tile_prices = Uints(pass.targets.at[target].tile_prices);
        const uint tiles = target < gl_WorkGroupID.z ? tilesOf(target) : first_tile;
        for (uint tile = gl_LocalInvocationIndex; tile < tiles; tile += kTilesPerStep * kWarpGroup) {
            uint prices[kTilesPerStep];
            [[unroll]] for (uint i = 0; i < kTilesPerStep; ++i) {
                prices[i] = tile + i * kWarpGroup < tiles ? tile_prices.at[tile + i * kWarpGroup] : 0;
            }
            [[unroll]] for (uint i = 0; i < kTilesPerStep; ++i) {
                own += isOfLast(prices[i], end) ? prices[i] & kMaxTileCost : 0;
            }
        }
    }
    uint total;
    scanGroup(own, total);
    return total;
}

bool isChosen(uint tile, uint tiles, out bool waits) {
    const End end = End(FIRST.warp_counters.last_bin, FIRST.warp_counters.left_for_last);
    const uint price = tile < tiles ? Uints(TARGET.tile_prices).at[tile] : 0;
    const bool is_last = isOfLast(price, end);
    const uint cost = price & kMaxTileCost;
    uint total;
    uint before = scanGroup(is_last ? cost : 0, total);
    // Most workgroups have no tile of the last bin, and need not know what the others have.
    if (total > 0) { before += costBefore(min(gl_WorkGroupID.x * kWarpGroup, tiles), end); }
    const bool fits = kHistory ? before < end.left : before + cost <= end.left;
    const bool chosen = is_last ? fits : price != 0 && price >> 22 > end.bin;
    waits = !chosen && price >> 22 >= kOverBin;
    return chosen;
}

// The error that the tile is expected to have.
uint squaresOf(uint tile) {
    const vec4 off = HistoryTiles(TARGET.history_tiles).at[tile].errors;
    return uint(min(3 * float(kCellSize * kCellSize) * dot(off, off), kMostSquares) * kSquareSteps + 0.5);
}

void main() [[subgroup_uniform_control_flow]] {
    const uvec2 size_tiles = TARGET.warp.size_tiles;
    const uint tiles = size_tiles.x * size_tiles.y;
    const uint tile = gl_WorkGroupID.x * kWarpGroup + threadIndex();
    bool waits = false;
    uint kind = tile < tiles ? Uints(TARGET.tile_kinds).at[tile] : kTileHidden;
    if (kPredicted && !kHistory && TARGET.warp_counters.moves == 0) {
        kind = kind == 0 ? kTileCheap : kind;
    } else if (kPredicted) {
        kind = isChosen(tile, tiles, waits) ? kTilePredicted : kind;
    }
    const bool selected = kind != 0 && kind != kTileHidden;
    if (kPredicted && selected) { Uints(TARGET.tile_kinds).at[tile] = kind; }

    const uvec4 lanes = subgroupBallot(selected);
    const uint count = subgroupBallotBitCount(lanes);
    const uint cost = kPredicted ? subgroupAdd(selected ? Uints(TARGET.tile_costs).at[tile] : 0) : 0;
    const uint predicted = subgroupAdd(kind == kTilePredicted ? 1 : 0),
               cheap = subgroupAdd(kind == kTileCheap ? 1 : 0);
    const uint edges = subgroupAdd(kind == kTileEdge ? 1 : 0),
               waiting = kHistory ? subgroupAdd(waits ? 1 : 0) : 0;
    if (kHistory && waiting > 0 && subgroupElect()) {
        atomicAdd(TARGET.warp_counters.waiting_tiles, waiting);
    }
    const uint left = kHistory ? subgroupAdd(kind == 0 ? squaresOf(tile) : 0) : 0;
    if (kHistory && left > 0 && subgroupElect()) { atomicAdd(TARGET.warp_counters.left_squares, left); }
    uint place = 0;
    if (subgroupElect() && count > 0) {
        place = atomicAdd(TARGET.chosen_tiles.needed, count);
        if (kPredicted) {
            atomicAdd(TARGET.warp_counters.chosen_cost, cost);
            atomicAdd(TARGET.warp_counters.predicted_tiles, predicted);
            atomicAdd(TARGET.warp_counters.cheap_tiles, cheap);
            atomicAdd(TARGET.warp_counters.edge_tiles, edges);
        }
    }
    place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(lanes);
    if (selected) {
        Uints(TARGET.tile_list).at[place] = tile;
        const uvec2 at = uvec2(tile % size_tiles.x, tile / size_tiles.x);
        atomicOr(Uints(TARGET.tile_mask).at[at.y * maskWords(size_tiles) + at.x / 32], 1u << (at.x & 31));
    }
    if (!isLastGroup(pass.chosen) || gl_LocalInvocationIndex != 0) { return; }
    uint most = 0;
    for (uint target = 0; target < gl_NumWorkGroups.z; ++target) {
        const uint listed = atomicOr(pass.targets.at[target].chosen_tiles.needed, 0),
                   visible = listed > 0 ? pass.visible.at[0].count : 0;
        pass.targets.at[target].chosen_tiles = makeList(listed, tilesOf(target));
        pass.targets.at[target].chosen_visible = makeList(visible, visible);
        most = max(most, listed);
    }
    if (pass.at_once > 1) {
        const DispatchSize size = dispatchOver(most, kGroupSize);
        FIRST.chosen_tiles.per_item = DispatchSize(size.x, size.y, pass.at_once);
    }
}
