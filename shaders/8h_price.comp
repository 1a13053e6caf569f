// 8h: what each tile's expected error costs to mend, in error a pair, and how much there is of each price. A thread a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"

layout(local_size_x = kStereoGroup) in;
layout(push_constant, scalar) uniform Push { PricePass pass; };

// 16 bins an octave, the greatest quotients last: exponent and four bits of the mantissa.
uint binOf(float error_per_pair) { return min(max(floatBitsToUint(error_per_pair) >> 19, 104u << 4) - (104u << 4), kPriceBins - 1); }

void main() {
    const uvec2 size_tiles = pass.stereo.at[0].size_tiles;
    const uint tile = gl_WorkGroupID.x * kStereoGroup + gl_LocalInvocationIndex;
    if (tile >= size_tiles.x * size_tiles.y) { return; }
    // Where sums stop growing (8e), the order of threads decides by how much they went beyond.
    const uint error = min(pass.tile_errors.at[tile], 0x7fffffffu);
    uint price = 0;
    if (pass.tile_kinds.at[tile] == 0 && error > 0) {
        const uint cost = pass.tile_costs.at[tile];
        const uint bin = binOf(float(error) / float(cost));
        price = bin << 22 | cost;
        atomicAdd(pass.price_bins.at[bin], cost);
    }
    pass.tile_prices.at[tile] = price;
}
