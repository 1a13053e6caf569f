// project: the visible splats, front to back, as each eye sees them, and how many tiles each touches. The
// last workgroup writes the length of the list of pairs.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/list.glsl"
#include "lib/sums.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { ProjectPass pass; };
// Only tiles of the mask count; splats that touch none cost little.
layout(constant_id = 1) const bool kMasked = false;
layout(constant_id = 2) const uint kSplatKind = kDiscs;
layout(constant_id = 3) const bool kPlaced = false;  // scenes placed among others

#include "lib/splat.glsl"
#include "lib/gaussian.glsl"
#include "lib/eye.glsl"
#include "lib/outline.glsl"
#include "lib/front_part.glsl"
#include "lib/tile_box.glsl"
#include "lib/tile_set.glsl"
#include "lib/tile_mask.glsl"
#include "lib/sh.glsl"
#include "lib/target.glsl"

shared uint group_tiles;

// How many tiles (of the mask, if there is one) the splat touches; `small` has a bit for each if the box is
// small enough.
uint countTiles(Outline outline, ivec4 box, uvec2 size_tiles, out uint small) {
    const bool fits = isSmallBox(box);
    uint tiles = 0;
    small = 0;
    Uints mask = Uints(kMasked ? TARGET.tile_mask : uvec2(0));
    int row = box.y;
    if (row < box.w) {
        [[dont_unroll]] do {
            const ivec2 in_row = tilesInRow(outline, uint(row), box);
            const uint first_bit = kSmallBox * min(row - box.y, kSmallBox - 1);
            if (!kMasked) {
                small |= smallRow(in_row - box.x) << first_bit;
                tiles += max(in_row.y - in_row.x, 0);
            } else {
                uint x = uint(in_row.x);
                const uint end = uint(max(in_row.x, in_row.y));
                if (x < end) {
                    [[dont_unroll]] do {
                        const uint bits = maskBits(mask, size_tiles, row, x, wordEnd(x, end));
                        small |= bits << (x - box.x + first_bit);
                        tiles += bitCount(bits);
                        x = wordEnd(x, end);
                    }
                    while (x < end)
                        ;
                }
            }
            ++row;
        }
        while (row < box.w)
            ;
    }
    return fits ? bitCount(small) : tiles;
}

// Splats of the target.
uint firstSplat() { return gl_WorkGroupID.z * pass.splats_apart; }

// Projects a visible splat for this eye; returns how many tiles it touches.
uint project(uint rank, EyeView eye) {
    const SplatPlace at = placeOfSplat(pass.order.at[rank], pass.chunk_bits);
    const uvec2 size_tiles = eye.size_tiles;

    const CameraSplat in_world = loadWorldSplat(pass.chunks, at);
    const CameraSplat splat = cameraFromWorld(eye, in_world);
    bool has_reference;
    ProjectedSplat p = projectSplat(splat, eye, pass.is_dimmed != 0, has_reference);
    if (has_reference) { placeExactly(p, in_world.centre, eye); }
    const Outline outline = outlineOfProjected(p, eye.low_pass);
    const ivec4 box = tileBox(splat, eye, outline);
    uint small;
    const uint tiles = countTiles(outline, box, size_tiles, small);
    if (tiles > 0) {
        p.colour = uvec2(0, p.colour.y & 0xffff0000u) |
                   packColour(shColour(pass.chunks, at, normalize(fromEye(eye, in_world.centre))));
        pass.splats.at[firstSplat() + rank] = p;
    }
    // If the splat meets no tile, no splat is written either.
    pass.tile_sets.at[firstSplat() + rank] = tiles > 0 ? packTileSet(box, small, tiles) : uvec2(0);
    return tiles;
}

void main() [[subgroup_uniform_control_flow]] {
    const uint count = pass.visible.at[0].count;
    const uint group = groupIndex();
    if (gl_LocalInvocationIndex == 0) { group_tiles = 0; }
    const EyeView eye = shareEye(pass.eyes, gl_WorkGroupID.z);
    uint own_tiles = 0;
    uint rank = group * kListBlock + gl_LocalInvocationIndex;
    const uint end = min((group + 1) * kListBlock, count);
    [[dont_unroll]] do {
        if (rank < end) { own_tiles += project(rank, eye); }
        rank += kGroupSize;
    }
    while (rank < end)
        ;
    const uint subgroup_tiles = subgroupAdd(own_tiles);
    if (subgroupElect()) { atomicAdd(group_tiles, subgroup_tiles); }
    barrier();
    const uint blocks = groupsOver(count, kListBlock);
    if (gl_LocalInvocationIndex == 0 && group < blocks) {
        pass.group_sums.at[gl_WorkGroupID.z * blocks + group] = group_tiles;
        atomicAdd(TARGET.counters.pairs, group_tiles);
    }
    // In one step: with two, the shader takes more registers, which every frame would pay for.
    if (isLastGroup(pass.pairs)) {
        sumUpAtOnce(pass.group_sums, gl_NumWorkGroups.z * blocks, pass.pairs, pass.capacity);
    }
}
