// weigh: tiles that are cheap to render are not warped. Warping a tile costs about the same whatever it
// shows. Rendering it costs in proportion to its pairs of tile and splat, and the source's ranges show
// roughly how many these are. A thread per tile. The last workgroup decides whether warping pays at all: if
// not, the passes that warp are empty dispatches, every tile is rendered, and nothing is lost. If it did not
// pay in the frame before, the source comes without what warping needs, and the decision is only for the next
// frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/list.glsl"
#include "lib/tile_mask.glsl"
#include "lib/warp.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/unseen.glsl"
#include "lib/last_group.glsl"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { WeighPass pass; };

// True if the source's pixels can be warped.
bool mayMove() { return isThere(uvec2(pass.moving)); }

// The pixel in the middle of a tile, in an even row, since odd ones may have no depths.
uvec2 middleOf(WarpView warp, uint tile) {
    const uvec2 at = uvec2(tile % warp.size_tiles.x, tile / warp.size_tiles.x);
    return min(at * kTileSize + kTileSize / 2, warp.size_px - 1) & uvec2(~0u, ~1u);
}

// Pairs of the source tile from which this pixel comes, assuming the depth that the source sees there.
uint pairsNear(WarpView warp, uvec2 middle, uint moving) {
    const vec2 middle_px = vec2(middle) + 0.5;
    const vec3 moved =
        movePixel(warp.source_from_target, middle_px, moving == 0 ? 0 : inverseDepthOf(moving));
    // NaN stays where it is
    const bool sane = isPositive(moved.z) && isPositive(1e9 - abs(moved.x)) && isPositive(1e9 - abs(moved.y));
    const uvec2 range =
        pass.ranges.at[tileOf(warp.size_tiles, pixelAt(warp.size_px, sane ? moved.xy : middle_px))];
    return range.y - range.x;
}

// True if the warped tiles save more than two costs together: the cost of warping if no tile is warped
// (kMoveSharedPart), and the budget for mending its errors.
// Without depths, it is less certain where tiles come from. To be resumed, warping must then save clearly
// more; otherwise frames would alternate.
bool movingPays(WarpView warp, uint all_saved, uint picture_cost, uint tiles) {
    const uint saved = mayMove() ? all_saved : all_saved - all_saved / kResumePart;
    const float budget = warp.budget * float(picture_cost);
    const uint mending = budget < 4e9 ? uint(budget) : 4000000000u;
    // What is left for the shared part, times kMoveSharedPart, against the cost of warping all tiles: in 64
    // bits.
    uvec2 gain, cost;
    umulExtended(saved - min(saved, mending), kMoveSharedPart, gain.y, gain.x);
    umulExtended(warp.move_cost, tiles, cost.y, cost.x);
    return saved > mending && (gain.y > cost.y || (gain.y == cost.y && gain.x > cost.x));
}

void main() [[subgroup_uniform_control_flow]] {
    const WarpView warp = pass.warp.at[0];
    const uint tiles = warp.size_tiles.x * warp.size_tiles.y;
    const uint tile = gl_WorkGroupID.x * kWarpGroup + gl_LocalInvocationIndex;
    uint cost = 0, saved = 0;
    bool moves = false;
    if (tile < tiles) {
        const bool hidden = pass.kinds_given != 0 && pass.tile_kinds.at[tile] == kTileHidden;
        if (!hidden) {
            const uvec2 middle = middleOf(warp, tile);
            const uint moving = mayMove() ? pass.moving.at[middle.y * warp.row_words + middle.x] : 0;
            const uint pairs =
                mayMove() ? pairsNear(warp, middle, moving) : pass.ranges.at[tile].y - pass.ranges.at[tile].x;
            const bool unseen = isUnseen(warp, pass.shown_mask, tile, true);
            cost = min(pairs, kMaxTileCost - kTilePairs) + kTilePairs;
            moves = !unseen && pairs > warp.move_cost;
            saved = moves ? pairs - warp.move_cost : 0;
            pass.tile_depths.at[tile] = moving;
            pass.tile_kinds.at[tile] = !mayMove() ? kTileCheap : unseen ? kTileEdge : moves ? 0 : kTileCheap;
        }
        pass.tile_costs.at[tile] = cost;
        pass.tile_errors.at[tile] = 0;
    }
    const uint threads = gl_NumWorkGroups.x * kWarpGroup;
    for (uint i = tile; i < maskWords(warp.size_tiles) * warp.size_tiles.y; i += threads) {
        pass.tile_mask.at[i] = 0;
    }
    for (uint i = tile; i < kPriceBins; i += threads) { pass.price_bins.at[i] = 0; }

    const uint group_cost = subgroupAdd(cost), group_saved = subgroupAdd(saved),
               group_moved = subgroupAdd(moves ? 1 : 0), group_shown = subgroupAdd(cost > 0 ? 1 : 0);
    if (subgroupElect()) {
        atomicAdd(pass.counters.at[0].picture_cost, group_cost);
        atomicAdd(pass.counters.at[0].saved_cost, group_saved);
        atomicAdd(pass.counters.at[0].reprojected_tiles, group_moved);
        atomicAdd(pass.counters.at[0].shown_tiles, group_shown);
    }
    if (!isLastGroup(pass.masked_tiles) || gl_LocalInvocationIndex != 0) { return; }
    const uint shown = atomicOr(pass.counters.at[0].shown_tiles, 0),
               all_saved = atomicOr(pass.counters.at[0].saved_cost, 0);
    const uint picture_cost = atomicOr(pass.counters.at[0].picture_cost, 0);
    const DispatchSize rows = DispatchSize((warp.size_px.y + warp.rows_apart - 1) / warp.rows_apart, 1, 1);
    const bool pays = movingPays(warp, all_saved, picture_cost, shown);
    pass.counters.at[0].pays = pays ? 1 : 0;
    if (pays && mayMove()) {
        pass.counters.at[0].moves = 1;
        pass.counters.at[0].per_pixel_block = DispatchSize(warp.size_tiles.x, 2 * warp.size_tiles.y, 1);
        pass.counters.at[0].per_row = rows;
        pass.counters.at[0].per_visible = dispatchOver(pass.visible.at[0].count, kNewcomersBlock);
    } else {
        pass.counters.at[0].moves = 0;
        pass.counters.at[0].reprojected_tiles = 0;
        pass.counters.at[0].per_pixel_block = DispatchSize(0, 0, 0);
        // Hidden tiles become background all the same.
        pass.counters.at[0].per_row = shown < tiles ? rows : DispatchSize(0, 0, 0);
        pass.counters.at[0].per_visible = DispatchSize(0, 0, 0);
    }
    if (!mayMove()) {
        pass.counters.at[0].cheap_tiles = shown;
        pass.counters.at[0].chosen_cost = picture_cost;
        pass.masked_tiles.at[0].count = shown;
    }
}
