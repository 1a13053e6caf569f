// depth_bounds: how often each depth occurs in the source, for the robust extremes from which the edge ROIs
// start. Every other row is enough. A workgroup counts kBoundsTiles tiles side by side before it adds its
// bins to the global ones.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/moving_pixel.glsl"

layout(local_size_x = kWarpGroup) in;
layout(constant_id = 0) const bool kHalfColours = false;

#include "lib/picture.glsl"

layout(push_constant, scalar) uniform Push { DepthBoundsPass pass; };

shared uint group_bins[kDepthBins];

void count(uvec2 pixel, uvec2 size_px, uint row_words) {
    const uint moving = pass.moving.at[pixel.y * row_words + pixel.x];
    if (moving != 0 && colourAt(pass.colours, pass.half_colours, pixel.y * size_px.x + pixel.x).w > 0.5) {
        atomicAdd(group_bins[uint(clamp((16 - log2(inverseDepthOf(moving))) * 32, 0, float(kDepthBins - 1)))],
                  1);
    }
}

void main() {
    const uvec2 size_px = pass.warp.at[0].size_px;
    const uint row_words = pass.warp.at[0].row_words;
    for (uint bin = gl_LocalInvocationIndex; bin < kDepthBins; bin += kWarpGroup) { group_bins[bin] = 0; }
    barrier();
    const uvec2 first = gl_WorkGroupID.xy * uvec2(kBoundsTiles * kTileSize, kTileSize);
    const uvec2 end = min(first + uvec2(kBoundsTiles * kTileSize, kTileSize), size_px);
    for (uint y = first.y; y < end.y; y += 2) {
        for (uint x = first.x + gl_LocalInvocationIndex; x < end.x; x += kWarpGroup) {
            count(uvec2(x, y), size_px, row_words);
        }
    }
    barrier();
    for (uint bin = gl_LocalInvocationIndex; bin < kDepthBins; bin += kWarpGroup) {
        if (group_bins[bin] > 0) { atomicAdd(pass.bins.at[bin], group_bins[bin]); }
    }
}
