// settle: tiles of a kind that nobody knows are moved, as if nobody had chosen them. A thread a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { SettlePass pass; };

void main() {
    const uint tile = gl_GlobalInvocationID.x;
    if (tile < pass.tile_count && pass.tile_kinds.at[tile] > kTileCheap) { pass.tile_kinds.at[tile] = 0; }
}
