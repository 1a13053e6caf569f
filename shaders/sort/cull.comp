// cull: which splats may touch a pixel of any eye. A splat reaches to rho = 2 ln(255 o), so its disc is tested as a whole against
// the planes of the view by its support function, and its low-pass by the projected centre; a 3D Gaussian by its box on the screen.
// The last workgroup writes how long their list is.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/list.glsl"
#include "lib/sums.glsl"

layout(constant_id = 0) const uint kSplatKind = kDiscs;  // dimmed or not is all the same here

#include "lib/splat.glsl"
#include "lib/gaussian.glsl"
#include "lib/eye.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { CullPass pass; };

const uint kBlockWords = kCullBlock / 32;
shared uint visible_words[kBlockWords];
shared uint visible_count;

// How far the disc reaches along `normal`, beyond its centre.
float reachAlong(CameraSplat splat, float radius, vec3 normal) {
    return radius * length(splat.scale * vec2(dot(splat.t_u, normal), dot(splat.t_v, normal)));
}

// Whether any of the disc lies on the side of the plane through the eye that `normal` points to.
bool reachesInside(CameraSplat splat, float radius, vec3 normal) { return dot(splat.centre, normal) + reachAlong(splat, radius, normal) >= 0; }

// Whether a box around the projected centre meets the picture.
bool isOnScreen(CameraSplat splat, EyeView eye, vec2 half_px) {
    const vec2 centre_px = eye.focal_px * splat.centre.xy / splat.centre.z + eye.principal_px;
    return all(greaterThan(centre_px, -half_px)) && all(lessThan(centre_px, vec2(eye.size_px) + half_px));
}

// Comparisons are written so that NaN is not visible.
bool isVisible(CameraSplat splat, EyeView eye) {
    const float cut = cutOf(splat.opacity);
    if (!(cut > 0)) { return false; }
    if (kSplatKind != kDiscs) {
        if (!(splat.centre.z > eye.near)) { return false; }
        const ScreenGaussian g = screenGaussian(splat, eye);
        return isOnScreen(splat, eye, sqrt(cut * vec2(g.xx, g.yy)) + kOutlinePadding);
    }
    const float radius = sqrt(cut);
    if (!(splat.centre.z + reachAlong(splat, radius, vec3(0, 0, 1)) >= eye.near)) { return false; }
    const vec2 to_far_edge = vec2(eye.size_px) - eye.principal_px;
    if (reachesInside(splat, radius, vec3(eye.focal_px.x, 0, eye.principal_px.x)) &&
        reachesInside(splat, radius, vec3(-eye.focal_px.x, 0, to_far_edge.x)) &&
        reachesInside(splat, radius, vec3(0, eye.focal_px.y, eye.principal_px.y)) &&
        reachesInside(splat, radius, vec3(0, -eye.focal_px.y, to_far_edge.y))) {
        return true;
    }
    return splat.centre.z > eye.near && isOnScreen(splat, eye, vec2(sqrt(cut / kLowPass)));
}

void main() {
    const uint group = groupIndex();
    if (gl_LocalInvocationIndex < kBlockWords) { visible_words[gl_LocalInvocationIndex] = 0; }
    if (gl_LocalInvocationIndex == 0) { visible_count = 0; }
    const EyeView first_eye = shareEye(pass.eyes, pass.first_eye);
    const EyeView last_eye = shareEye(pass.eyes, pass.first_eye + pass.eye_count - 1);
    uint in_block = gl_LocalInvocationIndex;
    [[dont_unroll]] do {
        const uint i = group * kCullBlock + in_block;
        if (i >= pass.splat_count) { break; }
        const CameraSplat splat = loadWorldSplat(pass.chunks, placeOfSplat(i, pass.chunk_bits));
        const bool visible = isVisible(cameraFromWorld(first_eye, splat), first_eye) ||
                             (pass.eye_count > 1 && isVisible(cameraFromWorld(last_eye, splat), last_eye));
        if (visible) {
            atomicOr(visible_words[in_block / 32], 1u << (in_block & 31));
            atomicAdd(visible_count, 1);
        }
        in_block += kGroupSize;
    } while (in_block < kCullBlock);
    barrier();
    const uint groups = groupsOver(pass.splat_count, kCullBlock);
    if (group < groups) {  // the last row of a dispatch may have more
        if (gl_LocalInvocationIndex < kBlockWords) {
            pass.visible_bits.at[group * kBlockWords + gl_LocalInvocationIndex] = visible_words[gl_LocalInvocationIndex];
        }
        if (gl_LocalInvocationIndex == 0) { pass.group_counts.at[group] = visible_count; }
    }
    if (isLastGroup(pass.visible)) { sumUp(pass.group_counts, groups, pass.visible, pass.capacity); }
}
