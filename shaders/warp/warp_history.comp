// warp_history: warps the picture that an eye showed before, and predicts each tile's error. A workgroup
// makes 128x16 pixels, and each thread a block of 4x8. If the places of a block's pixels in the history are
// just shifted and slightly rotated, its thread goes over the source pixels row by row and resamples first
// along the row, then along columns, so that each pixel is read once. Other blocks, where depths differ or
// the history ends, are listed for warp_pixels: few workgroups have many of them, and the rest would wait for
// those.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"

layout(constant_id = 0) const bool kHalfColours = false;
layout(constant_id = 1) const bool kHiddenTiles = false;  // a lens hides parts
layout(constant_id = 2) const bool kWholeBlocks = false;  // the picture's width is a multiple of a block's
layout(constant_id = 3) const bool kByAddress = false;    // lib/history.glsl; for software devices

layout(local_size_x = kHistoryGroup) in;
layout(push_constant, scalar) uniform Push { WarpHistoryPass pass; };

#include "lib/tile_mask.glsl"
#include "lib/picture.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/move_pixel.glsl"
#include "lib/history.glsl"
#include "lib/six_taps.glsl"

const uint kTileBlocks = kTileSize / kHistoryColumns, kRegionBlocks = kHistoryTiles * kTileBlocks;  // across
const uvec2 kRegionCells = uvec2(kHistoryTiles, 1) * (kTileSize / kCellSize);
const int kColumns = int(kHistoryColumns), kRows = int(kHistoryRows);

shared uint listed_count, listed_first;  // this workgroup's part of the list of blocks
// Squared errors expected of this step, summed, in kErrorSteps.
shared uint cell_grown[kRegionCells.x * kRegionCells.y];
shared uint tile_squared_gradient[kHistoryTiles];
// Where the blocks of a cell come from: squares of the history's errors, and how fast they grow, summed in
// kCarriedSteps.
shared uint cell_carried[kRegionCells.x * kRegionCells.y], cell_growth[kRegionCells.x * kRegionCells.y];

// The offsets from a block's pixels to their places in the history: in its middle, and how they change.
struct BlockMoves {
    vec2 mean;
    vec2 across, down;  // from column to column and from row to row
};

// A row of a block, in 16-byte stores if it begins at a multiple of 16 bytes.
void putWords(HistoryView view, uvec2 first, uvec4 words) {
    if (first.y >= view.size_px.y) { return; }
    if (kWholeBlocks) {
        const uint at = (first.y * view.size_px.x + first.x) / kHistoryColumns;
        putSixteen(uvec2(pass.target_words), at, isHidden(view, first) ? uvec4(0) : words);
        return;
    }
    [[unroll]] for (uint c = 0; c < kHistoryColumns; ++c) {
        if (first.x + c < view.size_px.x) { putWord(view, first + uvec2(c, 0), words[c]); }
    }
}

void putPixels(HistoryView view, uvec2 first, vec4 colours[kHistoryColumns]) {
    if (first.y >= view.size_px.y) { return; }
    if (kWholeBlocks && kHalfColours) {
        const bool hidden = isHidden(view, first);
        const uint at = (first.y * view.size_px.x + first.x) / 2;
        [[unroll]] for (uint c = 0; c < kHistoryColumns; c += 2) {
            const vec4 left = hidden ? vec4(view.background, 0) : colours[c],
                       right = hidden ? vec4(view.background, 0) : colours[c + 1];
            putSixteen(uvec2(pass.target), at + c / 2, uvec4(packHalves(left), packHalves(right)));
        }
        return;
    }
    [[unroll]] for (uint c = 0; c < kHistoryColumns; ++c) {
        if (kWholeBlocks || first.x + c < view.size_px.x) { putPixel(view, first + uvec2(c, 0), colours[c]); }
    }
}

// The squared error that one pixel of a block is expected to gain in this step.
float lossAt(ivec2 at, ivec2 last, vec2 shares, vec2 uncertain_px, out float squared_gradient) {
    vec3 downs[kTaps];
    [[unroll]] for (int k = 0; k < int(kTaps); ++k) {
        downs[k] = sourceAt(uint(clamp(at.y + k - 2, 0, last.y) * (last.x + 1) + at.x)).rgb;
    }
    vec3 lost_across = vec3(0), lost_down = vec3(0), slope_across = vec3(0), slope_down = vec3(0);
    [[unroll]] for (int k = 0; k < int(kTaps); ++k) {
        const vec3 across =
            k == 2 ? downs[k] : sourceAt(uint(at.y * (last.x + 1) + clamp(at.x + k - 2, 0, last.x))).rgb;
        const vec3 down = downs[k];
        lost_across += kFifthDifference[k] * across;
        lost_down += kFifthDifference[k] * down;
        if (k == 1 || k == 3) {
            slope_across += (k == 1 ? -0.5 : 0.5) * across;
            slope_down += (k == 1 ? -0.5 : 0.5) * down;
        }
    }
    squared_gradient = dot(slope_across, slope_across) + dot(slope_down, slope_down);
    lost_across *= shares.x;
    lost_down *= shares.y;
    const float amplitude = sqrt(dot(lost_across, lost_across) + dot(lost_down, lost_down)) +
                            length(uncertain_px.x * slope_across + uncertain_px.y * slope_down);
    return min(amplitude * amplitude, kMaxPixelError);
}

// Resamples the block.
void resampleBlock(HistoryView view, uvec2 first, BlockMoves moves, ivec2 last) {
    float weights_y[kColumns][kTaps];  // by column
    const int base_y = int(floor(moves.mean.y));
    const float fract_y = moves.mean.y - float(base_y);
    [[unroll]] for (int c = 0; c < kColumns; ++c) {
        const float beside = float(c) - 0.5 * float(kColumns - 1);
        sixTapWeights(clamp(moves.mean.y + beside * moves.across.y - float(base_y), 0, 1), weights_y[c]);
    }
    // Sums for the block's rows to which the source rows so far contribute; the first one is completed first.
    vec4 sums[kTaps][kColumns];
    [[unroll]] for (int k = 0; k < int(kTaps); ++k) {
        [[unroll]] for (int c = 0; c < kColumns; ++c) { sums[k][c] = vec4(0); }
    }
    int row = 1 - int(kTaps);  // the block's row that this source row completes
    [[dont_unroll]] do {
        [[dont_unroll]] do {
            // How far from the block's middle the source row lands.
            const float from_middle = float(row + 3) - fract_y - 0.5 * float(kRows - 1);
            const float move_x = moves.mean.x + from_middle * moves.down.x;
            const float base_x = floor(move_x);
            float weights_x[kTaps];
            sixTapWeights(move_x - base_x, weights_x);
            const int y = clamp(int(first.y) + base_y + row + 3, 0, last.y);
            const int begin = y * (last.x + 1), end = begin + last.x,
                      x = begin + int(first.x) + int(base_x) - 2;
            vec4 across[kColumns];
            [[unroll]] for (int c = 0; c < kColumns; ++c) { across[c] = vec4(0); }
            [[unroll]] for (int t = 0; t < kColumns + int(kTaps) - 1; ++t) {
                const vec4 tap = sourceAt(uint(clamp(x + t, begin, end)));
                [[unroll]] for (int c = 0; c < kColumns; ++c) {
                    if (t >= c && t < c + int(kTaps)) { across[c] += weights_x[t - c] * tap; }
                }
            }
            [[unroll]] for (int c = 0; c < kColumns; ++c) {
                [[unroll]] for (int k = 1; k < int(kTaps); ++k) {
                    sums[k - 1][c] = sums[k][c] + weights_y[c][kTaps - k] * across[c];
                }
                sums[kTaps - 1][c] = weights_y[c][0] * across[c];
            }
            ++row;
        }
        while (row <= 0)
            ;
        vec4 complete[kColumns];
        [[unroll]] for (int c = 0; c < kColumns; ++c) { complete[c] = max(sums[0][c], vec4(0)); }
        putPixels(view, first + uvec2(0, row - 1), complete);
    }
    while (row < kRows)
        ;
}

// The inverse depth of content that lands at a place but was so far away in the history that it is not among
// its neighbours; 0 if nothing is in front of `known`.
float nearestOnTheWay(HistoryView view, vec2 wanted_px, vec2 by_depth, float known) {
    const float px_by_depth = max(abs(by_depth.x), abs(by_depth.y));
    const uint steps = min(uint(px_by_depth * view.nearest / kHistorySearchStep), kHistoryMostSearched);
    float nearest = 0;
    for (uint i = 1; i <= steps; ++i) {
        const float inverse_depth = float(i) * kHistorySearchStep / px_by_depth;
        const vec3 place = movePixelAnywhere(view.history_from_now, wanted_px, inverse_depth);
        if (place.z <= 0 || !isInHistory(view, place.xy)) { continue; }
        const Seen seen = look(view, place.xy, wanted_px);
        const bool comes =
            seen.word != 0 && max(abs(seen.off_px.x), abs(seen.off_px.y)) <= kHistorySearchStep;
        if (comes && px_by_depth * (seen.inverse_depth - known) > 1) {
            nearest = max(nearest, seen.inverse_depth);
        }
    }
    return nearest;
}

// Looks for where the block's pixels come from: close to the place of its middle, since the head moves little
// within a frame. True if they lie in the history as in a picture that is shifted and slightly rotated. Also
// writes their depths, which are valid in that case.
bool findBlock(HistoryView view, uvec2 first, ivec2 last, out BlockMoves moves, out vec2 depths,
               out vec2 source_px, out float spread) {
    const vec2 half_size = 0.5 * vec2(kBlock), middle_px = vec2(first) + half_size;
    const float guess =
        look(view, movePixelAnywhere(view.history_from_now, middle_px, 0).xy, middle_px).inverse_depth;
    const vec3 move = moveOfPixel(view.history_from_now, middle_px, guess);
    moves.across =
        (moveOfPixel(view.history_from_now, middle_px + vec2(half_size.x, 0), guess).xy - move.xy) /
        half_size.x;
    moves.down = (moveOfPixel(view.history_from_now, middle_px + vec2(0, half_size.y), guess).xy - move.xy) /
                 half_size.y;
    const vec2 by_depth = disparity(view, middle_px);
    source_px = middle_px + move.xy;
    const ivec2 corner = ivec2(floor(clamp(source_px, vec2(-1e6), vec2(1e6)) + 0.5)) - ivec2(kBlock) / 2,
                end = corner + ivec2(kBlock) - 1;
    const float depth_there = 1 + dot(view.now_from_history.excess_z, vec3(source_px, 1));
    bool valid = move.z > 0 && all(greaterThanEqual(corner, ivec2(0))) && all(lessThanEqual(end, last));
    valid = valid && !reachesHidden(view, corner, end);
    depths = vec2(3e38, 0);
    float in_columns[kColumns], sum = 0, lower = 0;
    uint spread_bits = 0;
    [[unroll]] for (int c = 0; c < kColumns; ++c) { in_columns[c] = 0; }
    uint there_words[kColumns][kRows];
    [[unroll]] for (int c = 0; c < kColumns; ++c) {
        [[unroll]] for (int r = 0; r < kRows; ++r) {
            there_words[c][r] =
                pass.source_words
                    .at[clamp(corner.y + r, 0, last.y) * (last.x + 1) + clamp(corner.x + c, 0, last.x)];
        }
    }
    [[unroll]] for (int r = 0; r < kRows; ++r) {
        float in_row = 0;
        uvec4 words;
        [[unroll]] for (int c = 0; c < kColumns; ++c) {
            const uint word = there_words[c][r];
            const float there = inverseDepthOf(word),
                        here = there / (depth_there + view.now_from_history.shift.z * there);
            valid = valid && word != 0;
            words[c] = movingPixel(here, kLanded, word & kSpreadBits);
            spread_bits = max(spread_bits, word & kSpreadBits);
            depths = vec2(min(depths.x, here), max(depths.y, here));
            in_columns[c] += here;
            in_row += here;
        }
        putWords(view, first + uvec2(0, r), words);
        sum += in_row;
        lower += r < kRows / 2 ? -in_row : in_row;
    }
    const float differ = 0.5 * (depths.y - depths.x);
    // Content in front of neighbouring blocks may have moved in front of this one.
    [[unroll]] for (int side = 0; side < 9; ++side) {
        if (side == 4) { continue; }
        const ivec2 at = clamp((corner + end + 1) / 2 + ivec2(side % 3 - 1, side / 3 - 1) *
                                                            (ivec2(kBlock) / 2 + int(kHistoryBorder)),
                               ivec2(0), last);
        const uint word = pass.source_words.at[at.y * (last.x + 1) + at.x];
        const float there = word == 0 ? 0 : inverseDepthOf(word),
                    here = there / (depth_there + view.now_from_history.shift.z * there);
        depths = vec2(min(depths.x, here), max(depths.y, here));
    }
    depths.y = max(depths.y, nearestOnTheWay(view, middle_px, by_depth, depths.y));
    // What is found there must belong there: it must land where it was looked for.
    const float pixels = float(kColumns * kRows),
                off_px = max(abs(by_depth.x), abs(by_depth.y)) * abs(sum / pixels - guess);
    valid = valid && off_px <= kHistoryAgrees;
    const float right = in_columns[2] + in_columns[3] - in_columns[0] - in_columns[1];
    moves.mean = move.xy + by_depth * (sum / pixels - guess);
    const vec2 across = moves.across, down = moves.down;
    moves.across += by_depth * (4 * right / (pixels * float(kColumns)));
    moves.down += by_depth * (4 * lower / (pixels * float(kRows)));
    spread = kSpreadWeight * sqrt(varianceShareOf(spread_bits)) * depths.y + 0.5 * (depths.y - depths.x);
    const float farthest = max(abs(by_depth.x), abs(by_depth.y));
    const vec2 apart = 0.5 * vec2(kBlock - 1) * abs(vec2(across.x, down.y));
    return valid && max(max(apart.x, apart.y), farthest * differ) <= kHistorySmooth &&
           farthest * (depths.y - depths.x) <= kHistorySameDepth;
}

// Workgroups of warp_pixels over this many blocks.
uint pixelGroups(uint blocks) {
    const uint pixels = blocks * kBlock.x * kBlock.y;
    return min(pixels / kGroupSize + uint(pixels % kGroupSize != 0), kMaxGroupsX);
}

// The workgroup's tile `i`: outside the picture if there are no more.
uvec2 tileOfRegion(uint i) { return uvec2(gl_WorkGroupID.x * kHistoryTiles + i, gl_WorkGroupID.y); }

void main() {
    const HistoryView view = pass.view.at[0];
    const ivec2 last = ivec2(view.history_size_px) - 1;
    const uint thread = gl_LocalInvocationIndex;
    const uvec2 block = uvec2(thread % kRegionBlocks, thread / kRegionBlocks);
    const uvec2 own_tile = tileOfRegion(block.x / kTileBlocks);
    const uvec2 first = own_tile * kTileSize + uvec2(block.x % kTileBlocks, block.y) * kBlock;
    const uvec2 in_cells = block * kBlock / kCellSize;
    const uint cell = in_cells.y * kRegionCells.x + in_cells.x;

    // Cleared for the passes that choose tiles.
    const uint all_threads = gl_NumWorkGroups.x * gl_NumWorkGroups.y * kHistoryGroup;
    const uint own = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kHistoryGroup + thread;
    for (uint i = own; i < maskWords(view.size_tiles) * view.size_tiles.y; i += all_threads) {
        pass.tile_mask.at[i] = 0;
    }
    for (uint i = own; i < kPriceBins; i += all_threads) { pass.price_bins.at[i] = 0; }

    bool is_listed = false;
    uint in_list = 0;
    vec2 depths;
    if (thread == 0) { listed_count = 0; }
    if (thread < kHistoryTiles) { tile_squared_gradient[thread] = 0; }
    if (thread < kRegionCells.x * kRegionCells.y) {
        cell_grown[thread] = cell_carried[thread] = cell_growth[thread] = 0;
    }
    barrier();
    if (all(lessThan(first, view.size_px)) && isHidden(view, first)) {
        [[unroll]] for (uint r = 0; r < kHistoryRows; ++r) {
            putWords(view, first + uvec2(0, r), uvec4(0));
            putPixels(view, first + uvec2(0, r), vec4[kHistoryColumns](vec4(0), vec4(0), vec4(0), vec4(0)));
        }
    } else if (all(lessThan(first, view.size_px))) {
        BlockMoves moves;
        vec2 source_px;
        float spread;
        const bool as_one = findBlock(view, first, last, moves, depths, source_px, spread);
        if (isInHistory(view, source_px)) {
            const uvec2 at = pixelAt(view.history_size_px, source_px), tile = at / kTileSize,
                        quarter = at % kTileSize / kCellSize;
            const uint from = tile.y * view.history_size_tiles.x + tile.x, its = 2 * quarter.y + quarter.x;
            const float carried = pass.source_tiles.at[from].errors[its],
                        growth = pass.source_tiles.at[from].growth[its];
            atomicAdd(cell_carried[cell], uint(min(carried * carried, 1) * kCarriedSteps));
            atomicAdd(cell_growth[cell], uint(min(growth, 1) * kCarriedSteps));
        }
        const float least = any(notEqual(moves.mean, vec2(0))) ? kLeastGrowth : 0;
        if (as_one) {
            const vec2 uncertain_px = uncertainMove(disparity(view, vec2(first)), spread);
            const vec2 shares = vec2(lostShare(fract(moves.mean.x)), lostShare(fract(moves.mean.y)));
            const ivec2 corner = ivec2(floor(source_px)) - ivec2(kBlock) / 2;
            float grown = 0, squared_gradients = 0;
            [[unroll]] for (int i = 0; i < 2; ++i) {
                float its;
                grown += lossAt(clamp(corner + ivec2(1 + i, 2 + 3 * i), ivec2(0), last), last, shares,
                                uncertain_px, its);
                squared_gradients += its;
            }
            const float pixels_each = 0.5 * float(kColumns * kRows);
            // Pixels between the two may have larger errors, unless nothing moves.
            atomicAdd(cell_grown[cell],
                      uint(max(pixels_each * grown, 2 * pixels_each * least) * kErrorSteps));
            atomicAdd(tile_squared_gradient[block.x / kTileBlocks],
                      uint(pixels_each * squared_gradients * kErrorSteps));
            resampleBlock(view, first, moves, last);
        } else {
            atomicAdd(cell_grown[cell], uint(float(kColumns * kRows) * least * kErrorSteps));
            is_listed = true;
            in_list = atomicAdd(listed_count, 1);
        }
    }
    barrier();
    if (thread == 0 && listed_count > 0) {
        const uint before = atomicAdd(pass.block_list.at[0].count, listed_count);
        listed_first = before;
        const uint groups = pixelGroups(before + listed_count) - pixelGroups(before);
        if (groups > 0) { atomicAdd(pass.block_list.at[0].per_group.x, groups); }
    }
    barrier();
    if (is_listed) {
        pass.blocks.at[listed_first + in_list] =
            HistoryBlock(first.y / kBlock.y << 16 | first.x / kBlock.x, depths);
    }
    if (thread >= kHistoryTiles) { return; }
    const uvec2 tile = tileOfRegion(thread);
    if (any(greaterThanEqual(tile, view.size_tiles))) { return; }
    // The tile's cost and age are those of the place that its middle comes from.
    const vec2 middle_px = min(vec2(tile * kTileSize) + 0.5 * float(kTileSize), vec2(view.size_px));
    const float guess =
        look(view, movePixelAnywhere(view.history_from_now, middle_px, 0).xy, middle_px).inverse_depth;
    const uvec2 from =
        pixelAt(view.history_size_px, movePixelAnywhere(view.history_from_now, middle_px, guess).xy) /
        kTileSize;
    const HistoryTile before = pass.source_tiles.at[from.y * view.history_size_tiles.x + from.x];
    HistoryTile now = HistoryTile(before.cost, before.age + 1, vec4(0), vec4(0), uvec4(0), before.lost, 0,
                                  tile_squared_gradient[thread]);
    [[unroll]] for (uint q = 0; q < 4; ++q) {
        const uint its_cell = (q >> 1) * kRegionCells.x + thread * (kTileSize / kCellSize) + (q & 1);
        // A quarter has two blocks, side by side, unless the picture ends between them.
        const float blocks =
            tile.x * kTileSize + (q & 1) * kCellSize + kHistoryColumns < view.size_px.x ? 2 : 1;
        now.errors[q] = sqrt(float(cell_carried[its_cell]) / (blocks * kCarriedSteps));
        now.growth[q] = float(cell_growth[its_cell]) / (blocks * kCarriedSteps);
        now.grown[q] = cell_grown[its_cell];
    }
    const uint at = tile.y * view.size_tiles.x + tile.x;
    pass.tiles.at[at] = now;
    pass.tile_kinds.at[at] = isHidden(view, tile * kTileSize) ? kTileHidden : 0;
}
