// resample: every pixel of the target that no tile renders gets a place in the source and is sampled there. A
// workgroup per row. Where pixels stay in their rows and a row fits into shared memory, this pass moves them
// there itself; otherwise reproject has done so.
// A pixel that something reached keeps its depth. The others form runs between two such pixels. A short run
// across a slanted surface interpolates its depth; any other repeats the farther neighbour, since what was
// hidden lies behind. Few tiles have runs: they are listed and processed in a second pass, so that all other
// pixels skip the search. A cubic kernel (Catmull and Rom 1974) reads the colour.
// Where errors are predicted, each tile sums those of its pixels from the samples at hand: for a hole's
// pixel, how much the picture changes next to the hole; for any other, the uncertainty of its disparity times
// the picture's gradient, and what a cubic loses between pixels. Only even rows have errors, which count
// twice. They come first, and the odd ones once tiles are chosen, so that only half of a tile's pixels are
// sampled in vain if it is then rendered. Where pixels stay in their rows, an odd row is sampled at the
// places of the even one above it, so that only half of the rows are moved. Its colours are its own, except
// where it repeats a neighbour. Where an eye does not resolve two rows (price), an odd row is the mean of
// those above and below.
// Where colours are copied, this follows the paper to the letter instead, see copyArrived.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/warp.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/tile_mask.glsl"
#include "lib/unseen.glsl"

layout(local_size_x = kWarpGroup) in;
layout(push_constant, scalar) uniform Push { ResamplePass pass; };
// A whole row of arrivals is kept in shared memory, so that colours may overwrite it in device memory. 0:
// rows are too long, and arrivals lie elsewhere.
layout(constant_id = 1) const uint kRowSteps = 1;
layout(constant_id = 2) const bool kHalfColours = false;
layout(constant_id = 3) const uint kRowSource = kArrivalsGiven;
layout(constant_id = 4) const uint kWay = kDoesAny;

#include "lib/picture.glsl"

const uint kMaxWidth = 16384;
const uint kLongestRow = kRowSteps == 0 ? kMaxWidth : kRowSteps * kArrivalsStep;
const uint kSharedRow = kRowSource == kPlacesGiven ? 0 : kRowSteps * kArrivalsStep;
const bool kPlaced = kRowSource == kPlacesGiven,
           kMovesRow = kRowSource == kRowMoved || kRowSource == kWholeRowMoved;
const bool kClasses = kWay == kDoesAny;

shared uint row_arrivals[kSharedRow + 1];
shared uint arrived_bits[kPlaced ? 1 : kLongestRow / 32];
shared uint tile_classes[kClasses ? kLongestRow / 16 : 1];
const uint kMostTiles = kLongestRow / 16;

// Tiles of this row, unordered; from the end those in which this row is a mean of others.
shared uint reprojected_tiles[kMostTiles];
shared uint moved_count;
shared uint mean_count;
shared uint hidden_count;
// Slots of reprojected_tiles whose tiles have pixels that nothing reached.
shared uint open_tiles[kPlaced ? 1 : kMostTiles];
shared uint open_bits[kPlaced ? 1 : (kMostTiles + 31) / 32];
shared uint open_count;

bool copiesColours() { return !kPlaced && (kWay == kCopies || (kClasses && pass.copies_colours != 0)); }
bool predictsErrors() {
    return !kPlaced &&
           (kWay == kPredicts || (kClasses && pass.first_row == 0 && isThere(uvec2(pass.tile_errors))));
}
bool keepsDepths() { return isThere(uvec2(pass.depths)); }
bool groupsHoles() { return kClasses && pass.groups_holes != 0; }

#include "lib/row_arrivals.glsl"
vec4 sourceAt(uint i) { return colourAt(pass.source, pass.half_source, i); }
#include "lib/cubic.glsl"
#include "lib/moved_error.glsl"
#include "lib/copy_arrived.glsl"

void putPixel(WarpView warp, uvec2 at, uint pixel_class, vec4 colour, float inverse_depth) {
    const uint i = at.y * warp.size_px.x + at.x;
    if (groupsHoles() && pixel_class == kHole) {
        ComponentPixels(uvec2(pass.target)).at[kHalfColours ? i : 2 * i].parent = i;
    } else {
        putColour(pass.target, pass.half_target, i, colour);
    }
    if (keepsDepths()) { pass.depths.at[i] = inverse_depth > 0 ? colour.a / inverse_depth : 0; }
}

#include "lib/odd_rows.glsl"

// Which tiles of the row are moved, which are the mean of the rows above and below, and whether any is
// hidden.
void listTiles(uint first_tile, uint tiles, bool moves, bool may_be_mean) {
    uint tile = gl_LocalInvocationIndex;
    if (tile >= tiles) { return; }
    [[dont_unroll]] do {
        const uint kind = pass.tile_kinds.at[first_tile + tile];
        if (kind == 0 && moves) {
            if (may_be_mean && pass.tile_errors.at[first_tile + tile] == kSeenCoarsely) {
                reprojected_tiles[kMostTiles - 1 - atomicAdd(mean_count, 1)] = tile;
            } else {
                reprojected_tiles[atomicAdd(moved_count, 1)] = tile;
            }
        }
        if (kind == kTileHidden) { atomicAdd(hidden_count, 1); }
        tile += kWarpGroup;
    }
    while (tile < tiles)
        ;
}

// Writes the pixel; returns its expected squared error.
float putResolved(WarpView warp, uint row, uvec2 at, Resolved resolved, bool open) {
    const vec2 source_px =
        movePixel(warp.source_from_target, vec2(resolved.column, at.y) + 0.5, resolved.inverse_depth).xy;
    const ivec2 size = ivec2(warp.size_px);
    const vec2 source = floor(clamp(source_px, vec2(0), vec2(size) - 1)) + 0.5;
    const vec2 disparity = disparityPerInverseDepth(warp.target_from_source, source);
    const float disparity_px = kRectified ? abs(disparity.x) : length(disparity);
    if (movesEvenRows(warp) && (at.y & 1) == 0) { keepPlace(warp, at, resolved, source_px.x); }
    const Sample found =
        kRectified ? sampleInRow(source_px.x, at.y * warp.size_px.x, size.x)
                   : sampleAround(source_px, size, disparity_px > 0 ? disparity / disparity_px : vec2(0));
    putPixel(warp, at, resolved.pixel_class, found.colour, resolved.inverse_depth);
    if (!predictsErrors() || (at.y & 1) != 0) { return 0; }
    if (open && resolved.pixel_class == kHole) {
        return 2 * holeError(warp, source_px, int(resolved.column) - int(at.x));
    }
    const float variance_px2 =
        min(uncertaintyOf(row, at.x, warp.size_px.x, resolved) * disparity_px * disparity_px,
            kMaxSpread * kMaxSpread);
    return 2 * (variance_px2 * dot(found.gradient, found.gradient) + found.lost) / 3;
}

// Writes a pixel that something reached, or any pixel if open ones are not told apart; returns its expected
// squared error and its class.
float putReached(WarpView warp, uint row, uvec2 at, uint arrival, out uint pixel_class) {
    if (copiesColours()) {
        const Copied copied = copyArrived(warp, row, at);
        pixel_class = copied.pixel_class;
        putPixel(warp, at, pixel_class, copied.colour, copied.inverse_depth);
        return 0;
    }
    if (kPlaced) { return sampleBelow(warp, at, pixel_class); }
    const Resolved resolved = resolveArrived(at, arrival);
    pixel_class = resolved.pixel_class;
    return putResolved(warp, row, at, resolved, false);
}

void listOpen(uint slot) {
    const uint bit = 1u << (slot & 31);
    if ((atomicOr(open_bits[slot / 32], bit) & bit) == 0) { open_tiles[atomicAdd(open_count, 1)] = slot; }
}

void countClass(uint x, uint pixel_class, inout uvec3 classes) {
    if (!kClasses) { return; }
    classes += uvec3(equal(uvec3(pixel_class), uvec3(kCovered, kGap, kHole)));
    if (pixel_class != kCovered) {
        atomicOr(tile_classes[x / kTileSize], pixel_class << (2 * (x % kTileSize)));
    }
}

uint errorSteps(float error) { return uint(min(error, kMaxPixelError) * kErrorSteps); }

// Lanes work side by side on a row of pixels of one or several tiles: every 16 share a `tile`.
void addErrors(uint tile, uint steps, uint lanes) {
    const uint slots = max(lanes / kTileSize, 1u);
    uint s = 0;
    [[dont_unroll]] do {
        const bool own = lanes < kTileSize || gl_SubgroupInvocationID / kTileSize == s;
        const uint sum = subgroupAdd(own ? steps : 0);
        if (gl_SubgroupInvocationID == s * kTileSize && sum > 0) {
            atomicAdd(pass.tile_errors.at[tile], sum);
        }
        ++s;
    }
    while (s < slots)
        ;
}

void hideTiles(uint y, uint first_tile, uint width) {
    for (uint x = gl_LocalInvocationIndex; x < width; x += kWarpGroup) {
        if (pass.tile_kinds.at[first_tile + x / kTileSize] != kTileHidden) { continue; }
        const uint i = y * width + x;
        putColour(pass.target, pass.half_target, i, vec4(pass.background, 0));
        if (keepsDepths()) { pass.depths.at[i] = 0; }
    }
}

void main() [[subgroup_uniform_control_flow]] {
    const WarpView warp = pass.warp.at[0];
    const uint y = pass.first_row + warp.rows_apart * spread(gl_WorkGroupID.x, gl_NumWorkGroups.x);
    if (y >= warp.size_px.y) { return; }  // the last row may be an even one
    const uint width = warp.size_px.x, tiles = warp.size_tiles.x;
    const uint row = y * warp.row_words;
    const uint first_tile = (y / kTileSize) * tiles;
    const uint thread = threadIndex(), lanes = laneCount();
    if (gl_LocalInvocationIndex == 0) {
        moved_count = 0;
        mean_count = 0;
        hidden_count = 0;
        open_count = 0;
    }
    if (!kPlaced) {
        if (gl_LocalInvocationIndex < (tiles + 31) / 32) { open_bits[gl_LocalInvocationIndex] = 0; }
        uint word = gl_LocalInvocationIndex;
        [[dont_unroll]] do {
            if (word < (width + 31) / 32) { arrived_bits[word] = 0; }
            word += kWarpGroup;
        }
        while (word < (width + 31) / 32)
            ;
    }
    if (kClasses) {
        for (uint tile = gl_LocalInvocationIndex; tile < tiles; tile += kWarpGroup) {
            tile_classes[tile] = 0;
        }
    }
    if (kMovesRow) {
        const uint end = min(width + 4, kSharedRow + 1);
        uint x = gl_LocalInvocationIndex;
        [[dont_unroll]] do {
            if (x < end) { row_arrivals[x] = 0; }
            x += kWarpGroup;
        }
        while (x < end)
            ;
    }
    barrier();
    listTiles(first_tile, tiles, pass.counters.at[0].moves != 0, mayBeMean(warp, y));
    barrier();
    const uint items = moved_count * kTileSize;
    if (kMovesRow) {
        if (items > 0) { moveRow(warp, y, width); }
        barrier();
    }
    if (!kPlaced) {
        if (items > 0) { loadRow(row, width); }
        memoryBarrierBuffer();  // colours may overwrite what was read
        barrier();
    }

    const bool predicts = predictsErrors(), finds_open = !kPlaced && !copiesColours();
    uvec3 classes = uvec3(0);
    uint begin = 0;
    [[dont_unroll]] do {
        const uint item = begin + thread, slot = item / kTileSize;
        const uint tile = item < items ? reprojected_tiles[slot] : tiles;
        const uint x = tile * kTileSize + item % kTileSize;
        uint steps = 0, arrival = 0;
        if (x < width) {
            if (!kPlaced) { arrival = arrivalAt(row, x); }
            if (finds_open && arrival == 0) {
                listOpen(slot);
            } else {
                uint pixel_class;
                steps = errorSteps(putReached(warp, row, uvec2(x, y), arrival, pixel_class));
                countClass(x, pixel_class, classes);
            }
        }
        if (predicts) { addErrors(first_tile + tile, steps, lanes); }
        begin += kWarpGroup;
    }
    while (begin < items)
        ;
    if (finds_open) {
        barrier();
        const uint open_items = open_count * kTileSize;
        begin = 0;
        [[dont_unroll]] do {
            const uint item = begin + thread;
            const uint tile = item < open_items ? reprojected_tiles[open_tiles[item / kTileSize]] : tiles,
                       x = tile * kTileSize + item % kTileSize;
            uint steps = 0;
            if (x < width && arrivalAt(row, x) == 0) {
                const Resolved resolved = resolveOpen(warp, row, uvec2(x, y));
                steps = errorSteps(putResolved(warp, row, uvec2(x, y), resolved, true));
                countClass(x, resolved.pixel_class, classes);
            }
            if (predicts) { addErrors(first_tile + tile, steps, lanes); }
            begin += kWarpGroup;
        }
        while (begin < open_items)
            ;
    }
    if (mean_count > 0) { putMeans(y, width, tiles); }
    if (hidden_count > 0) { hideTiles(y, first_tile, width); }
    if (!kClasses) { return; }
    barrier();
    for (uint tile = gl_LocalInvocationIndex; tile < tiles; tile += kWarpGroup) {
        pass.pixel_classes.at[y * tiles + tile] = tile_classes[tile];
    }
    // Counted as if no tile were chosen yet: the even rows count for the odd ones.
    classes *= warp.rows_apart == 1 ? 1 : pass.first_row == 0 ? min(2, warp.size_px.y - y) : 0;
    const uint covered = subgroupAdd(classes.x), gaps = subgroupAdd(classes.y),
               holes = subgroupAdd(classes.z);
    if (subgroupElect()) {
        if (covered > 0) { atomicAdd(pass.counters.at[0].covered_pixels, covered); }
        if (gaps > 0) { atomicAdd(pass.counters.at[0].gap_pixels, gaps); }
        if (holes > 0) { atomicAdd(pass.counters.at[0].hole_pixels, holes); }
        if (groupsHoles() && holes > 0) {
            atomicOr(pass.counters.at[0].component_groups.x, warp.size_tiles.x);
            atomicOr(pass.counters.at[0].component_groups.y, 2 * warp.size_tiles.y);
            atomicOr(pass.counters.at[0].component_groups.z, 1);
        }
    }
}
