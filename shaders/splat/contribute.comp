// contribute: how much of an eye's picture each splat makes up, a workgroup per tile: it blends as rasterize does,
// each cell the splats that meet it, and sums for each splat what its weights are and, against a picture that is
// wanted, what they should be. All sums are of integers, in any order the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"

layout(push_constant, scalar) uniform Push { ContributePass pass; };
layout(constant_id = 0) const uint kThreadsPerCell = 32;  // as rasterize has them
layout(constant_id = 1) const uint kSplatKind = kDiscs;   // dimmed or not makes no difference here
layout(constant_id = 2) const bool kFits = false;         // there is a wanted picture
layout(local_size_x_id = 3) in;                           // kCellsPerTile * kThreadsPerCell

const bool kPlaced = false;  // no splat of the scene is read
#include "lib/splat.glsl"
#include "lib/outline.glsl"
#include "lib/cells.glsl"

const uint kThreads = kCellsPerTile * kThreadsPerCell;
const uint kPixels = kCellSize * kCellSize / kThreadsPerCell;  // of a thread: a column
const uint kWords = kBatchSize / 32;  // of a bit for each splat
const uint kSums = kFits ? kContributionSums : 1;
const float kMostBehind = 4;  // colours that show through nearly nothing are not told apart from rounding

// As rasterize holds them.
shared vec4 batch_reference[kBatchSize];
shared vec4 batch_plane[kBatchSize];
shared vec4 batch_depth[kBatchSize];
shared uvec2 batch_colour[kBatchSize];
shared uint cell_splats[kCellsPerTile][kWords];
shared int sums[kBatchSize][kContributionSums];
shared uint open_threads;

vec3 missing[kPixels], unblended[kPixels];  // unblended: what the picture still gets, background included
float transmittance[kPixels];               // not positive once the pixel takes no more light

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
    const uint cells = cellsOf(splat, tile_px, low_pass);
    for (uint cell = 0; cell < kCellsPerTile; ++cell) {
        if ((cells & (1u << cell)) != 0) { atomicOr(cell_splats[cell][slot / 32], 1u << (slot % 32)); }
    }
}

int inSteps(float value) { return int(round(clamp(value, -kMaxPixelError, kMaxPixelError) * kContributionSteps)); }

// A splat's rho at `d` from its reference, in units of log2, and whether its size makes it: the low-pass has
// none.
float rhoAt(vec2 d, vec2 at_reference, vec4 plane, vec4 depth_form, out bool by_size) {
    const float u = at_reference.x + plane.x * d.x + plane.y * d.y, v = at_reference.y + plane.z * d.y;
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

// Blends a splat into the thread's pixels, the first of which lies at `first_px` of the tile, and adds to its
// sums. False once they take no more light.
bool blend(uint slot, vec2 first_px) {
    const vec4 reference = batch_reference[slot], plane = batch_plane[slot], depth_form = batch_depth[slot];
    const vec3 colour = kFits ? unpackColour(batch_colour[slot]) : vec3(0);
    int own[kContributionSums];
    for (uint s = 0; s < kSums; ++s) { own[s] = 0; }
    bool any_open = false;
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        bool by_size;
        const vec2 d = first_px + vec2(0, p) - reference.xy;
        const float rho = rhoAt(d, reference.zw, plane, depth_form, by_size);
        const float exponent = depth_form.w + rho;
        if (transmittance[p] > 0 && exponent <= kLog2Of255) {
            const float opacity = exp2(-exponent), after = transmittance[p] * max(1 - opacity, kMinPassing);
            if (after < kMinTransmittance) {
                transmittance[p] = 0;
            } else {
                const float weight = min(kMaxAlpha, opacity) * transmittance[p];
                transmittance[p] = after;
                own[kSumWeight] += inSteps(weight);
                if (kFits) {
                    unblended[p] -= weight * colour;
                    for (uint channel = 0; channel < 3; ++channel) {
                        own[kSumMissing + channel] += inSteps(weight * missing[p][channel]);
                    }
                    if (opacity < kMaxAlpha) {  // else more of it would not show
                        const vec3 behind = clamp(unblended[p] / after, vec3(-kMostBehind), vec3(kMostBehind));
                        const vec3 off = colour - behind;
                        const float pull = weight * dot(off, missing[p]), hold = weight * dot(off, off);
                        const float growth = by_size ? rho / kLog2PerRho : 0;
                        own[kSumOpacityPull] += inSteps(pull);
                        own[kSumOpacityHold] += inSteps(hold);
                        own[kSumSizePull] += inSteps(pull * growth);
                        own[kSumSizeHold] += inSteps(hold * growth * growth);
                    }
                }
            }
        }
        any_open = any_open || transmittance[p] > 0;
    }
    if (own[kSumWeight] != 0) {
        for (uint s = 0; s < kSums; ++s) { atomicAdd(sums[slot][s], own[s]); }
    }
    return any_open;
}

void addToScene(uint word, int value) {
    if (value == 0) { return; }
    const uint low = uint(value), before = atomicAdd(pass.sums.at[word], low);
    const uint high = (before + low < before ? 1u : 0u) + (value < 0 ? 0xffffffffu : 0u);
    if (high != 0) { atomicAdd(pass.sums.at[word + 1], high); }
}

// True if any pixel takes light.
bool begin(uvec2 first_pixel) {
    const uvec2 size_px = pass.eyes.at[pass.eye].size_px;
    bool any_open = false;
    for (uint p = 0; p < kPixels; ++p) {
        const uvec2 pixel = first_pixel + uvec2(0, p);
        const bool inside = pixel.x < size_px.x && pixel.y < size_px.y;
        any_open = any_open || inside;
        transmittance[p] = inside ? 1 : 0;
        missing[p] = unblended[p] = vec3(0);
        if (kFits && inside) {
            const uint at = pixel.y * size_px.x + pixel.x;
            unblended[p] = pass.picture.at[at].rgb;
            missing[p] = pass.wanted.at[at].rgb - unblended[p];
        }
    }
    return any_open;
}

void main() {
    const uint thread = gl_LocalInvocationIndex, tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint cell = thread / kThreadsPerCell, in_cell = thread % kThreadsPerCell;
    const uvec2 size_tiles = pass.eyes.at[pass.eye].size_tiles;
    const uvec2 tile_px = uvec2(tile % size_tiles.x, tile / size_tiles.x) * kTileSize;
    const uvec2 range = pass.ranges.at[tile], of_cell = uvec2(cell % 2, cell / 2) * kCellSize;
    const uvec2 first_px = of_cell + uvec2(in_cell % kCellSize, in_cell / kCellSize * kPixels);
    bool any_open = begin(tile_px + first_px);
    for (uint first = range.x; first < range.y; first += kBatchSize) {
        const uint splats = min(range.y - first, kBatchSize);
        barrier();  // the batch before is still being added
        if (thread == 0) { open_threads = 0; }
        if (thread < kCellsPerTile * kWords) { cell_splats[thread / kWords][thread % kWords] = 0; }
        barrier();
        if (any_open) { atomicOr(open_threads, 1); }
        for (uint slot = thread; slot < splats; slot += kThreads) {
            loadSplat(slot, pass.ranks.at[first + slot], tile_px);
        }
        barrier();
        if (open_threads == 0) { break; }
        for (uint word = 0; word < (splats + 31) / 32; ++word) {
            uint bits = cell_splats[cell][word];
            while (any_open && bits != 0) {
                any_open = blend(word * 32 + uint(findLSB(bits)), vec2(first_px) + 0.5);
                bits &= bits - 1;
            }
        }
        barrier();
        for (uint slot = thread; slot < splats; slot += kThreads) {
            if (sums[slot][kSumWeight] == 0) { continue; }
            const uint word = pass.order.at[pass.ranks.at[first + slot]] * 2 * kSums;
            for (uint s = 0; s < kSums; ++s) { addToScene(word + 2 * s, sums[slot][s]); }
        }
    }
}
