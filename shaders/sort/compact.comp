// compact: lists the visible splats in the scene's order, so that a stable sort breaks ties by index, with
// the depths of their centres, or their distances from the midpoint between the eyes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/list.glsl"
const uint kSplatKind = kDiscs;  // only the centre is read, whatever the kind
layout(constant_id = 1) const bool kPlaced = false;
#include "lib/splat.glsl"
#include "lib/eye.glsl"

layout(constant_id = 0) const bool kInPages = false;

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { CompactPass pass; };
#include "lib/block.glsl"

const uint kBlockWords = kCullBlock / 32;
shared uint visible_words[kBlockWords];
shared uint visible_before[kBlockWords];  // how many of the block's splats come before each word's

// What splats are ordered by. A distance is the same float for all eyes of the list, since it depends on none
// of them.
float depthOf(EyeView eye, vec3 position) {
    if (pass.by_distance != 0) {
        const vec3 from_middle = fromPlace(pass.middle.position, pass.middle.position_low, position);
        precise const float distance = sqrt(dot(from_middle, from_middle));
        return distance;
    }
    return dot(eye.camera_from_world_z, fromEye(eye, position));
}

// Floats as integers of the same order; centres behind the eye have negative depths.
uint sortableBits(float value) {
    const uint bits = floatBitsToUint(value == 0 ? 0.0 : value);  // -0 is as deep as 0
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

// In kDepthKeyBits, in the same order.
uint keyOf(float depth, float near) {
    const uint bits = sortableBits(depth), first_exact = sortableBits(0.5 * near);
    if (bits < first_exact) { return bits >> kNearKeyShift; }
    const uint above = bits - first_exact, exact = min(above, kExactDepthKeys);
    return (first_exact >> kNearKeyShift) + 1 + exact + (above - exact >> kFarKeyShift);
}

void main() {
    if (pass.visible.at[0].count == 0) { return; }
    const uint group = groupIndex();
    const uint first = firstOfBlock(group);
    const uint own_word = gl_LocalInvocationIndex;
    if (own_word < kBlockWords) {
        visible_words[own_word] =
            first < pass.splat_count ? pass.visible_bits.at[group * kBlockWords + own_word] : 0;
    }
    barrier();
    if (own_word < kBlockWords) {
        uint before = 0;
        for (uint word = 0; word < own_word; ++word) { before += bitCount(visible_words[word]); }
        visible_before[own_word] = before;
    }
    const EyeView eye = shareEye(pass.eyes, pass.order_eye);
    const uint blocks = blockCount(),
               before_block = group < blocks ? sumBefore(pass.group_offsets, group, blocks) : 0;
    uint in_block = gl_LocalInvocationIndex;
    [[dont_unroll]] do {
        const uint bits = visible_words[in_block / 32], bit = 1u << (in_block & 31);
        if ((bits & bit) != 0) {
            const uint place = before_block + visible_before[in_block / 32] + bitCount(bits & (bit - 1));
            const uint i = first + in_block;
            pass.keys.at[place] =
                keyOf(depthOf(eye, positionOf(pass.chunks, placeOfSplat(i, pass.chunk_bits))), eye.near);
            pass.splats.at[place] = i;
        }
        in_block += kGroupSize;
    }
    while (in_block < kCullBlock)
        ;
}
