// mark_changed: where parts of the scene came, went or faded, an eye's history has a larger error than that
// of its warp. The quarters of tiles in which they are seen get an error, so that price finds them worth
// rendering. A thread per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { MarkChangedPass pass; };

void main() {
    const uint tile = gl_WorkGroupID.x * kWarpGroup + gl_LocalInvocationIndex;
    if (tile >= pass.size_tiles.x * pass.size_tiles.y) { return; }
    const uvec2 tile_px = kTileSize * uvec2(tile % pass.size_tiles.x, tile / pass.size_tiles.x);
    vec4 more = vec4(0);
    uint i = 0;
    [[dont_unroll]] do {
        const uvec2 begin_px = pass.rects.at[i].begin_px, end_px = pass.rects.at[i].end_px;
        [[unroll]] for (uint q = 0; q < 4; ++q) {
            const uvec2 quarter_px = tile_px + kCellSize * uvec2(q & 1, q >> 1);
            const bool meets =
                all(lessThan(quarter_px, end_px)) && all(lessThan(begin_px, quarter_px + kCellSize));
            more[q] += meets ? pass.rects.at[i].error : 0;
        }
        ++i;
    }
    while (i < pass.count)
        ;
    if (more != vec4(0)) {
        pass.tiles.at[tile].errors = min(pass.tiles.at[tile].errors + more, vec4(kMostChangedError));
    }
}
