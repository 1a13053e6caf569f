// rasterize: blending, front to back, a workgroup per tile. A tile's splats come to shared memory a batch at a time, each with a bit
// for every cell of 8x8 pixels that it meets; the threads of a cell (one subgroup, where its width allows) then walk over
// their own splats alone. A thread blends several pixels of a column, so that what it reads from shared memory serves them all.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/moving_pixel.glsl"

layout(constant_id = 0) const uint kThreadsPerCell = 32;  // 8, 16, 32 or 64
layout(constant_id = 1) const bool kDepth = true;     // D is summed
layout(constant_id = 2) const bool kMoments = false;  // I and J are, as for a picture that is going to be warped
layout(constant_id = 3) const bool kHalfColours = false;
layout(constant_id = 4) const uint kSplatKind = kDiscs;  // dimmed or not makes no difference here
layout(local_size_x_id = 5) in;  // kCellsPerTile * kThreadsPerCell
layout(constant_id = 6) const bool kEvenRows = false;  // an odd row is going to be warped like the even one above it
layout(constant_id = 7) const bool kMasked = false;    // only the tiles of pass.full_tiles
layout(constant_id = 8) const bool kPast = false;      // the picture is going to be a past; under a mask it is made from one

#include "lib/splat.glsl"
#include "lib/outline.glsl"
#include "lib/picture.glsl"
#include "lib/srgb.glsl"

layout(push_constant, scalar) uniform Push { RasterizePass pass; };

const uint kThreads = kCellsPerTile * kThreadsPerCell;
const uint kPixels = kCellSize * kCellSize / kThreadsPerCell;  // of a thread: a column
const float kFar = 3e38;                                       // a rho that is no hit
const float kNoLowPass = 1e30;                                 // no hit either, but nearer than a hit at no depth (z infinite)
const uint kNoSplat = kBatchSize;                              // the slot of a splat of no opacity

// u, v and the low-pass are scaled here so that alpha = exp2(-(what opacity adds) - u^2 - v^2).
shared vec4 batch_reference[kBatchSize + 1];  // reference_px relative to the tile, u/z and v/z there
shared vec4 batch_plane[kBatchSize + 1];      // A, B, D, low-pass or 0
shared vec4 batch_depth[kBatchSize + 1];      // 1/z there, its slopes, -log2(opacity)
shared uvec2 batch_colour[kBatchSize + 1];
shared uint cell_splats[kCellsPerTile][kBatchSize / 32];  // four words: blendBatch holds them in registers
shared uint threads_done;
shared uint squares[kCellsPerTile];  // of the differences between what is rendered and what was there before, in kErrorSteps

// The cells of the tile that the splat meets, a bit each.
uint cellsOf(ProjectedSplat splat, uvec2 tile_px, float low_pass) {
    const Outline outline = outlineOfProjected(splat, low_pass);
    if (!outline.ellipse) { return 15; }
    uint cells = 0;
    for (uint row = 0; row < 2; ++row) {
        const float first_row = float(tile_px.y + row * kCellSize) + 0.5;
        vec2 bounds = boundsBetweenRows(outline, first_row - kOutlinePadding, first_row + float(kCellSize - 1) + kOutlinePadding);
        bounds += vec2(-kOutlinePadding, kOutlinePadding) - (float(tile_px.x) + 0.5);
        // Pixel columns 0 to 7 and 8 to 15 of the tile.
        if (bounds.x <= float(kCellSize - 1) && bounds.y >= 0) { cells |= 1u << (2 * row); }
        if (bounds.x <= float(2 * kCellSize - 1) && bounds.y >= float(kCellSize)) { cells |= 2u << (2 * row); }
    }
    return cells;
}

void loadSplat(uint slot, uint lanes_in_subgroup, uint rank, vec2 middle_px, uvec2 tile_px, float low_pass) {
    const ProjectedSplat splat = pass.splats.at[rank];
    const bool has_reference = kSplatKind != kDiscs || hasReference(splat);
    const float scale = sqrt(kLog2PerRho);
    // Relative to the tile, single precision places the centre to 1e-6 px.
    batch_reference[slot] = has_reference ? vec4((splat.reference_px - vec2(tile_px)) + restOfReference(splat), 0, 0)
                                          : vec4(middle_px - vec2(tile_px), scale * splat.reference_px);
    batch_plane[slot] = vec4(scale * splat.plane_from_pixel, kSplatKind == kDiscs && has_reference ? kLog2PerRho * low_pass : 0);
    batch_depth[slot] = vec4(splat.inverse_depth, splat.perspective, negativeLog2Opacity(splat));
    batch_colour[slot] = splat.colour;
    // A subgroup's slots are consecutive, so that one lane can set the bits of all that are here; either 32 divides the slot of lane 0, or
    // the subgroup's width divides 32.
    const uint cells = cellsOf(splat, tile_px, low_pass), first_slot = slot - gl_SubgroupInvocationID;
    for (uint cell = 0; cell < kCellsPerTile; ++cell) {
        const uvec4 lanes = subgroupBallot((cells & (1u << cell)) != 0);
        if (subgroupElect()) {
            uint word = 0;
            [[dont_unroll]] do {
                if (lanes[word] != 0) { atomicOr(cell_splats[cell][first_slot / 32 + word], lanes[word] << (first_slot & 31)); }
                ++word;
            } while (word < (lanes_in_subgroup + 31) / 32);
        }
    }
}

void loadBatch(uint begin, uint splats, uint lanes, vec2 middle_px, uvec2 tile_px, float low_pass) {
    uint slot = gl_SubgroupID * lanes + gl_SubgroupInvocationID;
    if (slot >= splats) { return; }
    [[dont_unroll]] do {
        loadSplat(slot, lanes, pass.ranks.at[begin + slot], middle_px, tile_px, low_pass);
        slot += kThreads;
    } while (slot < splats);
}

// The sums of the thread's pixels so far.
vec3 colour[kPixels];
float depth[kPixels];
vec2 moments[kPixels];
float transmittance[kPixels];  // negated once the pixel takes no more light
bool any_open;

// `first_px`: the middle of the thread's first pixel, relative to the tile.
void blend(uint slot, vec2 first_px, uint max_inverse_depth_bits) {
    const vec4 reference = batch_reference[slot];
    const vec4 plane = batch_plane[slot];
    const vec4 depth_form = batch_depth[slot];
    const vec3 splat_colour = unpackColour(batch_colour[slot]);

    const vec2 d = first_px - reference.xy;
    const float u = reference.z + plane.x * d.x;
    const float q = depth_form.x + depth_form.y * d.x;
    // Without a low-pass 1/z may be 0, here and at the reference, and no weight must meet an infinite z, not even 0.
    const bool low_pass = kSplatKind != kDiscs || plane.w > 0;
    const float rho2_x = low_pass ? plane.w * (d.x * d.x) : kNoLowPass;
    const float centre_z = low_pass ? 1 / depth_form.x : 0;
    float most_open = 0;
    // Without branches: pixels that the splat does not reach blend it with weight 0.
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        const float dy = d.y + float(p);
        const float u_p = u + plane.y * dy;
        const float v_p = reference.w + plane.z * dy;
        float q_p = q + depth_form.z * dy;
        if (kSplatKind != kDiscs) { q_p = clamp(q_p, depth_form.x / kDepthReach, depth_form.x * kDepthReach); }
        // A hit beyond the near plane has 0 < 1/z <= 1/near. As bits, negative values and NaN are above that.
        const float z = 1 / q_p;
        const float square = u_p * u_p + v_p * v_p;
        const float rho3 = floatBitsToUint(q_p) <= max_inverse_depth_bits ? square * (z * z) : kFar;
        const float rho2 = rho2_x + plane.w * (dy * dy);
        const bool on_disc = kSplatKind == kDiscs && rho3 <= rho2;
        const float exponent = depth_form.w + (kSplatKind != kDiscs ? square : on_disc ? rho3 : rho2);
        const float opacity = exp2(-exponent);
        const float alpha = min(kMaxAlpha, opacity);
        const float full_weight = exponent <= kLog2Of255 ? alpha * max(transmittance[p], 0) : 0;
        const float after = full_weight > 0 ? transmittance[p] * max(1 - opacity, kMinPassing) : transmittance[p];
        const bool closes = after < kMinTransmittance && after >= 0;
        const float weight = closes ? 0 : full_weight;
        transmittance[p] = closes ? -transmittance[p] : after;
        most_open = max(most_open, transmittance[p]);
        colour[p] += weight * splat_colour;
        if (kDepth) { depth[p] += weight * (kSplatKind != kDiscs || on_disc ? z : centre_z); }
        if (kMoments && (!kEvenRows || (p & 1) == 0)) {
            const float inverse_z = kSplatKind != kDiscs || on_disc ? q_p : depth_form.x;
            const float weighted = weight * inverse_z;
            moments[p].x += weighted;
            moments[p].y += weighted * inverse_z;
        }
    }
    any_open = most_open > 0;
}

// Blends the splats of the batch that meet the cell, in one loop: with a loop over bits inside one over words, NVIDIA's compilers
// use a fifth more registers, and every pixel's sums would be carried through both. A word without bits blends the splat of no opacity.
void blendBatch(uint splats, uint cell, vec2 first_px, uint max_inverse_depth_bits) {
    uint first_slot = 0, bits = cell_splats[cell][0];
    uvec3 next = uvec3(cell_splats[cell][1], cell_splats[cell][2], cell_splats[cell][3]);
    [[dont_unroll]] do {
        blend(bits != 0 ? first_slot + uint(findLSB(bits)) : kNoSplat, first_px, max_inverse_depth_bits);
        bits &= bits - 1;
        if (bits == 0) {
            bits = next.x;
            next = uvec3(next.yz, 0);
            first_slot += 32;
        }
    } while (any_open && first_slot < splats);
}

// The pixel as it is going to be warped: at the depth that stands for it, infinitely far where nothing was blended.
uint toMove(float alpha, float depth_sum, vec2 inverse_depth_sums) {
    const float mean = inverse_depth_sums.x / alpha;
    const float inverse_depth = !isPositive(alpha)                                    ? 0
                                : !kDepth || pass.depth_choice == kDepthInverse ? mean
                                : pass.depth_choice == kDepthMean               ? alpha / depth_sum
                                                                                : 1 / depth_sum;
    if (floatBitsToUint(inverse_depth) >= floatBitsToUint(1e30)) { return 0; }  // neither are negative ones and NaN less
    const float variance = max(inverse_depth_sums.y / alpha - mean * mean, 0);
    return movingPixel(inverse_depth, kLanded, spreadCode(variance / (inverse_depth * inverse_depth)));
}

// Writes what a picture that is made from this one must know of the tile. Every thread must call it; `error` is what its pixels turned out
// to have had.
void leaveTile(uint tile, uint cost, float error) {
    if (kMasked) {
        atomicAdd(squares[gl_LocalInvocationIndex / kThreadsPerCell], uint(error * kErrorSteps));
        barrier();
    }
    if (gl_LocalInvocationIndex != 0) { return; }
    const vec4 sums = kMasked ? vec4(squares[0], squares[1], squares[2], squares[3]) : vec4(0);
    const vec4 amplitude = sqrt(sums / (kErrorSteps * 3 * kCellSize * kCellSize));
    const uint age = kMasked ? pass.past_tiles.at[tile].age : 0;  // 0: nothing was there
    const vec4 growth = age > 0 ? amplitude / float(age) : vec4(0);
    pass.past_tiles.at[tile] = PastTile(cost, 0, growth, vec4(0), uvec4(0));
}

void main() [[subgroup_uniform_control_flow]] {
    const EyeView eye = pass.eyes.at[pass.eye];
    const uvec2 size_px = eye.size_px;
    const uint max_inverse_depth_bits = floatBitsToUint(eye.max_inverse_depth);
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint full_tiles = kMasked ? pass.counters.at[0].full_tiles : 0;
    if (kMasked && group >= full_tiles) { return; }
    const uint tile = kMasked ? pass.full_tiles.at[spread(group, full_tiles)]
                              : spread(gl_WorkGroupID.y, gl_NumWorkGroups.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uvec2 tile_px = uvec2(tile % eye.size_tiles.x, tile / eye.size_tiles.x) * kTileSize;
    const uint cell = gl_LocalInvocationIndex / kThreadsPerCell;
    const uint in_cell = gl_LocalInvocationIndex % kThreadsPerCell;
    const uvec2 first_pixel = tile_px + kCellSize * uvec2(cell & 1, cell >> 1) + uvec2(in_cell % kCellSize, in_cell / kCellSize * kPixels);
    const vec2 first_px = vec2(first_pixel - tile_px) + 0.5;  // relative to the tile
    const uvec2 range = pass.ranges.at[tile];

    any_open = false;
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        colour[p] = vec3(0);
        depth[p] = 0;
        moments[p] = vec2(0);
        const bool inside = first_pixel.x < size_px.x && first_pixel.y + p < size_px.y;
        transmittance[p] = inside ? 1 : -1;
        any_open = any_open || inside;
    }
    const uint lanes = laneCount();
    if (gl_LocalInvocationIndex == 0) {
        threads_done = 0;
        if (kPast) { squares = uint[](0, 0, 0, 0); }
        batch_reference[kNoSplat] = vec4(0);
        batch_plane[kNoSplat] = vec4(0);
        batch_depth[kNoSplat] = vec4(1, 0, 0, 1e30);
        batch_colour[kNoSplat] = uvec2(0);
    }
    bool counted = false;
    uint begin = range.x;  // an empty tile goes over a batch of nothing
    [[dont_unroll]] do {
        barrier();
        if (!any_open && !counted) {
            atomicAdd(threads_done, 1);
            counted = true;
        }
        if (gl_LocalInvocationIndex < kCellsPerTile * kBatchSize / 32) {
            cell_splats[gl_LocalInvocationIndex / (kBatchSize / 32)][gl_LocalInvocationIndex % (kBatchSize / 32)] = 0;
        }
        barrier();
        if (threads_done == kThreads) { break; }
        const uint splats = min(range.y - begin, kBatchSize);
        loadBatch(begin, splats, lanes, vec2(size_px) * 0.5, tile_px, eye.low_pass);
        barrier();
        blendBatch(splats, cell, first_px, max_inverse_depth_bits);
        begin += kBatchSize;
    } while (begin < range.y);

    const bool clears_arrivals = isThere(uvec2(pass.arrivals)), keeps_moments = kMoments && !kEvenRows && !kPast && isThere(uvec2(pass.moments)),
               moves = kEvenRows || kPast || (kMoments && isThere(uvec2(pass.moving)));
    HalfColours half_colours = HalfColours(uvec2(pass.colours));
    float error = 0;
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        const uvec2 pixel = first_pixel + uvec2(0, p);
        if (pixel.x < size_px.x && pixel.y < size_px.y) {
            const uint at = pixel.y * size_px.x + pixel.x;
            const float left = abs(transmittance[p]);
            const vec3 blended = colour[p] + left * pass.background;
            const vec3 shown = pass.is_light != 0 ? encode(blended) : blended;
            if (kPast && kMasked) {
                const vec3 off = shown - colourAt(pass.colours, half_colours, at).rgb;
                error += min(dot(off, off), kMaxPixelError);
            }
            putColour(pass.colours, half_colours, at, vec4(shown, 1 - left));
            if (kDepth && isThere(uvec2(pass.depths))) { pass.depths.at[at] = depth[p]; }
            if (keeps_moments) { pass.moments.at[at] = moments[p]; }
            if (moves && (!kEvenRows || (pixel.y & 1) == 0)) {
                pass.moving.at[pixel.y * pass.row_words + pixel.x] = toMove(1 - left, depth[p], moments[p]);
                if (clears_arrivals) { pass.arrivals.at[pixel.y * pass.row_words + pixel.x] = 0; }
            }
        }
    }
    if (kPast) { leaveTile(tile, range.y - range.x, error); }
}
