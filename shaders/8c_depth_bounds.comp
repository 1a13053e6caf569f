// 8c: how often each depth occurs in the dominant picture, for the robust extremes that the edge ROIs start from.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/stereo.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform Push { DepthBoundsPass pass; };
layout(constant_id = 1) const bool kReadDepth = false;

shared uint group_bins[kDepthBins];

void main() {
    const uvec2 size_px = pass.stereo.at[0].size_px;
    for (uint bin = gl_LocalInvocationIndex; bin < kDepthBins; bin += 256) { group_bins[bin] = 0; }
    barrier();
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x < size_px.x && pixel.y < size_px.y) {
        const uint i = pixel.y * size_px.x + pixel.x;
        const float alpha = pass.colours.at[i].w;
        if (alpha > 0.5) {
            const float depth = 1 / chosenInverseDepth(pass.stereo.at[0].depth_choice, alpha, kReadDepth ? pass.depths.at[i] : 1.0,
                                                       pass.pixels.at[i].inverse_depth_sum);
            atomicAdd(group_bins[uint(clamp((log2(depth) + 16) * 32, 0, float(kDepthBins - 1)))], 1);
        }
    }
    barrier();
    for (uint bin = gl_LocalInvocationIndex; bin < kDepthBins; bin += 256) {
        if (group_bins[bin] > 0) { atomicAdd(pass.bins.at[bin], group_bins[bin]); }
    }
}
