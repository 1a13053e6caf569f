// rasterize: blends front to back, with a workgroup per tile. A tile's splats are loaded into shared memory a
// batch at a time, each with a bit for every cell of 8x8 pixels that it touches; the threads of a cell (one
// subgroup, if its width allows) then walk only over their own splats. A thread blends several pixels of a
// column, so that what it reads from shared memory serves all of them.
//
// Where an eye does not see sharply, each cell blends a tile of its own as 8x8 samples. The tile is filled
// from these or, if the eye would notice the loss, blended again by the whole workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/gaze.glsl"

layout(constant_id = 0) const uint kThreadsPerCell = 32;  // 8, 16, 32 or 64
layout(constant_id = 1) const bool kDepth = true;         // D is kept
layout(constant_id = 2) const
    bool kMoments = false;  // I and J are, as for a picture that is going to be warped
layout(constant_id = 3) const bool kHalfColours = false;
layout(constant_id = 4) const uint kSplatKind = kDiscs;
layout(local_size_x_id = 5) in;  // kCellsPerTile * kThreadsPerCell
layout(constant_id = 6) const
    bool kEvenRows = false;  // an odd row is going to be warped like the even one above it
layout(constant_id = 7) const bool kMasked = false;   // only the tiles of its target's list
layout(constant_id = 8) const bool kHistory = false;  // the picture is going to be a history
layout(constant_id = 9) const bool kCoarse = false;   // some tiles of the list may be coarse
layout(constant_id = 10) const bool kCut = false;     // splats show only where they are nearer than a mesh

const bool kMeasures = kHistory && kMasked;  // some tiles, for what pixels twice as wide would lose

const bool kPlaced = false;  // no splat of the scene is read
#include "lib/splat.glsl"
#include "lib/outline.glsl"
#include "lib/cells.glsl"
#include "lib/pair_word.glsl"
#include "lib/picture.glsl"
#include "lib/srgb.glsl"

layout(push_constant, scalar) uniform Push { RasterizePass pass; };
#include "lib/target.glsl"

const uint kAllLanes = 0xffffffffu;
const bool kNarrow = kThreadsPerCell <= 16;
const uint kThreads = kCellsPerTile * kThreadsPerCell;
const uint kPixels = kCellSize * kCellSize / kThreadsPerCell;  // of a thread: a column
const float kFar = 3e38;                                       // a rho that is no hit
const float kNoLowPass = 1e30;     // no hit either, but nearer than a hit at no depth (z infinite)
const uint kNoSplat = kBatchSize;  // the slot of a splat of no opacity

shared uint threads_done;
shared uint squares[kCellsPerTile];  // of the differences between what is rendered and what was there before,
                                     // in kErrorSteps; by coarse tile

shared uint frames_waited;  // by a measured tile
bool is_wider = false;      // what is blended is as pixels twice as wide would see it

#include "lib/tile_batch.glsl"
#include "lib/coarse_tile.glsl"

// The sums of the thread's pixels so far.
vec3 colour[kPixels];
float depth[kPixels];
vec2 moments[kPixels];
float mesh_inverse_depth[kPixels];  // of what cuts through the splats
float transmittance[kPixels];       // negated once the pixel takes no more light
bool any_open;

bool isOfSurface() { return kHalfColours && !kMoments && pass.keeps_surface != 0; }
float depthSum(uint p, float alpha) { return isOfSurface() ? alpha * depth[p] : depth[p]; }

// The numbers of a batch's splat.
struct BatchSplat {
    vec4 reference, plane, depth_form;
    vec3 colour;
};

BatchSplat splatAt(uint slot) {
    return BatchSplat(batch_reference[slot], batch_plane[slot], batch_depth[slot],
                      unpackColour(batch_colour[slot]));
}

BatchSplat splatOf(BatchSplat own, uint lane) {
    return BatchSplat(subgroupShuffle(own.reference, lane), subgroupShuffle(own.plane, lane),
                      subgroupShuffle(own.depth_form, lane), subgroupShuffle(own.colour, lane));
}

// `first_px`: the middle of the thread's first pixel, relative to the tile; the others lie `apart` below each
// other.
void blend(BatchSplat splat, vec2 first_px, float apart, uint max_inverse_depth_bits) {
    const vec4 reference = splat.reference, plane = splat.plane, depth_form = splat.depth_form;
    const vec2 d = first_px - reference.xy;
    const float u = reference.z + plane.x * d.x;
    const float q = depth_form.x + depth_form.y * d.x;
    // Without a low-pass 1/z may be 0, here and at the reference, and no weight may be multiplied by an
    // infinite z, not even 0.
    const bool low_pass = kSplatKind != kDiscs || plane.w > 0;
    const float rho2_x = low_pass ? plane.w * (d.x * d.x) : kNoLowPass;
    const float centre_z = low_pass ? 1 / depth_form.x : 0;
    float most_open = 0;
    // Without branches: pixels that the splat does not reach blend it with weight 0.
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        const float dy = d.y + (kCoarse ? float(p) * apart : float(p));
        const float u_p = u + plane.y * dy;
        const float v_p = reference.w + plane.z * dy;
        float q_p = q + depth_form.z * dy;
        if (kSplatKind != kDiscs) {
            q_p = clamp(q_p, depth_form.x / kDepthReach, depth_form.x * kDepthReach);
        }
        // A hit beyond the near plane has 0 < 1/z <= 1/near. As bits, negative values and NaN are above that.
        const float z = 1 / q_p;
        const float square = u_p * u_p + v_p * v_p;
        const float rho3 = floatBitsToUint(q_p) <= max_inverse_depth_bits ? square * (z * z) : kFar;
        const float rho2 = rho2_x + plane.w * (dy * dy);
        const bool on_disc = kSplatKind == kDiscs && rho3 <= rho2;
        const float exponent = depth_form.w + (kSplatKind != kDiscs ? square : on_disc ? rho3 : rho2);
        const float opacity = exp2(-exponent);
        const float alpha = min(kMaxAlpha, opacity);
        const float inverse_z = kSplatKind != kDiscs || on_disc ? q_p : depth_form.x;
        const bool shows = exponent <= kLog2Of255 && (!kCut || inverse_z > mesh_inverse_depth[p]);
        const float full_weight = shows ? alpha * max(transmittance[p], 0) : 0;
        const float after =
            full_weight > 0 ? transmittance[p] * max(1 - opacity, kMinPassing) : transmittance[p];
        const bool closes = after < kMinTransmittance && after >= 0;
        const float weight = closes ? 0 : full_weight;
        const bool is_half = transmittance[p] > 0.5 && after <= 0.5;
        transmittance[p] = closes ? -transmittance[p] : after;
        most_open = max(most_open, transmittance[p]);
        colour[p] += weight * splat.colour;
        if (kDepth) {
            const float splat_z = kSplatKind != kDiscs || on_disc ? z : centre_z;
            depth[p] = !isOfSurface() ? depth[p] + weight * splat_z : is_half ? splat_z : depth[p];
        }
        if (kMoments && (!kEvenRows || (p & 1) == 0)) {
            const float weighted = weight * inverse_z;
            moments[p].x += weighted;
            moments[p].y += weighted * inverse_z;
        }
    }
    any_open = most_open > 0;
}

// Blends the splats of the batch that touch the cell, in one loop: with a loop over bits inside one over
// words, NVIDIA's compilers use a fifth more registers, and every pixel's sums would be carried through both.
// A word without bits blends the splat without opacity.
void blendBatch(uint first_slot, uint end_slot, uint cell, vec2 first_px, float apart,
                uint max_inverse_depth_bits) {
    uint bits = cell_splats[cell][0];
    uvec3 next = uvec3(cell_splats[cell][1], cell_splats[cell][2], cell_splats[cell][3]);
    [[dont_unroll]] do {
        const uint slot = bits != 0 ? first_slot + uint(findLSB(bits)) : kNoSplat;
        blend(splatAt(slot), first_px, apart, max_inverse_depth_bits);
        bits &= bits - 1;
        if (bits == 0) {
            bits = next.x;
            next = uvec3(next.yz, 0);
            first_slot += 32;
        }
    }
    while (any_open && first_slot < end_slot)
        ;
}

// The same for cells whose threads are a few narrow subgroups. Each lane reads one of the next splats, and
// the others get it from there: such devices load from shared memory lane by lane, even if all lanes want the
// same.
void blendBatchByLanes(uint lanes, uint first_slot, uint end_slot, uint cell, vec2 first_px, float apart,
                       uint max_inverse_depth_bits) {
    uint bits = cell_splats[cell][0];
    uvec3 next = uvec3(cell_splats[cell][1], cell_splats[cell][2], cell_splats[cell][3]);
    [[dont_unroll]] do {
        uint own_bits = bits;
        [[unroll]] for (uint lane = 1; lane < kThreadsPerCell; ++lane) {
            own_bits &= lane <= gl_SubgroupInvocationID ? own_bits - 1 : kAllLanes;
        }
        const BatchSplat own = splatAt(own_bits != 0 ? first_slot + uint(findLSB(own_bits)) : kNoSplat);
        const uint splats = min(uint(bitCount(bits)), lanes);
        uint lane = 0;
        [[dont_unroll]] do {
            blend(splatOf(own, lane), first_px, apart, max_inverse_depth_bits);
            ++lane;
        }
        while (lane < splats)
            ;
        bits = subgroupShuffle(own_bits & (own_bits - 1), lanes - 1);
        if (bits == 0) {
            bits = next.x;
            next = uvec3(next.yz, 0);
            first_slot += 32;
        }
    }
    while (first_slot < end_slot && subgroupAny(any_open))
        ;
}

// The pixel in the form in which it will be warped: at the depth that stands for it, infinitely far away if
// nothing was blended.
uint toMove(float alpha, float depth_sum, vec2 inverse_depth_sums) {
    const float mean = inverse_depth_sums.x / alpha;
    const float inverse_depth = !isPositive(alpha)                              ? 0
                                : !kDepth || pass.depth_choice == kDepthInverse ? mean
                                : pass.depth_choice == kDepthMean               ? alpha / depth_sum
                                                                                : 1 / depth_sum;
    if (floatBitsToUint(inverse_depth) >= floatBitsToUint(1e30)) {
        return 0;
    }  // neither are negative ones and NaN less
    const float variance = max(inverse_depth_sums.y / alpha - mean * mean, 0);
    return movingPixel(inverse_depth, kLanded, spreadCode(variance / (inverse_depth * inverse_depth)));
}

#include "lib/leave_tile.glsl"

// Blends the tile or, if tiles are coarse, each cell its own, into the sums of the thread's pixels.
// `first_px`: the first of these.
void blendTile(uint lanes, uvec2 range, uvec2 tile_px, vec2 first_px, bool is_coarse) {
    const float apart = is_coarse ? kSamplesApart : 1;
    const uint max_inverse_depth_bits = floatBitsToUint(pass.eyes.at[gl_WorkGroupID.z].max_inverse_depth);
    const uvec2 size_px = pass.eyes.at[gl_WorkGroupID.z].size_px;
    any_open = false;
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        colour[p] = vec3(0);
        depth[p] = 0;
        moments[p] = vec2(0);
        const bool inside =
            tile_px.x + uint(first_px.x) < size_px.x && tile_px.y + uint(first_px.y) + p < size_px.y;
        const bool open = is_coarse ? range.x < range.y : inside;
        transmittance[p] = open ? 1 : -1;
        any_open = any_open || open;
        if (kCut) {
            const uint at = (tile_px.y + uint(first_px.y) + p) * size_px.x + tile_px.x + uint(first_px.x);
            mesh_inverse_depth[p] =
                inside ? (Floats(TARGET.mesh_depths).at[at] - TARGET.depth_offset) / TARGET.depth_scale : 0;
        }
    }
    if (kCoarse) { barrier(); }  // of the tile before
    if (gl_LocalInvocationIndex == 0) {
        threads_done = 0;
        if (kCoarse) { most_pairs = 0; }
        batch_reference[kNoSplat] = vec4(0);
        batch_plane[kNoSplat] = vec4(0);
        batch_depth[kNoSplat] = vec4(1, 0, 0, 1e30);
        batch_colour[kNoSplat] = uvec2(0);
    }
    if (kHistory && gl_LocalInvocationIndex < kCellsPerTile) { squares[gl_LocalInvocationIndex] = 0; }
    if (kCoarse) {
        barrier();
        if (indexInCell() == 0) { atomicMax(most_pairs, range.y - range.x); }
    }
    bool counted = false;
    uint begin = range.x;  // an empty tile goes over a batch of nothing
    bool goes_on = false;
    [[dont_unroll]] do {
        barrier();
        if (!any_open && !counted) {
            atomicAdd(threads_done, 1);
            counted = true;
        }
        if (gl_LocalInvocationIndex < kCellsPerTile * kBatchSize / 32) {
            cell_splats[gl_LocalInvocationIndex / (kBatchSize / 32)]
                       [gl_LocalInvocationIndex % (kBatchSize / 32)] = 0;
        }
        barrier();
        if (threads_done == kThreads) { break; }
        const uint slots = is_coarse ? kCoarseBatch : kBatchSize,
                   first_slot = is_coarse ? cellIndex() * kCoarseBatch : 0;
        const uint splats = min(range.y - min(begin, range.y), slots);
        loadBatch(lanes, begin, first_slot, splats, tile_px, is_coarse);
        barrier();
        if (kNarrow && gl_SubgroupSize <= kThreadsPerCell) {
            blendBatchByLanes(lanes, first_slot, first_slot + splats, cellIndex(), first_px, apart,
                              max_inverse_depth_bits);
        } else {
            blendBatch(first_slot, first_slot + splats, cellIndex(), first_px, apart, max_inverse_depth_bits);
        }
        begin += slots;
        goes_on = kCoarse ? begin - range.x < most_pairs : begin < range.y;
    }
    while (goes_on)
        ;
}

vec3 shownOf(vec3 sum, float left) {
    const vec3 blended = sum + left * pass.background;
    return pass.is_light != 0 ? encode(blended) : blended;
}

// Writes the tile's pixels.
void putTile(uint tile, uvec2 range, uvec2 first_pixel) {
    const uvec2 size_px = pass.eyes.at[gl_WorkGroupID.z].size_px;
    const bool may_move = kEvenRows || kHistory || kMoments, may_keep = kMoments && !kEvenRows && !kHistory;
    const uvec2 colours = TARGET.colours, depths = kDepth ? TARGET.depths : uvec2(0),
                sums = may_keep ? TARGET.moments : uvec2(0), moving = may_move ? TARGET.moving : uvec2(0),
                arrivals = may_move ? TARGET.arrivals : uvec2(0);
    const bool clears_arrivals = isThere(arrivals), keeps_moments = may_keep && isThere(sums),
               moves = kEvenRows || kHistory || (kMoments && isThere(moving));
    const uint row_words = may_move ? TARGET.row_words : 0;
    float error = 0;
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        const uvec2 pixel = first_pixel + uvec2(0, p);
        if (pixel.x < size_px.x && pixel.y < size_px.y) {
            const uint at = pixel.y * size_px.x + pixel.x;
            const float left = abs(transmittance[p]);
            const vec3 shown = shownOf(colour[p], left);
            if (kHistory && isMade()) { addError(error, shown, colours, at); }
            if (!kMeasures || !is_wider) {
                putColour(FloatColours(colours), HalfColours(colours), at, vec4(shown, 1 - left));
                if (kDepth && isThere(depths)) { Floats(depths).at[at] = depthSum(p, 1 - left); }
                if (keeps_moments) { Vec2s(sums).at[at] = moments[p]; }
                if (moves && (!kEvenRows || (pixel.y & 1) == 0)) {
                    Uints(moving).at[pixel.y * row_words + pixel.x] = toMove(1 - left, depth[p], moments[p]);
                    if (clears_arrivals) { Uints(arrivals).at[pixel.y * row_words + pixel.x] = 0; }
                }
            }
        }
    }
    if (!kHistory) { return; }
    if (kMasked) {
        atomicAdd(squares[cellIndex()], uint(error * kErrorSteps));
        barrier();
    }
    if (gl_LocalInvocationIndex == 0) {
        leaveFound(tile, range.y - range.x, vec4(squares[0], squares[1], squares[2], squares[3]));
    }
}

#include "lib/fill_tiles.glsl"

uint coarseTileAt(uint place, uvec2 size_tiles) {
    return Uints(TARGET.full_tiles).at[size_tiles.x * size_tiles.y - 1 - place];
}

void main() [[subgroup_uniform_control_flow]] {
    const uint lanes = laneCount();
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint full_tiles = kMasked ? TARGET.counters.full_tiles : 0,
               coarse_tiles = kCoarse ? TARGET.counters.coarse_tiles : 0;
    const uint coarse_groups =
        (coarse_tiles + kCellsPerTile - 1) / kCellsPerTile;  // the first ones, since they may take longest
    if (kMasked && group >= coarse_groups + full_tiles) { return; }
    const uvec2 size_tiles = pass.eyes.at[gl_WorkGroupID.z].size_tiles;
    const uint first_tile = TARGET.first_tile;
    bool is_coarse = kCoarse && group < coarse_groups;
    const uint place = group * kCellsPerTile + cellIndex();
    uint tile = is_coarse ? coarseTileAt(min(place, coarse_tiles - 1), size_tiles)
                : kMasked
                    ? Uints(TARGET.full_tiles).at[spread(group - coarse_groups, full_tiles)]
                    : spread(gl_WorkGroupID.y, gl_NumWorkGroups.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint again = 0;  // cells whose coarse tile is to be blended in full
    [[dont_unroll]] do {
        const uvec2 tile_px = uvec2(tile % size_tiles.x, tile / size_tiles.x) * kTileSize;
        const uvec2 range = is_coarse && place >= coarse_tiles ? uvec2(0) : pass.ranges.at[first_tile + tile];
        const uvec2 in_cell = uvec2(indexInCell() % kCellSize, indexInCell() / kCellSize * kPixels);
        const uvec2 first_pixel = tile_px + kCellSize * uvec2(cellIndex() & 1, cellIndex() >> 1) + in_cell;
        blendTile(lanes, range, tile_px,
                  is_coarse ? kSamplesApart * vec2(in_cell) + 0.5 : vec2(first_pixel - tile_px) + 0.5,
                  is_coarse);
        if (is_coarse) {
            again = fillTiles(tile, tile_px, range);
        } else {
            const bool measured = isMeasured(tile);
            putTile(tile, range, first_pixel);
            is_wider = measured;
            if (measured) {
                barrier();  // its squares are being read
                continue;
            }
            if (kCoarse && gl_LocalInvocationIndex == 0) {
                atomicAdd(TARGET.counters.sharp_pairs, range.y - range.x);
            }
        }
        if (!kCoarse || again == 0) { break; }
        tile = coarseTileAt(group * kCellsPerTile + uint(findLSB(again)), size_tiles);
        again &= again - 1;
        is_coarse = false;
    }
    while (true)
        ;
}
