// 8h: what each tile's expected error costs to mend, in error a pair, and how much there is of each price. A thread a tile. Where it is
// known where the eye looks, an error counts for what the eye sees of it, and tiles are marked in which it does not resolve two rows.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"

layout(local_size_x = kStereoGroup) in;
layout(push_constant, scalar) uniform Push { PricePass pass; };
layout(constant_id = 0) const bool kFoveated = false;

// 16 bins an octave, the greatest quotients last: exponent and four bits of the mantissa.
uint binOf(float error_per_pair) { return min(max(floatBitsToUint(error_per_pair) >> 19, 104u << 4) - (104u << 4), kPriceBins - 1); }

// The finest cycle that an eye resolves grows linearly with the angle to where it looks (Guenter et al. 2012). A picture has
// cycles of two pixels and longer; of those the eye sees the part that is no finer, along both axes.
float seenShare(uvec2 at) {
    const vec2 middle_px = vec2(at * kTileSize + kTileSize / 2);
    const vec3 direction = vec3((middle_px - pass.gaze.principal_px) / pass.gaze.focal_px, 1);
    const float angle = atan(length(cross(direction, pass.gaze.direction)), dot(direction, pass.gaze.direction));
    const float finest = kFovealCycle + kCyclePerAngle * max(angle - pass.gaze.clear_rad, 0);
    const float share = min(pass.gaze.pixel_cycle / finest, 1);
    return share * share;
}

void main() {
    const uvec2 size_tiles = pass.stereo.at[0].size_tiles;
    const uint tile = gl_WorkGroupID.x * kStereoGroup + gl_LocalInvocationIndex;
    if (tile >= size_tiles.x * size_tiles.y) { return; }
    // Sums stop growing there (8f); 8e adds far less than that.
    const uint error = min(pass.tile_errors.at[tile], 0x7fffffffu);
    const float share = kFoveated ? seenShare(uvec2(tile % size_tiles.x, tile / size_tiles.x)) : 1;
    if (kFoveated && share <= kCoarseShare) { pass.tile_errors.at[tile] = kSeenCoarsely; }
    uint price = 0;
    if (pass.tile_kinds.at[tile] == 0 && error > 0) {
        const uint cost = pass.tile_costs.at[tile];
        const uint bin = binOf(float(error) / float(cost));
        price = bin << 22 | cost;
        // The list is of what errors are worth where they are seen whole: what a pair must be worth does not fall with what is not seen.
        atomicAdd(pass.price_bins.at[bin], cost);
        if (kFoveated) {
            const float seen = share * float(error);
            const bool unnoticed = share < 1 && seen < kLeastSeenError * kErrorSteps;
            const uint seen_bin = binOf(seen / float(cost));
            price = unnoticed ? 0 : seen_bin << 22 | (seen_bin < bin ? kSeenInPart : 0) | cost;
        }
    }
    pass.tile_prices.at[tile] = price;
}
