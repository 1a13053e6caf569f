// 2: the visible splats in the scene's order, so that a stable sort breaks ties by index, with the depth of their centres.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/splat.glsl"
#include "lib/eye.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { CompactPass pass; };

// Floats as integers of the same order; depths of centres behind the eye are negative.
uint sortableBits(float value) {
    const uint bits = floatBitsToUint(value == 0 ? 0.0 : value);  // -0 is as deep as 0
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

void main() {
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint i = group * kGroupSize + gl_LocalInvocationIndex;
    const EyeView eye = shareEye(pass.eyes, pass.order_eye);
    if (i >= pass.splat_count || pass.visible.at[0].count == 0) { return; }
    const uint word = i / 32, bit = i & 31;
    const uint bits = pass.visible_bits.at[word];
    if ((bits & (1u << bit)) == 0) { return; }
    uint place = pass.group_offsets.at[group] + bitCount(bits & ((1u << bit) - 1));
    for (uint w = group * (kGroupSize / 32); w < word; ++w) { place += bitCount(pass.visible_bits.at[w]); }

    SceneChunk chunk = pass.chunks.at[i >> pass.chunk_bits];
    const vec3 from_eye = fromEye(eye, chunk.positions.at[i & ((1u << pass.chunk_bits) - 1)]);
    pass.keys.at[place] = sortableBits(dot(eye.camera_from_world_z, from_eye));
    pass.splats.at[place] = i;
}
