// cull: finds the splats that may touch a pixel of any eye. A splat reaches to rho = 2 ln(255 o), so its disc
// is tested as a whole against the planes of the view by its support function, and its low-pass by the
// projected centre; a 3D Gaussian is tested by its box on the screen. The last workgroup writes the length of
// the list.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/list.glsl"
#include "lib/sums.glsl"

layout(constant_id = 0) const uint kSplatKind = kDiscs;
layout(constant_id = 3) const bool kPlaced = false;  // pages of scenes that are placed among others

#include "lib/splat.glsl"
#include "lib/gaussian.glsl"
#include "lib/eye.glsl"
#include "lib/tile_mask.glsl"
#include "lib/sign.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { CullPass pass; };
layout(constant_id = 1) const bool kMasked = false;  // only the tiles of each eye's mask count
layout(constant_id = 2) const bool kInPages = false;
#include "lib/block.glsl"

const uint kBlockWords = kCullBlock / 32;
shared uint visible_words[kBlockWords];
shared uint visible_count;

// How far the disc reaches along `normal`, beyond its centre.
float reachAlong(CameraSplat splat, float radius, vec3 normal) {
    return radius * length(splat.scale * vec2(dot(splat.t_u, normal), dot(splat.t_v, normal)));
}

// True if any of the disc lies on the side of the plane through the eye to which `normal` points.
bool reachesInside(CameraSplat splat, float radius, vec3 normal) {
    return isNotNegative(dot(splat.centre, normal) + reachAlong(splat, radius, normal));
}

// True if a box around the projected centre touches the picture.
bool isOnScreen(CameraSplat splat, EyeView eye, vec2 half_px) {
    const vec2 centre_px = eye.focal_px * splat.centre.xy / splat.centre.z + eye.principal_px;
    const vec2 from_low = centre_px + half_px, to_high = (vec2(eye.size_px) + half_px) - centre_px;
    return isPositive(from_low.x) && isPositive(from_low.y) && isPositive(to_high.x) && isPositive(to_high.y);
}

// True if any tile between two corners, in pixels, belongs to the mask.
bool meetsMask(Uints mask, uvec2 size_tiles, vec2 low_px, vec2 high_px) {
    const vec2 last = vec2(size_tiles) - 1;
    const vec2 first_tile = floor(low_px / float(kTileSize)), last_tile = floor(high_px / float(kTileSize));
    if (any(greaterThan(first_tile, last)) || any(lessThan(last_tile, vec2(0)))) { return false; }
    // Within the picture even if a corner is NaN and says nothing.
    const uvec2 begin = min(uvec2(clamp(first_tile, vec2(0), last)), size_tiles - 1),
                end = min(uvec2(clamp(last_tile, vec2(0), last)), size_tiles - 1) + 1;
    uint row = begin.y, bits = 0;
    [[dont_unroll]] do {
        uint x = begin.x;
        [[dont_unroll]] do {
            bits |= maskBits(mask, size_tiles, row, x, wordEnd(x, end.x));
            x = wordEnd(x, end.x);
        }
        while (x < end.x)
            ;
        ++row;
    }
    while (bits == 0 && row < end.y)
        ;
    return bits != 0;
}

// True if the splat, which is visible, may touch a tile of the mask: by its bounds on the screen, if it lies
// in front of the eye.
bool meetsMask(CameraSplat splat, EyeView eye, Uints mask) {
    const float cut = cutOf(splat.opacity);
    const vec3 c = splat.centre;
    if (kSplatKind != kDiscs) {
        const ScreenGaussian g = screenGaussian(splat, eye);
        const vec2 centre_px = eye.focal_px * c.xy / c.z + eye.principal_px,
                   half_px = sqrt(cut * vec2(g.xx, g.yy)) + kOutlinePadding + 0.5;
        return meetsMask(mask, eye.size_tiles, centre_px - half_px, centre_px + half_px);
    }
    // The ellipse's bounds: the extremes of x/z and y/z over c + a cos t + b sin t.
    const float radius = sqrt(cut);
    const vec3 a = radius * splat.scale.x * splat.t_u, b = radius * splat.scale.y * splat.t_v;
    const float reach_z = length(vec2(a.z, b.z));
    vec2 low_px = vec2(0), high_px = vec2(eye.size_px);
    if (c.z - reach_z > eye.near) {
        const float d = c.z * c.z - reach_z * reach_z;
        const vec2 middle = (c.xy * c.z - (a.xy * a.z + b.xy * b.z)) / d;
        const vec2 square = middle * middle - (c.xy * c.xy - (a.xy * a.xy + b.xy * b.xy)) / d;
        const vec2 half_px = eye.focal_px * sqrt(max(square, vec2(0)));
        const vec2 middle_px = eye.focal_px * middle + eye.principal_px;
        // And the circle of the low-pass around its centre. The root of a difference of squares keeps only
        // half the digits.
        const vec2 rounding_px = 0.5 + 5e-4 * abs(eye.focal_px * middle) + kOutlinePadding;
        const vec2 centre_px = eye.focal_px * c.xy / c.z + eye.principal_px;
        const float circle_px = sqrt(cut / eye.low_pass);
        low_px = min(middle_px - half_px, centre_px - circle_px) - rounding_px;
        high_px = max(middle_px + half_px, centre_px + circle_px) + rounding_px;
    }
    return meetsMask(mask, eye.size_tiles, low_px, high_px);
}

// NaN is not visible.
bool isVisible(CameraSplat splat, EyeView eye) {
    const float cut = cutOf(splat.opacity);
    if (!isPositive(cut)) { return false; }
    if (kSplatKind != kDiscs) {
        if (!isPositive(splat.centre.z - eye.near)) { return false; }
        const ScreenGaussian g = screenGaussian(splat, eye);
        return isOnScreen(splat, eye, sqrt(cut * vec2(g.xx, g.yy)) + kOutlinePadding);
    }
    const float radius = sqrt(cut);
    if (!isNotNegative(splat.centre.z + reachAlong(splat, radius, vec3(0, 0, 1)) - eye.near)) {
        return false;
    }
    const vec2 to_far_edge = vec2(eye.size_px) - eye.principal_px;
    if (reachesInside(splat, radius, vec3(eye.focal_px.x, 0, eye.principal_px.x)) &&
        reachesInside(splat, radius, vec3(-eye.focal_px.x, 0, to_far_edge.x)) &&
        reachesInside(splat, radius, vec3(0, eye.focal_px.y, eye.principal_px.y)) &&
        reachesInside(splat, radius, vec3(0, -eye.focal_px.y, to_far_edge.y))) {
        return true;
    }
    return isPositive(splat.centre.z - eye.near) && isOnScreen(splat, eye, vec2(sqrt(cut / eye.low_pass)));
}

bool isWanted(CameraSplat splat, EyeView eye, Uints mask) {
    return isVisible(splat, eye) && (!kMasked || meetsMask(splat, eye, mask));
}

void main() [[subgroup_uniform_control_flow]] {
    const uint group = groupIndex();
    if (gl_LocalInvocationIndex < kBlockWords) { visible_words[gl_LocalInvocationIndex] = 0; }
    if (gl_LocalInvocationIndex == 0) { visible_count = 0; }
    const EyeView first_eye = shareEye(pass.eyes, pass.first_eye);
    const EyeView last_eye = shareEye(pass.eyes, pass.first_eye + pass.eye_count - 1);
    const uint first = firstOfBlock(group);
    uint in_block = gl_LocalInvocationIndex;
    [[dont_unroll]] do {
        const uint i = first + in_block;
        if (i >= pass.splat_count) { break; }
        const SplatPlace at = placeOfSplat(i, pass.chunk_bits);
        CameraSplat splat = loadUnfadedSplat(pass.chunks, at);
        if (kInPages) { splat.opacity *= pass.chunks.at[at.chunk].fade; }
        const bool visible =
            isWanted(cameraFromWorld(first_eye, splat), first_eye, pass.first_tile_mask) ||
            (pass.eye_count > 1 && isWanted(cameraFromWorld(last_eye, splat), last_eye, pass.last_tile_mask));
        if (visible) {
            atomicOr(visible_words[in_block / 32], 1u << (in_block & 31));
            atomicAdd(visible_count, 1);
        }
        in_block += kGroupSize;
    }
    while (in_block < kCullBlock)
        ;
    barrier();
    const uint groups = blockCount();
    if (group < groups) {  // the last row of a dispatch may have more workgroups
        if (gl_LocalInvocationIndex < kBlockWords) {
            pass.visible_bits.at[group * kBlockWords + gl_LocalInvocationIndex] =
                visible_words[gl_LocalInvocationIndex];
        }
        if (gl_LocalInvocationIndex == 0) { pass.group_counts.at[group] = visible_count; }
    }
    sumUp(pass.group_counts, group, groups, pass.visible, pass.capacity);
    if (group_is_last != 0 && gl_LocalInvocationIndex == 0) { pass.visible.at[0].per_block.z = pass.at_once; }
}
