// 1: which splats may touch a pixel of any eye. A splat reaches to rho = 2 ln(255 o), so its disc is tested as a whole against
// the planes of the view by its support function, and its low-pass by the projected centre.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/splat.glsl"
#include "lib/eye.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { CullPass pass; };

shared uint visible_words[kGroupSize / 32];
shared uint visible_count;

// How far the disc reaches along `normal`, beyond its centre.
float reachAlong(CameraSplat splat, float radius, vec3 normal) {
    return radius * length(splat.scale * vec2(dot(splat.t_u, normal), dot(splat.t_v, normal)));
}

// Whether any of the disc lies on the side of the plane through the eye that `normal` points to.
bool reachesInside(CameraSplat splat, float radius, vec3 normal) { return dot(splat.centre, normal) + reachAlong(splat, radius, normal) >= 0; }

// Comparisons are written so that NaN is not visible.
bool isVisible(CameraSplat splat, EyeView eye) {
    const float cut = cutOf(splat.opacity);
    if (!(cut > 0)) { return false; }
    const float radius = sqrt(cut);
    if (!(splat.centre.z + reachAlong(splat, radius, vec3(0, 0, 1)) >= eye.near)) { return false; }
    const vec2 to_far_edge = vec2(eye.size_px) - eye.principal_px;
    if (reachesInside(splat, radius, vec3(eye.focal_px.x, 0, eye.principal_px.x)) &&
        reachesInside(splat, radius, vec3(-eye.focal_px.x, 0, to_far_edge.x)) &&
        reachesInside(splat, radius, vec3(0, eye.focal_px.y, eye.principal_px.y)) &&
        reachesInside(splat, radius, vec3(0, -eye.focal_px.y, to_far_edge.y))) {
        return true;
    }
    const vec2 centre_px = eye.focal_px * splat.centre.xy / splat.centre.z + eye.principal_px;
    const vec2 circle_px = vec2(sqrt(cut / kLowPass));
    return splat.centre.z > eye.near && all(greaterThan(centre_px, -circle_px)) && all(lessThan(centre_px, vec2(eye.size_px) + circle_px));
}

void main() {
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint i = group * kGroupSize + gl_LocalInvocationIndex;
    if (gl_LocalInvocationIndex < kGroupSize / 32) { visible_words[gl_LocalInvocationIndex] = 0; }
    if (gl_LocalInvocationIndex == 0) { visible_count = 0; }
    const EyeView first_eye = shareEye(pass.eyes, pass.first_eye);
    const EyeView last_eye = shareEye(pass.eyes, pass.first_eye + pass.eye_count - 1);
    if (i < pass.splat_count) {
        SceneChunk chunk = pass.chunks.at[i >> pass.chunk_bits];
        const uint in_chunk = i & ((1u << pass.chunk_bits) - 1);
        const CameraSplat splat = loadWorldSplat(chunk, in_chunk);
        const bool visible = isVisible(cameraFromWorld(first_eye, splat), first_eye) ||
                             (pass.eye_count > 1 && isVisible(cameraFromWorld(last_eye, splat), last_eye));
        if (visible) {
            atomicOr(visible_words[gl_LocalInvocationIndex / 32], 1u << (gl_LocalInvocationIndex & 31));
            atomicAdd(visible_count, 1);
        }
    }
    barrier();
    if (group * kGroupSize >= pass.splat_count) { return; }
    if (gl_LocalInvocationIndex < kGroupSize / 32) {
        pass.visible_bits.at[group * (kGroupSize / 32) + gl_LocalInvocationIndex] = visible_words[gl_LocalInvocationIndex];
    }
    if (gl_LocalInvocationIndex == 0) { pass.group_counts.at[group] = visible_count; }
}
