// 8a: the dominant eye's pixels go to where the affiliated eye sees them. The greatest inverse depth stays, whatever the order of
// threads; the source's place follows from it again in 9, so that 32-bit atomics suffice (paper, section 3.4, equations 3 to 5).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/stereo.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform Push { ReprojectPass pass; };
layout(constant_id = 1) const bool kReadDepth = false;  // the choice of depth wants D

void main() {
    const uvec2 size_px = pass.stereo.at[0].size_px;
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= size_px.x || pixel.y >= size_px.y) { return; }
    const uint i = pixel.y * size_px.x + pixel.x;
    const float inverse_depth = chosenInverseDepth(pass.stereo.at[0].depth_choice, pass.colours.at[i].w, kReadDepth ? pass.depths.at[i] : 1.0,
                                                   pass.pixels.at[i].inverse_depth_sum);
    const vec3 moved = movePixel(pass.stereo.at[0].affiliated_from_dominant, vec2(pixel) + 0.5, inverse_depth);
    // Written so that NaN goes nowhere.
    if (!(moved.z > 0 && moved.x >= 0 && moved.y >= 0 && moved.x < float(size_px.x) && moved.y < float(size_px.y))) { return; }
    const uvec2 target = min(uvec2(moved.xy), size_px - 1);
    atomicMax(pass.pixels.at[target.y * size_px.x + target.x].nearest, floatBitsToUint(inverse_depth / moved.z) + 1);
}
