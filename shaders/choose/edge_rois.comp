// edge_rois: the borders of the target that the source does not see (paper, section 3.5, step 1). Samples
// along the edges of the source are moved at the least and the greatest depth; where they land bounds what is
// covered. A thread per tile: every workgroup finds the bounds for itself, which takes less time than another
// dispatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/list.glsl"
#include "lib/tile_mask.glsl"
#include "lib/warp.glsl"
#include "lib/unseen.glsl"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { EdgeRoisPass pass; };

const uint kBinsPerThread = kDepthBins / kWarpGroup;
// One pixel in two hundred may be nearer, and one farther, than the bounds: specks and fringes of mixed depth
// are not surfaces.
const uint kOutliers = 200;

shared float inverse_depth_bounds[2];  // far, near
// Least x and y of all samples; greatest x of the left edge and greatest y of the top edge.
shared vec4 group_low[kWarpGroup];
shared vec4 group_high[kWarpGroup];  // greatest x and y of all; least of the right and of the bottom edge

void findDepthBounds() {
    const uint thread = threadIndex();
    uint own = 0;
    for (uint b = 0; b < kBinsPerThread; ++b) { own += pass.bins.at[thread * kBinsPerThread + b]; }
    uint total;
    uint before = scanGroup(own, total);
    if (gl_LocalInvocationIndex == 0) {
        inverse_depth_bounds[0] = 0;
        inverse_depth_bounds[1] = 0;
    }
    barrier();
    const uint outliers = total / kOutliers;
    for (uint b = 0; b < kBinsPerThread; ++b) {
        const uint bin = thread * kBinsPerThread + b;
        const uint count = pass.bins.at[bin];
        if (count > 0 && before <= outliers && before + count > outliers) {
            inverse_depth_bounds[1] = exp2(16 - float(bin) / 32);
        }
        if (count > 0 && before < total - outliers && before + count >= total - outliers) {
            inverse_depth_bounds[0] = exp2(16 - float(bin + 1) / 32);
        }
        before += count;
    }
    barrier();
}

void sampleEdges(WarpView warp) {
    const vec2 size = vec2(warp.size_px);
    vec4 low = vec4(1e9, 1e9, -1e9, -1e9), high = vec4(-1e9, -1e9, 1e9, 1e9);
    for (uint sample_index = gl_LocalInvocationIndex; sample_index < 8 * warp.edge_samples;
         sample_index += kWarpGroup) {
        const uint edge = (sample_index / 2) & 3;  // left, top, right, bottom
        const float along = (float(sample_index / 8) + 0.5) / float(warp.edge_samples);
        const bool vertical = (edge & 1) == 0;
        const float across = edge < 2 ? 0.5 : -0.5;
        const vec2 pixel_px = vertical ? vec2(edge == 0 ? 0.5 : size.x - 0.5, along * size.y)
                                       : vec2(along * size.x, edge == 1 ? 0.5 : size.y - 0.5);
        const vec3 moved =
            movePixel(warp.target_from_source, pixel_px, inverse_depth_bounds[sample_index & 1]);
        if (!(moved.z > 0)) { continue; }
        // The paper counts pixels from 0 at their centres. Rounded to 2^-14 px, so that an edge that does not
        // move stays at 0.
        const vec2 place = round((moved.xy - 0.5) * 16384.0) / 16384.0;
        low.xy = min(low.xy, place);
        high.xy = max(high.xy, place);
        if (edge == 0) { low.z = max(low.z, place.x); }
        if (edge == 1) { low.w = max(low.w, place.y); }
        if (edge == 2) { high.z = min(high.z, place.x); }
        if (edge == 3) { high.w = min(high.w, place.y); }
    }
    group_low[gl_LocalInvocationIndex] = low;
    group_high[gl_LocalInvocationIndex] = high;
    barrier();
    for (uint reach = kWarpGroup / 2; reach > 0; reach /= 2) {
        if (gl_LocalInvocationIndex < reach) {
            const vec4 other_low = group_low[gl_LocalInvocationIndex + reach],
                       other_high = group_high[gl_LocalInvocationIndex + reach];
            low = vec4(min(low.xy, other_low.xy), max(low.zw, other_low.zw));
            high = vec4(max(high.xy, other_high.xy), min(high.zw, other_high.zw));
            group_low[gl_LocalInvocationIndex] = low;
            group_high[gl_LocalInvocationIndex] = high;
        }
        barrier();
    }
}

void main() [[subgroup_uniform_control_flow]] {
    const WarpView warp = pass.warp.at[0];
    findDepthBounds();
    sampleEdges(warp);
    const vec2 size = vec2(warp.size_px), margin = vec2(warp.margin_px);
    const vec2 first = warp.tight_edges != 0 ? group_low[0].zw : group_low[0].xy;
    const vec2 last = warp.tight_edges != 0 ? group_high[0].zw : group_high[0].xy;
    // left_w, top_h and right_w, bottom_h of the paper.
    const vec2 low_borders =
        mix(vec2(0), clamp(ceil(first) + margin, vec2(0), floor(size / 2)), greaterThan(first, vec2(0)));
    const vec2 high_borders = mix(vec2(0), clamp(size - 1 - floor(last) + margin, vec2(0), floor(size / 2)),
                                  lessThan(last, size - 1));
    const uvec2 low_tiles = (uvec2(low_borders) + kTileSize - 1) / kTileSize;
    const uvec2 high_tiles = (warp.size_px - uvec2(high_borders)) / kTileSize;

    const uint tiles = warp.size_tiles.x * warp.size_tiles.y;
    const uint tile = gl_WorkGroupID.x * kWarpGroup + gl_LocalInvocationIndex;
    bool edge = false;
    if (tile < tiles && pass.tile_kinds.at[tile] != kTileHidden) {
        const uvec2 at = uvec2(tile % warp.size_tiles.x, tile / warp.size_tiles.x);
        const bool beyond =
            (high_borders.x > 0 && at.x >= high_tiles.x) || (high_borders.y > 0 && at.y >= high_tiles.y);
        edge = any(lessThan(at, low_tiles)) || beyond ||
               (isThere(uvec2(pass.shown_mask)) && isUnseen(warp, pass.shown_mask, tile, false));
        pass.tile_kinds.at[tile] = edge ? kTileEdge : 0;
    }
    const uint edge_tiles = subgroupAdd(edge ? 1 : 0);
    if (subgroupElect() && edge_tiles > 0) { atomicAdd(pass.counters.at[0].edge_tiles, edge_tiles); }
    if (gl_WorkGroupID.x == 0 && gl_LocalInvocationIndex == 0) {
        pass.counters.at[0].borders_px = uvec4(low_borders, high_borders);
    }
}
