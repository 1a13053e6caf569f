// contribute: how much of an eye's picture each splat makes up, a workgroup per tile: it blends as rasterize does, and sums for each splat
// what its weights are and, against a picture that is wanted, what they should be. All sums are of integers, in any order the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { ContributePass pass; };
layout(constant_id = 0) const uint kSplatKind = kDiscs;
layout(constant_id = 1) const bool kFits = false;        // there is a wanted picture

const bool kPlaced = false;  // no splat of the scene is read
#include "lib/splat.glsl"

const uint kPixels = kTileSize * kTileSize / kGroupSize;  // of a thread, the second one half a tile below the first
const uint kSums = kFits ? kContributionSums : 1;
const float kMostBehind = 4;  // colours that show through nearly nothing are not told apart from rounding

// As rasterize holds them.
shared vec4 batch_reference[kBatchSize];
shared vec4 batch_plane[kBatchSize];
shared vec4 batch_depth[kBatchSize];
shared uvec2 batch_colour[kBatchSize];
shared int sums[kBatchSize][kContributionSums];
shared uint open_threads;

vec3 missing[kPixels], unblended[kPixels];  // unblended: what the picture still gets, background included
float transmittance[kPixels];                              // not positive once the pixel takes no more light

void loadSplat(uint slot, uint rank, uvec2 tile_px) {
    const ProjectedSplat splat = pass.splats.at[rank];
    const bool has_reference = kSplatKind != kDiscs || hasReference(splat);
    const float scale = sqrt(kLog2PerRho), low_pass = pass.eyes.at[pass.eye].low_pass;
    batch_reference[slot] = has_reference ? vec4((splat.reference_px - vec2(tile_px)) + restOfReference(splat), 0, 0)
                                          : vec4(vec2(pass.eyes.at[pass.eye].size_px) * 0.5 - vec2(tile_px), scale * splat.reference_px);
    batch_plane[slot] = vec4(scale * splat.plane_from_pixel, kSplatKind == kDiscs && has_reference ? kLog2PerRho * low_pass : 0);
    batch_depth[slot] = vec4(splat.inverse_depth, splat.perspective, negativeLog2Opacity(splat));
    batch_colour[slot] = splat.colour;
    for (uint s = 0; s < kSums; ++s) { sums[slot][s] = 0; }
}

int inSteps(float value) { return int(round(clamp(value, -kMaxPixelError, kMaxPixelError) * kContributionSteps)); }

// A splat's rho at a pixel, in units of log2, and whether its size makes it: the low-pass has none.
float rhoAt(uint slot, vec2 pixel, out bool by_size) {
    const vec4 reference = batch_reference[slot], plane = batch_plane[slot], depth_form = batch_depth[slot];
    const vec2 d = pixel - reference.xy;
    const float u = reference.z + plane.x * d.x + plane.y * d.y, v = reference.w + plane.z * d.y;
    const float square = u * u + v * v;
    by_size = true;
    if (kSplatKind != kDiscs) { return square; }
    const float q = depth_form.x + dot(depth_form.yz, d);
    const float z = 1 / q;
    const float rho3 = floatBitsToUint(q) <= floatBitsToUint(pass.eyes.at[pass.eye].max_inverse_depth) ? square * (z * z) : 3e38;
    const float rho2 = plane.w > 0 ? plane.w * dot(d, d) : 3e38;
    by_size = rho3 <= rho2;
    return min(rho3, rho2);
}

// Blends a splat into one of the thread's pixels, and adds to its sums.
void blend(uint slot, uint p, vec2 pixel, inout int own[kContributionSums]) {
    bool by_size;
    const float rho = rhoAt(slot, pixel, by_size), exponent = batch_depth[slot].w + rho;
    if (!(transmittance[p] > 0 && exponent <= kLog2Of255)) { return; }
    const float opacity = exp2(-exponent), after = transmittance[p] * max(1 - opacity, kMinPassing);
    if (after < kMinTransmittance) {
        transmittance[p] = 0;
        return;
    }
    const float weight = min(kMaxAlpha, opacity) * transmittance[p];
    transmittance[p] = after;
    own[kSumWeight] += inSteps(weight);
    if (!kFits) { return; }
    const vec3 colour = unpackColour(batch_colour[slot]);
    unblended[p] -= weight * colour;
    for (uint channel = 0; channel < 3; ++channel) { own[kSumMissing + channel] += inSteps(weight * missing[p][channel]); }
    if (opacity >= kMaxAlpha) { return; }  // more of it would not show
    const vec3 off = colour - clamp(unblended[p] / after, vec3(-kMostBehind), vec3(kMostBehind));
    const float pull = weight * dot(off, missing[p]), hold = weight * dot(off, off), growth = by_size ? rho / kLog2PerRho : 0;
    own[kSumOpacityPull] += inSteps(pull);
    own[kSumOpacityHold] += inSteps(hold);
    own[kSumSizePull] += inSteps(pull * growth);
    own[kSumSizeHold] += inSteps(hold * growth * growth);
}

void addToScene(uint word, int value) {
    if (value == 0) { return; }
    const uint low = uint(value), before = atomicAdd(pass.sums.at[word], low);
    const uint high = (before + low < before ? 1u : 0u) + (value < 0 ? 0xffffffffu : 0u);
    if (high != 0) { atomicAdd(pass.sums.at[word + 1], high); }
}

void begin(uvec2 tile_px, uvec2 first_px) {
    const uvec2 size_px = pass.eyes.at[pass.eye].size_px;
    for (uint p = 0; p < kPixels; ++p) {
        const uvec2 pixel = tile_px + first_px + uvec2(0, p * kTileSize / kPixels);
        const bool inside = pixel.x < size_px.x && pixel.y < size_px.y;
        transmittance[p] = inside ? 1 : 0;
        missing[p] = unblended[p] = vec3(0);
        if (kFits && inside) {
            const uint at = pixel.y * size_px.x + pixel.x;
            unblended[p] = pass.picture.at[at].rgb;
            missing[p] = pass.wanted.at[at].rgb - unblended[p];
        }
    }
}

void main() [[subgroup_uniform_control_flow]] {
    const uint thread = gl_LocalInvocationIndex, tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uvec2 size_tiles = pass.eyes.at[pass.eye].size_tiles;
    const uvec2 tile_px = uvec2(tile % size_tiles.x, tile / size_tiles.x) * kTileSize;
    const uvec2 first_px = uvec2(thread % kTileSize, thread / kTileSize), range = pass.ranges.at[tile];
    begin(tile_px, first_px);
    for (uint first = range.x; first < range.y; first += kBatchSize) {
        const uint splats = min(range.y - first, kBatchSize);
        barrier();  // the batch before is still being added
        if (thread == 0) { open_threads = 0; }
        if (thread < splats) { loadSplat(thread, pass.ranks.at[first + thread], tile_px); }
        barrier();
        if (max(transmittance[0], transmittance[kPixels - 1]) > 0) { atomicOr(open_threads, 1); }
        barrier();
        if (open_threads == 0) { break; }
        for (uint slot = 0; slot < splats; ++slot) {
            int own[kContributionSums];
            for (uint s = 0; s < kSums; ++s) { own[s] = 0; }
            for (uint p = 0; p < kPixels; ++p) {
                blend(slot, p, vec2(first_px) + vec2(0.5, 0.5 + float(p * kTileSize / kPixels)), own);
            }
            const int weight = subgroupAdd(own[kSumWeight]);
            if (weight == 0) { continue; }
            if (subgroupElect()) { atomicAdd(sums[slot][kSumWeight], weight); }
            for (uint s = 1; s < kSums; ++s) {
                const int sum = subgroupAdd(own[s]);
                if (subgroupElect()) { atomicAdd(sums[slot][s], sum); }
            }
        }
        barrier();
        if (thread < splats && sums[thread][kSumWeight] != 0) {
            const uint word = pass.order.at[pass.ranks.at[first + thread]] * 2 * kSums;
            for (uint s = 0; s < kSums; ++s) { addToScene(word + 2 * s, sums[thread][s]); }
        }
    }
}
