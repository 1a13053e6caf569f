// warp_past: an eye's picture from the one that it showed before, and what each tile has gone wrong by so far. A workgroup makes 32x64 pixels, a
// thread a block of 4x8. Where a block's places in the past lie as its pixels do, shifted and a little turned, its thread goes over the source
// pixels row by row and resamples first along the row, then along columns, so that each is read once. The pixels of other blocks, where
// depths differ or the past ends, are listed and made one by one.
//
// A place is found backwards, by a fixed point (Bowles et al. 2012, Iterative Image Warping): the depth at a place says where the place is.
// Such a search always finds something, so that a place counts only if the past's pixel there, moved forwards, meets the pixel that it is
// wanted for. Of what is found from the nearest and from the farthest depth around the nearer counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"

layout(constant_id = 0) const bool kHalfColours = false;
layout(constant_id = 1) const bool kDepth = false;
layout(constant_id = 2) const bool kHiddenTiles = false;  // a lens hides parts

layout(local_size_x = kPastGroup) in;
layout(push_constant, scalar) uniform Push { WarpPastPass pass; };

#include "lib/tile_mask.glsl"
#include "lib/picture.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/move_pixel.glsl"
#include "lib/lagrange.glsl"
#include "lib/cubic.glsl"

const uvec2 kRegion = uvec2(kPastColumns, kPastRows) * 8;  // 8x8 blocks
const uvec2 kBlock = uvec2(kPastColumns, kPastRows);
const uvec2 kRegionTiles = kRegion / kTileSize, kRegionCells = kRegion / kCellSize;
const uint kRegionBlocks = 8;
const int kColumns = int(kPastColumns), kRows = int(kPastRows);

shared uint listed_pixels[kRegion.x * kRegion.y];  // y << 16 | x
shared uint listed_count;
shared vec2 block_depths[kPastGroup];  // the least and the greatest inverse depth in and around a block
shared uint cell_grown[kRegionCells.x * kRegionCells.y];    // sums of what this step is expected to lose, squared, in kErrorSteps
shared uint cell_carried[kRegionCells.x * kRegionCells.y];  // the greatest error of where a cell comes from, as bits

bool isInPast(PastView view, vec2 place_px) { return all(greaterThanEqual(place_px, vec2(0))) && all(lessThan(place_px, vec2(view.past_size_px))); }

// What the past shows at a place.
struct Seen {
    uint word;  // lib/moving_pixel.glsl
    float inverse_depth;  // as the picture that is made sees it
    vec2 off_px;          // where that pixel's middle comes to lie, less where `wanted_px` is
};

uint wordAt(PastView view, vec2 place_px) {
    const uvec2 at = uvec2(clamp(place_px, vec2(0), vec2(view.past_size_px) - 1));
    const bool hidden = kHiddenTiles && !isInMask(pass.shown_mask, view.past_size_tiles, at / kTileSize);
    return hidden ? 0 : pass.source_words.at[at.y * view.past_size_px.x + at.x];
}

Seen look(PastView view, vec2 place_px, vec2 wanted_px) {
    const uint word = wordAt(view, place_px);
    const vec2 middle_px = floor(place_px) + 0.5;
    const float inverse_depth = word == 0 ? 0 : inverseDepthOf(word);
    const vec3 moves = moveOfPixel(view.now_from_past, middle_px, inverse_depth);
    return Seen(moves.z > 0 ? word : 0, inverse_depth / max(moves.z, 1e-6), (middle_px - wanted_px) + moves.xy);
}

// How far a place in the past moves for a unit of inverse depth.
vec2 disparity(PastView view, vec2 pixel_px) { return view.past_from_now.shift.xy - pixel_px * view.past_from_now.shift.z; }

// The amplitude of what an uncertain depth costs. `across` and `down`: how the picture changes from pixel to pixel.
vec2 uncertainMove(vec2 disparity_px, float spread) {
    const vec2 move_px = disparity_px * spread;
    const float length_px = length(move_px);
    return length_px > kMaxSpread ? move_px * (kMaxSpread / length_px) : move_px;
}

bool isHidden(PastView view, uvec2 pixel) {
    return kHiddenTiles && !isInMask(pass.shown_mask, view.size_tiles, pixel / kTileSize);
}

void putWord(PastView view, uvec2 pixel, uint word) {
    if (any(greaterThanEqual(pixel, view.size_px))) { return; }
    pass.target_words.at[pixel.y * view.size_px.x + pixel.x] = isHidden(view, pixel) ? 0 : word;
}

// Once its word is there.
void putPixel(PastView view, uvec2 pixel, vec4 colour) {
    if (any(greaterThanEqual(pixel, view.size_px))) { return; }
    const uint at = pixel.y * view.size_px.x + pixel.x;
    const vec4 shown = isHidden(view, pixel) ? vec4(pass.background, 0) : colour;
    putColour(pass.target, pass.half_target, at, shown);
    if (kDepth) {
        const uint word = pass.target_words.at[at];
        const float inverse_depth = word == 0 ? 0 : inverseDepthOf(word);
        pass.depths.at[at] = inverse_depth > 0 ? shown.a / inverse_depth : 0;
    }
}

// How a block's pixels lie in the past, less how they lie in the block: from its middle, by column and by row.
struct BlockMoves {
    vec2 mean;
    vec2 across, down;  // how that changes from column to column and from row to row
};

// The squared error that one pixel of a block is expected to take on in this step.
float lossAt(ivec2 at, ivec2 last, vec2 shares, vec2 uncertain_px) {
    vec3 lost_across = vec3(0), lost_down = vec3(0), change = vec3(0);
    [[unroll]] for (int k = 0; k < int(kTaps); ++k) {
        const vec3 across = sourceAt(uint(at.y * (last.x + 1) + clamp(at.x + k - 2, 0, last.x))).rgb;
        const vec3 down = k == 2 ? across : sourceAt(uint(clamp(at.y + k - 2, 0, last.y) * (last.x + 1) + at.x)).rgb;
        lost_across += kFifthDifference[k] * across;
        lost_down += kFifthDifference[k] * down;
        if (k == 1) { change -= 0.5 * (uncertain_px.x * across + uncertain_px.y * down); }
        if (k == 3) { change += 0.5 * (uncertain_px.x * across + uncertain_px.y * down); }
    }
    lost_across *= shares.x;
    lost_down *= shares.y;
    const float amplitude = sqrt(dot(lost_across, lost_across) + dot(lost_down, lost_down)) + length(change);
    return min(amplitude * amplitude, kMaxPixelError);
}

// Resamples the block.
void resampleBlock(PastView view, uvec2 first, BlockMoves moves, ivec2 last) {
    float weights_y[kColumns][kTaps];  // by column
    const int base_y = int(floor(moves.mean.y));
    const float fract_y = moves.mean.y - float(base_y);
    [[unroll]] for (int c = 0; c < kColumns; ++c) {
        const float beside = float(c) - 0.5 * float(kColumns - 1);
        lagrangeWeights(clamp(moves.mean.y + beside * moves.across.y - float(base_y), 0, 1), weights_y[c]);
    }
    vec4 sums[kTaps][kColumns];  // of the rows that the source rows so far go into, the next that is complete first
    [[unroll]] for (int k = 0; k < int(kTaps); ++k) {
        [[unroll]] for (int c = 0; c < kColumns; ++c) { sums[k][c] = vec4(0); }
    }
    int row = 1 - int(kTaps);  // of the block, that is complete once its last source row is there
    [[dont_unroll]] do {
        // As far from the block's middle as the source row comes to lie.
        const float from_middle = float(row + 3) - fract_y - 0.5 * float(kRows - 1);
        const float move_x = moves.mean.x + from_middle * moves.down.x;
        const float base_x = floor(move_x);
        float weights_x[kTaps];
        lagrangeWeights(move_x - base_x, weights_x);
        const int y = clamp(int(first.y) + base_y + row + 3, 0, last.y), x = int(first.x) + int(base_x) - 2;
        vec4 across[kColumns];
        [[unroll]] for (int c = 0; c < kColumns; ++c) { across[c] = vec4(0); }
        [[unroll]] for (int t = 0; t < kColumns + int(kTaps) - 1; ++t) {
            const vec4 tap = sourceAt(uint(y * (last.x + 1) + clamp(x + t, 0, last.x)));
            [[unroll]] for (int c = 0; c < kColumns; ++c) {
                if (t >= c && t < c + int(kTaps)) { across[c] += weights_x[t - c] * tap; }
            }
        }
        [[unroll]] for (int c = 0; c < kColumns; ++c) {
            const vec4 complete = sums[0][c] + weights_y[c][kTaps - 1] * across[c];
            [[unroll]] for (int k = 1; k < int(kTaps); ++k) { sums[k - 1][c] = sums[k][c] + weights_y[c][kTaps - 1 - k] * across[c]; }
            sums[kTaps - 1][c] = vec4(0);
            if (row >= 0) { putPixel(view, first + uvec2(c, row), max(complete, vec4(0))); }
        }
        ++row;
    } while (row < kRows);
}

bool isHiddenInPast(PastView view, ivec2 at) {
    return kHiddenTiles && !isInMask(pass.shown_mask, view.past_size_tiles, uvec2(at) / kTileSize);
}

// Looks where the block's pixels come from: near its middle's place, since in a frame the head moves little. Whether they lie in the past as
// in a picture that is shifted and a little turned; then their depths are written.
bool findBlock(PastView view, uvec2 first, ivec2 last, out BlockMoves moves, out vec2 depths, out vec2 source_px, out float spread) {
    const vec2 half_size = 0.5 * vec2(kBlock), middle_px = vec2(first) + half_size;
    const float guess = look(view, movePixelAnywhere(view.past_from_now, middle_px, 0).xy, middle_px).inverse_depth;
    const vec3 move = moveOfPixel(view.past_from_now, middle_px, guess);
    moves.across = (moveOfPixel(view.past_from_now, middle_px + vec2(half_size.x, 0), guess).xy - move.xy) / half_size.x;
    moves.down = (moveOfPixel(view.past_from_now, middle_px + vec2(0, half_size.y), guess).xy - move.xy) / half_size.y;
    const vec2 by_depth = disparity(view, middle_px);
    source_px = middle_px + move.xy;
    const ivec2 corner = ivec2(floor(clamp(source_px, vec2(-1e6), vec2(1e6)) + 0.5)) - ivec2(kBlock) / 2, end = corner + ivec2(kBlock) - 1;
    const float depth_there = 1 + dot(view.now_from_past.excess_z, vec3(source_px, 1));
    bool valid = move.z > 0 && all(greaterThanEqual(corner, ivec2(0))) && all(lessThanEqual(end, last));
    valid = valid && !isHiddenInPast(view, clamp(corner, ivec2(0), last)) && !isHiddenInPast(view, clamp(end, ivec2(0), last));
    depths = vec2(3e38, 0);
    float in_columns[kColumns], sum = 0, lower = 0;
    uint spread_bits = 0;
    [[unroll]] for (int c = 0; c < kColumns; ++c) { in_columns[c] = 0; }
    [[unroll]] for (int r = 0; r < kRows; ++r) {
        const int row = clamp(corner.y + r, 0, last.y) * (last.x + 1);
        float in_row = 0;
        [[unroll]] for (int c = 0; c < kColumns; ++c) {
            const uint word = pass.source_words.at[row + clamp(corner.x + c, 0, last.x)];
            const float there = inverseDepthOf(word), here = there / (depth_there + view.now_from_past.shift.z * there);
            valid = valid && word != 0;
            putWord(view, first + uvec2(c, r), movingPixel(here, kLanded, word & kSpreadBits));
            spread_bits = max(spread_bits, word & kSpreadBits);
            depths = vec2(min(depths.x, here), max(depths.y, here));
            in_columns[c] += here;
            in_row += here;
        }
        sum += in_row;
        lower += r < kRows / 2 ? -in_row : in_row;
    }
    const float differ = 0.5 * (depths.y - depths.x);
    // What stands in front of its neighbours may have come before this block.
    [[unroll]] for (int side = 0; side < 9; ++side) {
        if (side == 4) { continue; }
        const ivec2 at = clamp((corner + end + 1) / 2 + ivec2(side % 3 - 1, side / 3 - 1) * (ivec2(kBlock) / 2 + int(kPastBorder)), ivec2(0), last);
        const uint word = pass.source_words.at[at.y * (last.x + 1) + at.x];
        const float there = word == 0 ? 0 : inverseDepthOf(word), here = there / (depth_there + view.now_from_past.shift.z * there);
        depths = vec2(min(depths.x, here), max(depths.y, here));
    }
    const float pixels = float(kColumns * kRows), right = in_columns[2] + in_columns[3] - in_columns[0] - in_columns[1];
    moves.mean = move.xy + by_depth * (sum / pixels - guess);
    const vec2 across = moves.across, down = moves.down;
    moves.across += by_depth * (4 * right / (pixels * float(kColumns)));
    moves.down += by_depth * (4 * lower / (pixels * float(kRows)));
    spread = kSpreadWeight * sqrt(varianceShareOf(spread_bits)) * depths.y + 0.5 * (depths.y - depths.x);
    const float farthest = max(abs(by_depth.x), abs(by_depth.y));
    const vec2 apart = 0.5 * vec2(kBlock - 1) * abs(vec2(across.x, down.y));
    return valid && max(max(apart.x, apart.y), farthest * differ) <= kPastSmooth && farthest * (depths.y - depths.x) <= kPastSameDepth;
}

// Where the past shows what is wanted, from a first guess; whether it does.
bool search(PastView view, vec2 wanted_px, float guess, out Seen seen, out vec2 place_px) {
    float inverse_depth = guess;
    bool found = false, inside = true;
    place_px = wanted_px;
    seen = Seen(0, guess, vec2(0));
    [[unroll]] for (uint step = 0; step < kPastSteps; ++step) {
        if (!found && inside) {
            const vec3 place = movePixelAnywhere(view.past_from_now, wanted_px, inverse_depth);
            place_px = place.xy;
            inside = place.z > 0 && isInPast(view, place_px);
            if (inside) {
                seen = look(view, place_px, wanted_px);
                found = seen.word != 0 && max(abs(seen.off_px.x), abs(seen.off_px.y)) <= kPastAgrees;
                inverse_depth = seen.inverse_depth;
            }
        }
    }
    if (found) { place_px = movePixelAnywhere(view.past_from_now, wanted_px, inverse_depth).xy; }
    return found;
}

// A pixel by itself. Its expected squared error.
float makePixel(PastView view, uvec2 pixel, vec2 depths) {
    const vec2 wanted_px = vec2(pixel) + 0.5;
    Seen from_near, from_far;
    vec2 near_px, far_px;
    const bool near_found = search(view, wanted_px, depths.y, from_near, near_px);
    const bool far_found = search(view, wanted_px, depths.x, from_far, far_px);
    const bool takes_near = near_found && (!far_found || from_near.inverse_depth >= from_far.inverse_depth);
    Seen seen = from_far;
    if (takes_near) { seen = from_near; }
    const vec2 place_px = takes_near ? near_px : far_px;
    const vec2 disparity_px = disparity(view, wanted_px);
    const bool found = near_found || far_found;
    const float own = kSpreadWeight * sqrt(varianceShareOf(seen.word)) * seen.inverse_depth;
    const vec2 uncertain_px = uncertainMove(disparity_px, own + 0.5 * (depths.y - depths.x));
    const Sample one = sampleAround(place_px, ivec2(view.past_size_px), uncertain_px);
    putWord(view, pixel, movingPixel(seen.inverse_depth, kLanded, seen.word & kSpreadBits));
    putPixel(view, pixel, one.colour);
    const float amplitude = sqrt(one.lost) + length(one.gradient);
    return found ? min(amplitude * amplitude, kMaxPixelError) : kUnseenError;
}

void main() {
    const PastView view = pass.view.at[0];
    const ivec2 last = ivec2(view.past_size_px) - 1;
    const uint thread = gl_LocalInvocationIndex;
    const uvec2 region = gl_WorkGroupID.xy * kRegion;
    const uvec2 block = uvec2(thread % kRegionBlocks, thread / kRegionBlocks);
    const uvec2 first = region + block * kBlock;
    const uvec2 in_cells = block * kBlock / kCellSize;
    const uint cell = in_cells.y * kRegionCells.x + in_cells.x;

    // For the passes that choose.
    const uint all_threads = gl_NumWorkGroups.x * gl_NumWorkGroups.y * kPastGroup;
    const uint own = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kPastGroup + thread;
    for (uint i = own; i < maskWords(view.size_tiles) * view.size_tiles.y; i += all_threads) { pass.tile_mask.at[i] = 0; }
    if (any(notEqual(uvec2(pass.price_bins), uvec2(0)))) {
        for (uint i = own; i < kPriceBins; i += all_threads) { pass.price_bins.at[i] = 0; }
    }

    if (thread == 0) { listed_count = 0; }
    if (thread < kRegionCells.x * kRegionCells.y) { cell_grown[thread] = cell_carried[thread] = 0; }
    barrier();
    if (all(lessThan(first, view.size_px))) {
        BlockMoves moves;
        vec2 depths, source_px;
        float spread;
        const bool as_one = findBlock(view, first, last, moves, depths, source_px, spread);
        if (isInPast(view, source_px)) {
            const uvec2 at = uvec2(source_px), tile = at / kTileSize, quarter = at % kTileSize / kCellSize;
            const float carried = pass.source_tiles.at[tile.y * view.past_size_tiles.x + tile.x].errors[2 * quarter.y + quarter.x];
            atomicMax(cell_carried[cell], floatBitsToUint(carried));
        }
        if (as_one) {
            const vec2 uncertain_px = uncertainMove(disparity(view, vec2(first)), spread);
            const vec2 shares = vec2(lostShare(fract(moves.mean.x)), lostShare(fract(moves.mean.y)));
            const ivec2 corner = ivec2(floor(source_px)) - ivec2(kBlock) / 2;
            float grown = 0;
            [[unroll]] for (int i = 0; i < 2; ++i) {
                grown += lossAt(clamp(corner + ivec2(1 + i, 2 + 3 * i), ivec2(0), last), last, shares, uncertain_px);
            }
            // What lies between the two may be worse, unless nothing moves.
            const float least = any(notEqual(moves.mean, vec2(0))) ? kLeastGrowth : 0;
            atomicAdd(cell_grown[cell], uint(float(kColumns * kRows) * max(0.5 * grown, least) * kErrorSteps));
            resampleBlock(view, first, moves, last);
        } else {
            block_depths[thread] = depths;
            const uvec2 size = min(kBlock, view.size_px - first);
            uint place = atomicAdd(listed_count, size.x * size.y);
            for (uint y = 0; y < size.y; ++y) {
                for (uint x = 0; x < size.x; ++x) { listed_pixels[place++] = (block.y * kBlock.y + y) << 16 | (block.x * kBlock.x + x); }
            }
        }
    }
    groupMemoryBarrier();  // what a block wrote of its pixels' depths is written again
    barrier();
    uint i = thread;
    if (i < listed_count) {
        [[dont_unroll]] do {
            const uvec2 in_region = uvec2(listed_pixels[i] & 0xffffu, listed_pixels[i] >> 16);
            const uvec2 its_block = in_region / kBlock, its_cell = in_region / kCellSize;
            const float grown = makePixel(view, region + in_region, block_depths[its_block.y * kRegionBlocks + its_block.x]);
            atomicAdd(cell_grown[its_cell.y * kRegionCells.x + its_cell.x], uint(grown * kErrorSteps));
            i += kPastGroup;
        } while (i < listed_count);
    }
    barrier();
    if (thread >= kRegionTiles.x * kRegionTiles.y) { return; }
    const uvec2 its_tile = uvec2(thread % kRegionTiles.x, thread / kRegionTiles.x), tile = gl_WorkGroupID.xy * kRegionTiles + its_tile;
    if (any(greaterThanEqual(tile, view.size_tiles))) { return; }
    // What rendering the tile takes and how fast it goes wrong are those of where its middle comes from.
    const vec2 middle_px = min(vec2(tile * kTileSize) + 0.5 * float(kTileSize), vec2(view.size_px));
    const float guess = look(view, movePixelAnywhere(view.past_from_now, middle_px, 0).xy, middle_px).inverse_depth;
    const uvec2 from = uvec2(clamp(movePixelAnywhere(view.past_from_now, middle_px, guess).xy, vec2(0), vec2(view.past_size_px) - 1)) / kTileSize;
    const PastTile before = pass.source_tiles.at[from.y * view.past_size_tiles.x + from.x];
    PastTile now = PastTile(before.cost, before.age + 1, before.growth, vec4(0));
    [[unroll]] for (uint q = 0; q < 4; ++q) {
        const uvec2 at = its_tile * (kTileSize / kCellSize) + uvec2(q & 1, q >> 1);
        const uint its_cell = at.y * kRegionCells.x + at.x;
        // An amplitude of a pixel's channel. Blur of what is blurred already adds to it as an amplitude.
        const float grown = sqrt(float(cell_grown[its_cell]) / (kErrorSteps * 3 * kCellSize * kCellSize));
        now.errors[q] = uintBitsToFloat(cell_carried[its_cell]) + mix(grown, before.growth, kMeasuredShare * float(before.growth > 0 && grown < kUnseenGrowth ? 1 : 0));
    }
    const uint at = tile.y * view.size_tiles.x + tile.x;
    pass.tiles.at[at] = now;
    if (!kHiddenTiles || pass.tile_kinds.at[at] != kTileHidden) { pass.tile_kinds.at[at] = 0; }  // nobody has written it yet where none is hidden
}
