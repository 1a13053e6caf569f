// 6: where each tile's pairs lie, once they are sorted by tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { TileRangesPass pass; };

void main() {
    const uint pairs = pass.pairs.at[0].count;
    const uint pair = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kGroupSize + gl_LocalInvocationIndex;
    if (pair >= pairs) { return; }
    const uint tile = pass.tiles.at[pair];
    if (pair == 0 || pass.tiles.at[pair - 1] != tile) { pass.ranges.at[tile].x = pair; }
    if (pair == pairs - 1 || pass.tiles.at[pair + 1] != tile) { pass.ranges.at[tile].y = pair + 1; }
}
