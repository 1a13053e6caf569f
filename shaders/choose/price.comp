// price: computes the price of each tile, which is its expected error per pair, and how much there is to
// render at each price. A thread per tile. Where the gaze is known, only the part of an error that the eye
// sees counts, and tiles in which it cannot tell two rows apart are marked. The last workgroup finds the
// price at which the budget ends, for the first target and for all.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/gaze.glsl"
#include "lib/history_tile.glsl"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { PricePass pass; };
layout(constant_id = 0) const bool kFoveated = false;
layout(constant_id = 1) const
    bool kHistory = false;  // errors are those that the history has left in its tiles
#include "lib/target.glsl"

const uint kBinsPerThread = kPriceBins / kWarpGroup;
// Contrast masks errors. A tile whose colours change by this much from pixel to pixel (root mean square) may
// have an error up to the bound. A tile with less contrast may have proportionally less, but at least this
// part of the bound (4.4 dB): there, an error at an edge is visible even if only one eye has it.
const float kMaskingGradient = 0.05, kUnmaskedBound = 0.6;

// 16 bins per octave, the greatest quotients last: exponent and four bits of the mantissa.
uint binOf(float error_per_pair) {
    return min(max(floatBitsToUint(error_per_pair) >> 19, 104u << 4) - (104u << 4), kNewBin - 1);
}

// What rendering a tile is worth in a picture that is made from a history: its expected squared error, times
// the frames that it has waited. Removing an error that grows with each frame saves the area under its growth
// (a Whittle index), so every tile gets its turn.
uint errorOfHistory(HistoryTile tile) {
    const float squares = 3 * float(kCellSize * kCellSize) * dot(tile.errors, tile.errors);
    return squares > 0 ? max(uint(min(squares * float(max(tile.age, 1)), 2000) * kErrorSteps), 1) : 0;
}

// Adds the error that this frame's warp is expected to cause. Repeated blur adds up by amplitude.
HistoryTile withGrowth(HistoryTile tile) {
    [[unroll]] for (uint q = 0; q < 4; ++q) {
        // The amplitude per pixel and channel.
        const float grown = unseenIn(tile.unseen, q) >= kNewPixels
                                ? kNewError
                                : sqrt(float(tile.grown[q]) / (kErrorSteps * 3 * kCellSize * kCellSize));
        tile.errors[q] += mix(grown, tile.growth[q],
                              kMeasuredShare * float(tile.growth[q] > 0 && grown < kUnseenGrowth ? 1 : 0));
    }
    return tile;
}

// What a coarse tile lacks is an error as soon as the eye would notice it.
HistoryTile withLoss(HistoryTile tile, uvec2 at) {
    const float share = kFoveated ? seenShareThere(TARGET.counters.gaze, at) : 1;
    const bool is_seen = share * 3 * float(kTileSize * kTileSize) * tile.lost * tile.lost >= kLeastSeenError;
    tile.errors += is_seen ? tile.lost : 0;
    return tile;
}

// The amplitude of the error that a tile may have. Contrast masks errors: with less contrast, the error must
// be smaller.
float boundOf(HistoryTile tile) {
    const float gradient = sqrt(float(tile.squared_gradient) / (kErrorSteps * 3 * kTileSize * kTileSize));
    return FIRST.warp.error_bound * clamp(gradient / kMaskingGradient, kUnmaskedBound, 1);
}

// The bin of a tile under a bound, with two bins in one: tiles above the bound come before the others, and
// those that have never been seen come first.
uint binUnderBound(uint bin, HistoryTile tile, float share) {
    uint unseen = 0;
    [[unroll]] for (uint q = 0; q < 4; ++q) { unseen += unseenIn(tile.unseen, q); }
    if (float(unseen) >= kNewShare * kTileSize * kTileSize) { return kNewBin; }
    const bool is_over = any(greaterThan(sqrt(share) * tile.errors, vec4(boundOf(tile))));
    return min((is_over ? kOverBin : 0) + bin / 2, kNewBin - 1);
}

// A tile's price word: the bin of its error, and its cost. Adds the cost to the price list.
uint priceOf(uint tile, uvec2 size_tiles) {
    const uvec2 at = uvec2(tile % size_tiles.x, tile / size_tiles.x);
    Uints errors = Uints(TARGET.tile_errors), costs = Uints(TARGET.tile_costs);
    const uint kind = Uints(TARGET.tile_kinds).at[tile];
    HistoryTile its;
    if (kHistory) {
        HistoryTiles history_tiles = HistoryTiles(TARGET.history_tiles);
        its = withGrowth(history_tiles.at[tile]);
        history_tiles.at[tile].errors = its.errors;
        its = withLoss(its, at);
        errors.at[tile] = kind == kTileHidden ? 0 : errorOfHistory(its);
        const uint cost = kind == kTileHidden ? 0 : min(its.cost, kMaxTileCost - kTilePairs) + kTilePairs;
        costs.at[tile] = cost;
        atomicAdd(FIRST.warp_counters.picture_cost, cost);
    }
    // Sums saturate there (newcomers); resample adds far less than that.
    const uint error = min(errors.at[tile], 0x7fffffffu);
    const float worth = TARGET.area * float(error);
    const float share = kFoveated ? seenShare(TARGET.counters.gaze, at) : 1;
    if (kFoveated && share <= kCoarseShare) { errors.at[tile] = kSeenCoarsely; }
    if (kind != 0 || error == 0) { return 0; }
    const uint cost = costs.at[tile];
    const float seen = share * float(error);
    const bool unnoticed = kFoveated && share < 1 && seen < kLeastSeenError * kErrorSteps;
    const uint bin = binOf(worth / float(cost));
    uint seen_bin = binOf(share * worth / float(cost));
    // The list counts errors as if they were fully seen, so that the required worth of a pair does not fall
    // with what is not seen. A history is different: errors that are neither seen nor rendered grow from
    // frame to frame, and would leave nothing to those that are seen.
    if (kHistory && FIRST.warp.error_bound > 0) { seen_bin = binUnderBound(seen_bin, its, share); }
    const uint listed_bin = kHistory ? seen_bin : bin;
    if (!kHistory || !unnoticed) { atomicAdd(pass.price_bins.at[listed_bin], cost); }
    return unnoticed ? 0 : seen_bin << 22 | (seen_bin < listed_bin ? kSeenInPart : 0) | cost;
}

// Greatest bins first: each thread has kBinsPerThread of them.
void findLastBin(float share, uint picture_cost) {
    const uint first = kPriceBins - 1 - threadIndex() * kBinsPerThread;
    uint costs[kBinsPerThread];
    uint own = 0;
    [[unroll]] for (uint b = 0; b < kBinsPerThread; ++b) {
        costs[b] = pass.price_bins.at[first - b];
        own += costs[b];
    }
    uint total;
    uint before = scanGroup(own, total);
    float wanted = share * float(picture_cost);
    if (kHistory && FIRST.warp.error_bound > 0) {
        uint over;
        scanGroup(first >= kOverBin ? own : 0, over);
        wanted = max(min(wanted, float(over) + kWithinBound * float(picture_cost)),
                     float(pass.price_bins.at[kNewBin]));
        wanted = min(wanted, float(pass.most_cost));
    }
    const uint budget = wanted < 4e9 ? uint(wanted) : 4000000000u;
    [[unroll]] for (uint b = 0; b < kBinsPerThread; ++b) {
        if (before <= budget && before + costs[b] > budget) {
            FIRST.warp_counters.last_bin = first - b;
            FIRST.warp_counters.left_for_last = budget - before;
        }
        before += costs[b];
    }
    if (total <= budget && gl_LocalInvocationIndex == 0) {
        FIRST.warp_counters.last_bin = 0;
        FIRST.warp_counters.left_for_last = 0xffffffffu;
    }
}

void main() [[subgroup_uniform_control_flow]] {
    const uvec2 size_tiles = TARGET.warp.size_tiles;
    const uint tile = gl_WorkGroupID.x * kWarpGroup + gl_LocalInvocationIndex;
    if (tile < size_tiles.x * size_tiles.y) {
        Uints(TARGET.tile_prices).at[tile] = priceOf(tile, size_tiles);
    }
    if (!isLastGroup(pass.chosen)) { return; }
    findLastBin(FIRST.warp.budget,
                kHistory ? atomicOr(FIRST.warp_counters.picture_cost, 0) : FIRST.warp_counters.picture_cost);
}
