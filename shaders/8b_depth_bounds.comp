// 8b: how often each depth occurs in the dominant picture, for the robust extremes that the edge ROIs start from.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/stereo.glsl"
#include "lib/moving_pixel.glsl"

layout(local_size_x = 16, local_size_y = 8) in;
layout(constant_id = 1) const bool kHalfColours = false;

#include "lib/picture.glsl"

layout(push_constant, scalar) uniform Push { DepthBoundsPass pass; };

shared uint group_bins[kDepthBins];

void main() {
    const uvec2 size_px = pass.stereo.at[0].size_px;
    for (uint bin = gl_LocalInvocationIndex; bin < kDepthBins; bin += kStereoGroup) { group_bins[bin] = 0; }
    barrier();
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x < size_px.x && pixel.y < size_px.y) {
        const uint moving = pass.moving.at[pixel.y * pass.stereo.at[0].row_words + pixel.x];
        if (moving != 0 && colourAt(pass.colours, pass.half_colours, pixel.y * size_px.x + pixel.x).w > 0.5) {
            atomicAdd(group_bins[uint(clamp((16 - log2(inverseDepthOf(moving))) * 32, 0, float(kDepthBins - 1)))], 1);
        }
    }
    barrier();
    for (uint bin = gl_LocalInvocationIndex; bin < kDepthBins; bin += kStereoGroup) {
        if (group_bins[bin] > 0) { atomicAdd(pass.bins.at[bin], group_bins[bin]); }
    }
}
