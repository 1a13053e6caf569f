// contribute: how much each splat contributes to an eye's picture. A workgroup per tile blends as rasterize
// does, each cell the splats that touch it, and sums for each splat its weights and the differences from a
// wanted picture where it is visible, or how it should change. The sums are of integers, so their order does
// not matter.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_subgroup_uniform_control_flow : require
#include "passes.h"

layout(push_constant, scalar) uniform Push { ContributePass pass; };
layout(constant_id = 0) const uint kThreadsPerCell = 32;  // as in rasterize
layout(constant_id = 1) const uint kSplatKind = kDiscs;   // dimmed or not makes no difference here
layout(constant_id = 2) const bool kFits = false;         // all kContributionSums of a splat, or kErrorSums
layout(local_size_x_id = 3) in;                           // kCellsPerTile * kThreadsPerCell
// A cell's threads are a subgroup of kNarrow lanes. A CPU reads memory lane by lane, even if all lanes read
// the same, and adds to it in the same way. So each lane reads one splat for all lanes, and adds one sum for
// all.
layout(constant_id = 4) const bool kByLanes = false;

const bool kPlaced = false;  // no splat of the scene is read
#include "lib/splat.glsl"
#include "lib/outline.glsl"
#include "lib/cells.glsl"
#include "lib/pair_word.glsl"

const uint kThreads = kCellsPerTile * kThreadsPerCell;
const uint kPixels = kCellSize * kCellSize / kThreadsPerCell;  // of a thread: a column
const uint kWords = kBatchSize / 32;                           // of a bit for each splat
const uint kNarrow = kContributionSums;
const uint kNoSplat = kBatchSize;  // the slot of a splat of no opacity
const uint kSums = kFits ? kContributionSums : kErrorSums;
const float kMostBehind = 4;  // colours seen through almost nothing cannot be told from rounding

// As rasterize holds them.
shared vec4 batch_reference[kBatchSize + 1];
shared vec4 batch_plane[kBatchSize + 1];
shared vec4 batch_depth[kBatchSize + 1];
shared uvec2 batch_colour[kBatchSize + 1];
shared uint cell_splats[kCellsPerTile][kWords];  // four words: blendByLanes holds them in registers
shared int sums[kBatchSize][kContributionSums];
shared uint open_threads;

struct BatchSplat {
    vec4 reference, plane, depth_form;
    uvec2 colour;
};

vec3 missing[kPixels], unblended[kPixels];  // unblended: what the picture still gets, background included
float transmittance[kPixels];               // not positive once the pixel is opaque

void loadSplat(uint slot, uint rank, uvec2 tile_px) {
    const ProjectedSplat splat = pass.splats.at[rank];
    const bool has_reference = kSplatKind != kDiscs || hasReference(splat);
    const float scale = sqrt(kLog2PerRho), low_pass = pass.eyes.at[pass.eye].low_pass;
    batch_reference[slot] =
        has_reference
            ? vec4((splat.reference_px - vec2(tile_px)) + restOfReference(splat), 0, 0)
            : vec4(vec2(pass.eyes.at[pass.eye].size_px) * 0.5 - vec2(tile_px), scale * splat.reference_px);
    batch_plane[slot] = vec4(scale * splat.plane_from_pixel,
                             kSplatKind == kDiscs && has_reference ? kLog2PerRho * low_pass : 0);
    batch_depth[slot] = vec4(splat.inverse_depth, splat.perspective, negativeLog2Opacity(splat));
    batch_colour[slot] = splat.colour;
    for (uint s = 0; s < kSums; ++s) { sums[slot][s] = 0; }
    const uint cells = cellsOf(splat, tile_px, low_pass);
    for (uint cell = 0; cell < kCellsPerTile; ++cell) {
        if ((cells & (1u << cell)) != 0) { atomicOr(cell_splats[cell][slot / 32], 1u << (slot % 32)); }
    }
}

uint rankAt(uint pair) { return rankOfPair(pass.ranks.at[pair], pass.rank_bits); }

float limit(float value) { return clamp(value, -kMaxPixelError, kMaxPixelError); }

// A splat's rho at `d` from its reference, in units of log2, and whether it comes from the splat's size,
// rather than from the low-pass.
float rhoAt(vec2 d, vec2 at_reference, vec4 plane, vec4 depth_form, out bool by_size) {
    const float u = at_reference.x + plane.x * d.x + plane.y * d.y, v = at_reference.y + plane.z * d.y;
    const float square = u * u + v * v;
    by_size = true;
    if (kSplatKind != kDiscs) { return square; }
    const float q = depth_form.x + dot(depth_form.yz, d);
    const float z = 1 / q;
    const float rho3 = floatBitsToUint(q) <= floatBitsToUint(pass.eyes.at[pass.eye].max_inverse_depth)
                           ? square * (z * z)
                           : 3e38;
    const float rho2 = plane.w > 0 ? plane.w * dot(d, d) : 3e38;
    by_size = rho3 <= rho2;
    return min(rho3, rho2);
}

// Blends a splat into the thread's pixels, the first of which is at `first_px` in the tile; returns what this
// adds to the splat's sums. There are no branches: pixels that the splat does not reach blend it with weight
// 0.
int[kContributionSums] blend(BatchSplat splat, vec2 first_px) {
    const vec3 colour = kFits ? unpackColour(splat.colour) : vec3(0);
    float own[kContributionSums];
    [[unroll]] for (uint s = 0; s < kContributionSums; ++s) { own[s] = 0; }
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        bool by_size;
        const vec2 d = first_px + vec2(0, p) - splat.reference.xy;
        const float rho = rhoAt(d, splat.reference.zw, splat.plane, splat.depth_form, by_size);
        const float exponent = splat.depth_form.w + rho, opacity = exp2(-exponent);
        const bool shows = transmittance[p] > 0 && exponent <= kLog2Of255;
        const float after = transmittance[p] * max(1 - opacity, kMinPassing);
        const bool counts = shows && after >= kMinTransmittance;
        const float weight = counts ? min(kMaxAlpha, opacity) * transmittance[p] : 0;
        transmittance[p] = counts ? after : shows ? 0 : transmittance[p];
        own[kSumWeight] += weight;
        own[kSumMissing] += limit(weight * missing[p].x);
        if (!kFits) { continue; }
        own[kSumMissing + 1] += limit(weight * missing[p].y);
        own[kSumMissing + 2] += limit(weight * missing[p].z);
        unblended[p] -= weight * colour;
        const vec3 behind =
            clamp(unblended[p] * (1 / (counts ? after : 1)), vec3(-kMostBehind), vec3(kMostBehind));
        const vec3 off = colour - behind;
        const float varied = opacity < kMaxAlpha ? weight : 0;  // otherwise more of it would not be visible
        const float pull = varied * dot(off, missing[p]), hold = varied * dot(off, off);
        const float growth = counts && by_size ? rho / kLog2PerRho : 0;
        own[kSumOpacityPull] += limit(pull);
        own[kSumOpacityHold] += limit(hold);
        own[kSumSizePull] += limit(pull * growth);
        own[kSumSizeHold] += limit(hold * growth * growth);
    }
    int steps[kContributionSums];
    [[unroll]] for (uint s = 0; s < kContributionSums; ++s) {
        steps[s] = s < kSums ? int(round(own[s] * kContributionSteps)) : 0;
    }
    return steps;
}

// Half of the lanes keep one of two values, half the other: each the sum over two lanes at the distance
// `apart`.
int halve(int first, int second, uint apart) {
    const bool keeps_first = (gl_SubgroupInvocationID & apart) == 0;
    return (keeps_first ? first : second) +
           subgroupShuffle(keeps_first ? second : first, gl_SubgroupInvocationID ^ apart);
}

// Lane s returns the sum of own[s] over all lanes.
int sumLanes(int own[kContributionSums]) {
    return halve(halve(halve(own[0], own[4], 4), halve(own[2], own[6], 4), 2),
                 halve(halve(own[1], own[5], 4), halve(own[3], own[7], 4), 2), 1);
}

bool anyOpen() {
    bool any_open = false;
    [[unroll]] for (uint p = 0; p < kPixels; ++p) { any_open = any_open || transmittance[p] > 0; }
    return any_open;
}

BatchSplat splatAt(uint slot) {
    return BatchSplat(batch_reference[slot], batch_plane[slot], batch_depth[slot], batch_colour[slot]);
}

// Blends the splats of a word of the cell's bits.
void blendWord(uint bits, uint first_slot, vec2 first_px) {
    while (bits != 0 && anyOpen()) {
        const uint slot = first_slot + uint(findLSB(bits));
        const int own[kContributionSums] = blend(splatAt(slot), first_px);
        if (own[kSumWeight] != 0) {
            for (uint s = 0; s < kSums; ++s) { atomicAdd(sums[slot][s], own[s]); }
        }
        bits &= bits - 1;
    }
}

// The same for all words, with kByLanes: kNarrow splats at a time, of which each lane reads one. A word
// without bits blends the splat of no opacity. There are as few rounds as in rasterize.
void blendByLanes(uint cell, uint end_slot, vec2 first_px) {
    uint bits = cell_splats[cell][0], first_slot = 0;
    uvec3 next = uvec3(cell_splats[cell][1], cell_splats[cell][2], cell_splats[cell][3]);
    [[dont_unroll]] do {
        uint mine = bits;  // from the lane's splat on
        [[unroll]] for (uint lane = 1; lane < kNarrow; ++lane) {
            if (gl_SubgroupInvocationID >= lane) { mine &= mine - 1; }
        }
        const uint own_slot = mine != 0 ? first_slot + uint(findLSB(mine)) : kNoSplat;
        const BatchSplat read = splatAt(own_slot);
        const uint splats = min(uint(bitCount(bits)), kNarrow);
        uint lane = 0;
        [[dont_unroll]] do {
            const BatchSplat splat =
                BatchSplat(subgroupShuffle(read.reference, lane), subgroupShuffle(read.plane, lane),
                           subgroupShuffle(read.depth_form, lane), subgroupShuffle(read.colour, lane));
            const int sum = sumLanes(blend(splat, first_px));
            const uint slot = subgroupShuffle(own_slot, lane);
            if (sum != 0) { atomicAdd(sums[slot][gl_SubgroupInvocationID], sum); }
            ++lane;
        }
        while (lane < splats)
            ;
        bits = subgroupShuffle(mine & (mine - 1), kNarrow - 1);
        if (bits == 0) {
            bits = next.x;
            next = uvec3(next.yz, 0);
            first_slot += 32;
        }
    }
    while (first_slot < end_slot && subgroupBallot(anyOpen()).x != 0)
        ;
}

void addToScene(uint word, int value) {
    if (value == 0) { return; }
    const uint low = uint(value), before = atomicAdd(pass.sums.at[word], low);
    const uint high = (before + low < before ? 1u : 0u) + (value < 0 ? 0xffffffffu : 0u);
    if (high != 0) { atomicAdd(pass.sums.at[word + 1], high); }
}

void begin(uvec2 first_pixel) {
    const uvec2 size_px = pass.eyes.at[pass.eye].size_px;
    for (uint p = 0; p < kPixels; ++p) {
        const uvec2 pixel = first_pixel + uvec2(0, p);
        const bool inside = pixel.x < size_px.x && pixel.y < size_px.y;
        transmittance[p] = inside ? 1 : 0;
        missing[p] = unblended[p] = vec3(0);
        if (inside) {
            const uint at = pixel.y * size_px.x + pixel.x;
            unblended[p] = pass.picture.at[at].rgb;
            missing[p] = pass.wanted.at[at].rgb - unblended[p];
            if (!kFits) { missing[p].x = kSquareScale / 3 * dot(missing[p], missing[p]); }
        }
    }
}

void main() [[subgroup_uniform_control_flow]] {
    const uint thread =
        kByLanes ? gl_SubgroupID * kNarrow + gl_SubgroupInvocationID : gl_LocalInvocationIndex;
    const uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint cell = thread / kThreadsPerCell, in_cell = thread % kThreadsPerCell;
    const uvec2 size_tiles = pass.eyes.at[pass.eye].size_tiles;
    const uvec2 tile_px = uvec2(tile % size_tiles.x, tile / size_tiles.x) * kTileSize;
    const uvec2 range = pass.ranges.at[tile], of_cell = uvec2(cell % 2, cell / 2) * kCellSize;
    const uvec2 first_px = of_cell + uvec2(in_cell % kCellSize, in_cell / kCellSize * kPixels);
    begin(tile_px + first_px);
    if (kByLanes && thread == 0) {
        batch_reference[kNoSplat] = batch_plane[kNoSplat] = vec4(0);
        batch_depth[kNoSplat] = vec4(1, 0, 0, 1e30);
        batch_colour[kNoSplat] = uvec2(0);
    }
    for (uint first = range.x; first < range.y; first += kBatchSize) {
        const uint splats = min(range.y - first, kBatchSize);
        barrier();  // the previous batch is still being added
        if (thread == 0) { open_threads = 0; }
        if (thread < kCellsPerTile * kWords) { cell_splats[thread / kWords][thread % kWords] = 0; }
        barrier();
        if (anyOpen()) { atomicOr(open_threads, 1); }
        for (uint slot = thread; slot < splats; slot += kThreads) {
            loadSplat(slot, rankAt(first + slot), tile_px);
        }
        barrier();
        if (open_threads == 0) { break; }
        if (kByLanes) {
            blendByLanes(cell, splats, vec2(first_px) + 0.5);
        } else {
            for (uint word = 0; word < (splats + 31) / 32; ++word) {
                blendWord(cell_splats[cell][word], word * 32, vec2(first_px) + 0.5);
            }
        }
        barrier();
        for (uint slot = thread; slot < splats; slot += kThreads) {
            if (sums[slot][kSumWeight] == 0) { continue; }
            const uint word = pass.order.at[rankAt(first + slot)] * 2 * kSums;
            for (uint s = 0; s < kSums; ++s) { addToScene(word + 2 * s, sums[slot][s]); }
        }
    }
}
