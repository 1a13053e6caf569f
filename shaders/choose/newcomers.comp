// newcomers: splats that the target sees and the source does not. They stand in front of what was reprojected
// and leave no hole, so the picture does not reveal them; here each adds its expected error to the tiles it
// touches.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"

layout(constant_id = 0) const uint kSplatKind = kDiscs;
layout(constant_id = 1) const bool kPlaced = false;

#include "lib/splat.glsl"
#include "lib/gaussian.glsl"
#include "lib/outline.glsl"
#include "lib/front_part.glsl"
#include "lib/tile_box.glsl"
#include "lib/tile_mask.glsl"
#include "lib/tile_set.glsl"
#include "lib/moving_pixel.glsl"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { NewcomersPass pass; };

shared uint unseen_ranks[kNewcomersBlock];
shared uint unseen_count;
// A splat that touches more tiles than this would keep one thread busy for long: it stays in the list, and
// all others leave it.
const uint kLargeTiles = 64;
const uint kDone = 0xffffffffu;
shared uint large_count;

// A tile's sum stops, in steps, at half of what a word holds; a tile that gets there is rendered anyway. One
// splat adds at most the greatest float below it.
const uint kMostSteps = 0x7fffffffu;
const float kMostStepsOfOne = 2147483520.0;

// True if the splat's centre, clamped to the picture, is clearly nearer than what the source sees in the
// middle of its tile; always true in a tile that is rendered.
bool standsInFront(WarpView warp, vec2 pixel_px, float inverse_depth) {
    const uint tile = tileOf(warp.size_tiles, pixelAt(warp.size_px, pixel_px));
    const uint moving = pass.tile_depths.at[tile];
    return pass.tile_kinds.at[tile] != 0 || moving == 0 ||
           inverse_depth > kInFrontRatio * inverseDepthOf(moving);
}

// By exchange, since many threads that each checked before adding could still exceed kMostSteps together.
void addError(uint tile, uint steps) {
    uint seen = atomicOr(pass.tile_errors.at[tile], 0), before;
    do {
        before = seen;
        seen = atomicCompSwap(pass.tile_errors.at[tile], before, min(before + steps, kMostSteps));
    } while (seen != before);
}

// Adds the splat's error to the tiles it touches: by one thread or, for a large splat, by all threads
// `together`, which share its rows.
// False if it is large, so that one thread alone must leave it.
bool addNewcomer(uint rank, EyeView eye, WarpView warp, bool together) {
    const CameraSplat splat =
        loadCameraSplat(pass.chunks, placeOfSplat(pass.order.at[rank], pass.chunk_bits), eye);
    bool has_reference;
    ProjectedSplat p = projectSplat(splat, eye, pass.is_dimmed != 0, has_reference);
    const Outline outline = outlineOfProjected(p, eye.low_pass);
    const ivec4 box = tileBox(splat, eye, outline);
    const uint tiles = uint(max(box.z - box.x, 0) * max(box.w - box.y, 0));
    if (tiles == 0) { return true; }
    const vec2 middle_px = has_reference ? p.reference_px : vec2(box.xy + box.zw) * (0.5 * float(kTileSize));
    if (has_reference && !standsInFront(warp, middle_px, p.inverse_depth)) { return true; }
    if (!together && tiles > kLargeTiles) { return false; }
    if (!together || gl_LocalInvocationIndex == 0) { atomicAdd(pass.counters.at[0].newcomers, 1); }

    // The integral of exp(-rho), the square of what a pixel blends: pi sigma_u sigma_v on the screen, plus
    // that of the low-pass.
    const float jacobian = p.plane_from_pixel.x * abs(p.plane_from_pixel.z);
    const float area_px =
        3.14159265 * (kSplatKind != kDiscs ? 1 / jacobian
                                           : 1 / eye.low_pass + p.inverse_depth * p.inverse_depth / jacobian);
    const float pixels = has_reference ? min(area_px / float(tiles), float(kTileSize * kTileSize))
                                       : float(kTileSize * kTileSize);
    const float error = warp.newcomer_error * exp2(-negativeLog2Opacity(p));  // after dimming, if any
    const uint steps = uint(min(error * error * pixels * kErrorSteps, kMostStepsOfOne));
    const int first = together ? int(gl_LocalInvocationIndex) : 0,
              rows_apart = together ? int(kWarpGroup) : 1;
    for (int row = box.y + first; row < box.w; row += rows_apart) {
        const ivec2 in_row = tilesInRow(outline, uint(row), box);
        for (int x = in_row.x; x < in_row.y; ++x) {
            const uint tile = uint(row) * eye.size_tiles.x + uint(x);
            if (pass.tile_kinds.at[tile] == 0) { addError(tile, steps); }
        }
    }
    return true;
}

// A workgroup examines a block of the visible splats for those that the source does not see; its threads then
// share these few, and after that the rows of each large one.
void main() {
    const uint count = pass.visible.at[0].count;
    const uint begin = groupIndex() * kNewcomersBlock;
    if (gl_LocalInvocationIndex == 0) {
        unseen_count = 0;
        large_count = 0;
    }
    barrier();
    for (uint in_block = gl_LocalInvocationIndex; in_block < kNewcomersBlock; in_block += kWarpGroup) {
        const uint rank = begin + in_block;
        if (rank < count && tileCount(pass.source_sets.at[rank]) == 0) {
            unseen_ranks[atomicAdd(unseen_count, 1)] = rank;
        }
    }
    barrier();
    const EyeView eye = pass.eyes.at[pass.eye];
    const WarpView warp = pass.warp.at[0];
    [[dont_unroll]] for (uint round = 0; round < 2; ++round) {
        const bool together = round == 1;
        const uint end = together && large_count == 0 ? 0 : unseen_count;
        for (uint unseen = together ? 0 : gl_LocalInvocationIndex; unseen < end;
             unseen += together ? 1 : kWarpGroup) {
            const uint rank = unseen_ranks[unseen];
            if (rank == kDone) { continue; }
            if (addNewcomer(rank, eye, warp, together)) {
                if (!together) { unseen_ranks[unseen] = kDone; }
            } else {
                atomicAdd(large_count, 1);
            }
        }
        barrier();
    }
}
