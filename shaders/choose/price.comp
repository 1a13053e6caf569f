// price: the price of each tile, which is its expected error per pair, and how much there is to render at each price. A thread per tile. Where
// it is known where the eye looks, only what the eye sees of an error counts, and tiles in which it does not resolve two rows are marked.
// The last workgroup finds the price at which the budget ends.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/gaze.glsl"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { PricePass pass; };
layout(constant_id = 0) const bool kFoveated = false;
layout(constant_id = 1) const bool kPast = false;  // errors are those that the past has left in its tiles

const uint kBinsPerThread = kPriceBins / kWarpGroup;

// 16 bins an octave, the greatest quotients last: exponent and four bits of the mantissa.
uint binOf(float error_per_pair) { return min(max(floatBitsToUint(error_per_pair) >> 19, 104u << 4) - (104u << 4), kPriceBins - 1); }

// What rendering a tile is worth in a picture that is made from a past: its expected squared error, for each frame that it has waited. An
// error that grows by the frame loses its area under that growth when it is mended (an index of Whittle's), and so every tile has its turn.
uint errorOfPast(PastTile tile) {
    const float squares = 3 * float(kCellSize * kCellSize) * dot(tile.errors, tile.errors);
    return squares > 0 ? max(uint(min(squares * float(max(tile.age, 1)), 2000) * kErrorSteps), 1) : 0;
}

// The tile with what this frame's warp is expected to lose. Blur of what is blurred already adds to it as an amplitude.
PastTile withGrowth(PastTile tile) {
    [[unroll]] for (uint q = 0; q < 4; ++q) {
        // An amplitude of a pixel's channel.
        const float grown = sqrt(float(tile.grown[q]) / (kErrorSteps * 3 * kCellSize * kCellSize));
        tile.errors[q] += mix(grown, tile.growth, kMeasuredShare * float(tile.growth > 0 && grown < kUnseenGrowth ? 1 : 0));
    }
    return tile;
}

// Whether later pictures are made from this one, which is none: of such a picture no row is the mean of others, since nothing would say so.
bool leavesTiles() { return !kPast && any(notEqual(uvec2(pass.past_tiles), uvec2(0))); }

// What later pictures must know of a tile that was made from the other eye; rasterize says it of those that are rendered.
void leaveTile(uint tile) {
    PastTile its = PastTile(0, 0, 0, vec4(0), uvec4(0));
    if (pass.tile_kinds.at[tile] != kTileHidden) {
        its.cost = pass.tile_costs.at[tile] - kTilePairs;
        its.errors = vec4(sqrt(max(float(pass.tile_errors.at[tile]) / (kErrorSteps * kTileSize * kTileSize), kLeastGrowth / 3)));
    }
    pass.past_tiles.at[tile] = its;
}

// What a tile's error is worth, and its cost; its cost to the list.
uint priceOf(uint tile, uvec2 size_tiles) {
    if (kPast) {
        const PastTile its = withGrowth(pass.past_tiles.at[tile]);
        pass.past_tiles.at[tile].errors = its.errors;
        const bool hidden = pass.tile_kinds.at[tile] == kTileHidden;
        pass.tile_errors.at[tile] = hidden ? 0 : errorOfPast(its);
        const uint cost = hidden ? 0 : min(its.cost, kMaxTileCost - kTilePairs) + kTilePairs;
        pass.tile_costs.at[tile] = cost;
        atomicAdd(pass.budget.at[0].picture_cost, cost);
    } else if (leavesTiles()) {
        leaveTile(tile);
    }
    // Sums stop growing there (newcomers); resample adds far less than that.
    const uint error = min(pass.tile_errors.at[tile], 0x7fffffffu);
    const float worth = pass.area * float(error);
    const float share = kFoveated ? seenShare(pass.gaze, uvec2(tile % size_tiles.x, tile / size_tiles.x)) : 1;
    if (kFoveated && share <= kCoarseShare && !leavesTiles()) { pass.tile_errors.at[tile] = kSeenCoarsely; }
    if (pass.tile_kinds.at[tile] != 0 || error == 0) { return 0; }
    const uint cost = pass.tile_costs.at[tile];
    const float seen = share * float(error);
    const bool unnoticed = kFoveated && share < 1 && seen < kLeastSeenError * kErrorSteps;
    const uint bin = binOf(worth / float(cost)), seen_bin = binOf(share * worth / float(cost));
    // The list has errors as if all were seen whole, so that what a pair must be worth does not fall with what is not seen. Not so where there
    // is a past: what is not rendered for that grows from frame to frame, and would leave nothing to what is seen.
    const uint listed_bin = kPast ? seen_bin : bin;
    if (!kPast || !unnoticed) { atomicAdd(pass.price_bins.at[listed_bin], cost); }
    return unnoticed ? 0 : seen_bin << 22 | (seen_bin < listed_bin ? kSeenInPart : 0) | cost;
}

// Greatest bins first: a thread holds kBinsPerThread of them.
void findLastBin(uint budget) {
    const uint first = kPriceBins - 1 - threadIndex() * kBinsPerThread;
    uint costs[kBinsPerThread];
    uint own = 0;
    [[unroll]] for (uint b = 0; b < kBinsPerThread; ++b) {
        costs[b] = pass.price_bins.at[first - b];
        own += costs[b];
    }
    uint total;
    uint before = scanGroup(own, total);
    [[unroll]] for (uint b = 0; b < kBinsPerThread; ++b) {
        if (before <= budget && before + costs[b] > budget) {
            pass.budget.at[0].last_bin = first - b;
            pass.budget.at[0].left_for_last = budget - before;
        }
        before += costs[b];
    }
    if (total <= budget && gl_LocalInvocationIndex == 0) {
        pass.budget.at[0].last_bin = 0;
        pass.budget.at[0].left_for_last = 0xffffffffu;
    }
}

void main() {
    const uvec2 size_tiles = pass.warp.at[0].size_tiles;
    const uint tile = gl_WorkGroupID.x * kWarpGroup + gl_LocalInvocationIndex;
    if (tile < size_tiles.x * size_tiles.y) { pass.tile_prices.at[tile] = priceOf(tile, size_tiles); }
    if (!isLastGroup(pass.masked_tiles) || pass.is_last == 0) { return; }
    const float budget = pass.warp.at[0].budget * float(kPast ? atomicOr(pass.budget.at[0].picture_cost, 0) : pass.budget.at[0].picture_cost);
    findLastBin(budget < 4e9 ? uint(budget) : 4000000000u);
}
