// resample: every pixel of the target that no tile renders gets a place in the source and is sampled there. A workgroup per row.
// Where pixels stay in their rows and a row fits into shared memory, this pass moves them there itself; otherwise reproject has done so.
// A pixel that something reached keeps its depth. The others form runs between two such pixels. A short run across a slanted surface
// interpolates its depth; any other repeats the farther neighbour, since what was hidden lies behind. Few tiles have runs: they are listed
// and gone through once more, so that all other pixels do without the search. A cubic kernel (Catmull and Rom 1974) reads the colour.
// Where errors are predicted, each tile sums them up, from the samples at hand. A hole's pixel counts what the picture changes by next to
// the hole. Any other counts how uncertain its disparity is, times the picture's gradient, and what a cubic loses between pixels.
// Only even rows have errors, which count for two. They come first, and the odd ones once tiles are chosen: of a tile that is going to be
// rendered only half of the pixels are then sampled in vain. Where pixels stay in their rows, an odd row is sampled at the places of the
// even one above it, so that only half of the rows are moved. Its colours are its own, except where it repeats a neighbour. Where an eye
// does not resolve two rows (price), an odd row is the mean of those above and below.
// Where colours are copied (kForward), this is the paper to the letter instead, see copyArrived.
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
layout(constant_id = 1) const bool kPredictErrors = false;
layout(constant_id = 2) const bool kDepth = false;
layout(constant_id = 3) const bool kClasses = false;     // somebody asks for the class of each pixel
layout(constant_id = 4) const bool kComponents = false;  // holes are going to be grouped
// A whole row of arrivals is kept in shared memory, so that colours may overwrite it in device memory. 0: rows are too long, and arrivals
// lie elsewhere.
layout(constant_id = 5) const uint kRowSteps = 1;
layout(constant_id = 6) const bool kHalfColours = false;
layout(constant_id = 7) const bool kForward = false;  // colours are copied; not where errors are predicted
layout(constant_id = 8) const uint kRowSource = kArrivalsGiven;

#include "lib/picture.glsl"
#include "lib/reproject.glsl"

const uint kMaxWidth = 16384;
const uint kLongestRow = kRowSteps == 0 ? kMaxWidth : kRowSteps * kArrivalsStep;
const uint kSharedRow = kRowSource == kPlacesGiven ? 0 : kRowSteps * kArrivalsStep;
const bool kMovesRow = kRowSource == kRowMoved || kRowSource == kWholeRowMoved;
const bool kFindsOpen = kRowSource != kPlacesGiven && !kForward;

shared uint row_arrivals[kSharedRow + 1];
shared uint arrived_bits[kRowSource == kPlacesGiven ? 1 : kLongestRow / 32];
shared uint tile_classes[kClasses ? kLongestRow / 16 : 1];
const uint kMostTiles = kLongestRow / 16;

shared uint moved_tiles[kMostTiles];  // of this row of tiles, in no order; from the end those of which this row is a mean
shared uint moved_count;
shared uint mean_count;
shared uint hidden_count;
shared uint open_tiles[kFindsOpen ? kMostTiles : 1];  // of moved_tiles those with pixels that nothing reached
shared uint open_bits[kFindsOpen ? (kMostTiles + 31) / 32 : 1];
shared uint open_count;

uint arrivalAt(uint row, uint x) { return kSharedRow == 0 ? pass.moving.at[row + x] : row_arrivals[x]; }

bool hidesTiles() { return kRowSource != kWholeRowMoved && any(notEqual(uvec2(pass.shown_mask), uvec2(0))); }

void put(WarpView warp, ivec2 at, uint arrival) {
    if (at.x >= 0 && at.x < int(warp.size_px.x)) { atomicMax(row_arrivals[at.x], arrival); }
}

// Whether the row may be the mean of those above and below: these are there, in the same tiles, and tiles say where.
bool mayBeMean(WarpView warp, uint y) {
    const bool between = (y & 1) == 1 && (y + 1) % kTileSize != 0 && y + 1 < warp.size_px.y;
    return !kPredictErrors && between && any(notEqual(uvec2(pass.tile_errors), uvec2(0)));
}

// Which tiles of the row are moved, i.e. come from here, which are the mean of the rows above and below, and whether any is hidden.
void listTiles(uint first_tile, uint tiles, bool moves, bool may_be_mean) {
    uint tile = gl_LocalInvocationIndex;
    if (tile >= tiles) { return; }
    [[dont_unroll]] do {
        const uint kind = pass.tile_kinds.at[first_tile + tile];
        if (kind == 0 && moves) {
            if (may_be_mean && pass.tile_errors.at[first_tile + tile] == kSeenCoarsely) {
                moved_tiles[kMostTiles - 1 - atomicAdd(mean_count, 1)] = tile;
            } else {
                moved_tiles[atomicAdd(moved_count, 1)] = tile;
            }
        }
        if (kind == kTileHidden) { atomicAdd(hidden_count, 1); }
        tile += kWarpGroup;
    } while (tile < tiles);
}

// The source's row, to where the target sees it; four pixels at a time, each with its right neighbour.
void moveRow(WarpView warp, uint y, uint width) {
    uint x = 4 * gl_LocalInvocationIndex;
    if (x >= width) { return; }
    [[dont_unroll]] do {
        Moved here = moveSource(warp, uvec2(x, y));
        const uint end = min(x + 4, width);
        [[dont_unroll]] do {
            Moved right = moveSource(warp, uvec2(min(x + 1, width - 1), y));
            right.valid = right.valid && x + 1 < width;
            if (here.valid && !isOut(warp, here)) {
                putLanded(warp, here);
                if (!kForward && warp.gap_px > 0) { putBetween(warp, here, right, int(y)); }
            }
            here = right;
            ++x;
        } while (x < end);
        x += 4 * kWarpGroup - 4;
    } while (x < width);
}

// Four pixels at a time. What lies beyond the row's end is as if nothing had arrived there.
void loadRow(uint row, uint width) {
    uint x = 4 * gl_LocalInvocationIndex;
    [[dont_unroll]] do {
        uvec4 four = uvec4(0);
        if (kMovesRow) {
            if (x < width) { four = uvec4(row_arrivals[x], row_arrivals[x + 1], row_arrivals[x + 2], row_arrivals[x + 3]); }
        } else if (x + 4 <= width) {
            four = uvec4(pass.moving.at[row + x], pass.moving.at[row + x + 1], pass.moving.at[row + x + 2], pass.moving.at[row + x + 3]);
        } else {
            [[unroll]] for (uint i = 0; i < 3; ++i) { four[i] = x + i < width ? pass.moving.at[row + x + i] : 0; }
        }
        if (!kMovesRow && kSharedRow != 0 && x < width) {
            [[unroll]] for (uint i = 0; i < 4; ++i) { row_arrivals[x + i] = four[i]; }
        }
        const uvec4 arrived = mix(uvec4(0), uvec4(1, 2, 4, 8), notEqual(four, uvec4(0)));
        const uint bits = arrived.x | arrived.y | arrived.z | arrived.w;
        if (bits != 0) { atomicOr(arrived_bits[x / 32], bits << (x & 31)); }
        x += 4 * kWarpGroup;
    } while (x < width);
}

// The nearest pixel to the left, or right, of `x` that something reached; -1: there is none.
int arrivedBefore(uint x) {
    int word = int(x / 32);
    uint bits = arrived_bits[word] & ((1u << (x & 31)) - 1);
    while (bits == 0 && word > 0) { bits = arrived_bits[--word]; }
    return bits == 0 ? -1 : word * 32 + findMSB(bits);
}
int arrivedAfter(uint x, uint width) {
    const int words = int((width + 31) / 32);
    int word = int(x / 32);
    uint bits = arrived_bits[word] & ~((2u << (x & 31)) - 1);
    while (bits == 0 && word + 1 < words) { bits = arrived_bits[++word]; }
    return bits == 0 ? -1 : word * 32 + findLSB(bits);
}

// Where a pixel's colour is taken from: where the pixel in `column` of its row, at this depth, comes from.
struct Resolved {
    uint column;
    uint pixel_class;
    float inverse_depth;
    float variance_share;  // of the inverse depth, as a share of its square
};

Resolved resolveArrived(uvec2 at, uint arrival) {
    return Resolved(at.x, (arrival & kLanded) != 0 ? kCovered : kGap, inverseDepthOf(arrival), varianceShareOf(arrival));
}

// A pixel that nothing reached.
Resolved resolveOpen(WarpView warp, uint row, uvec2 at) {
    const int left = arrivedBefore(at.x), right = arrivedAfter(at.x, warp.size_px.x);
    const float left_depth = left >= 0 ? inverseDepthOf(arrivalAt(row, uint(left))) : 0;
    const float right_depth = right >= 0 ? inverseDepthOf(arrivalAt(row, uint(right))) : 0;
    const uint run = uint(right - left - 1);
    if (left >= 0 && right >= 0 && run <= warp.gap_px) {
        const float disparity_px = length(disparityPerInverseDepth(warp.target_from_source, vec2(at) + 0.5));
        if (abs(left_depth - right_depth) * disparity_px <= float(run + 1)) {
            return Resolved(at.x, kGap, mix(left_depth, right_depth, float(int(at.x) - left) / float(right - left)), 0);
        }
        return left_depth <= right_depth ? Resolved(uint(left), kGap, left_depth, 0) : Resolved(uint(right), kGap, right_depth, 0);
    }
    if (left >= 0 && (right < 0 || left_depth <= right_depth)) { return Resolved(uint(left), kHole, left_depth, 0); }
    return right >= 0 ? Resolved(uint(right), kHole, right_depth, 0) : Resolved(at.x, kHole, 0, 0);
}

// Where a pixel is sampled, for the one below it in an odd row; in the words where the colour of that one is going to be.
//
//   31..3  its column in the source, in pixels, with 15 bits of fraction
//   2      it is a neighbour's, in the row above
//   1..0   the class
//
// Then, where depths are wanted, a second word: the inverse depth.
const float kPlaceSteps = 32768;
const uint kRepeats = 4;

Uints placeWords() { return Uints(uvec2(pass.half_target)); }
uint placeAt(WarpView warp, uvec2 at) { return (at.y * warp.size_px.x + at.x) * (kHalfColours ? 2 : 4); }

void keepPlace(WarpView warp, uvec2 at, Resolved resolved, float place_px) {
    if (at.y + 1 >= warp.size_px.y) { return; }
    const uint word = placeAt(warp, at + uvec2(0, 1));
    const uint steps = uint(clamp(place_px, 0.0, float(warp.size_px.x) - 0.5) * kPlaceSteps + 0.5);
    placeWords().at[word] = steps << 3 | (resolved.column != at.x ? kRepeats : 0) | resolved.pixel_class;
    if (kDepth) { placeWords().at[word + 1] = floatBitsToUint(resolved.inverse_depth); }
}

// How uncertain a pixel's inverse depth is, as a variance: it blends several, and where its neighbours have others it may belong to these.
float uncertaintyOf(uint row, uint x, uint width, Resolved resolved) {
    const float own = kSpreadWeight * resolved.inverse_depth;
    float step = 0;
    [[unroll]] for (uint side = 0; side < 2; ++side) {
        const uint beside = x + 2 * side - 1;  // beyond either end: no column
        const uint arrival = beside < width ? arrivalAt(row, beside) : 0;
        if (arrival != 0) { step = max(step, abs(inverseDepthOf(arrival) - resolved.inverse_depth)); }
    }
    return resolved.variance_share * (own * own) + step * step;
}

vec4 sourceAt(uint i) { return colourAt(pass.source, pass.half_source, i); }

// Weights of the samples at -1, 0, 1, 2 for a place `t` after sample 0. At t = 0 they are exactly 0, 1, 0, 0.
vec4 cubicWeights(float t) {
    return 0.5 * vec4(t * (-1 + t * (2 - t)), 2 + t * t * (-5 + 3 * t), t * (1 + t * (4 - 3 * t)), t * t * (t - 1));
}

// A colour; how the picture changes from pixel to pixel along the disparity, at the pixel that holds the place; and the square of what
// sampling between pixels loses.
struct Sample {
    vec4 colour;
    vec3 gradient;
    float lost;
};

// What changes its sign from pixel to pixel is lost halfway between them, and a share of it on the way there.
vec3 lostBetween(float t, vec3 third_difference) { return 0.5 * t * (1 - t) * third_difference; }

// Rectified pixels keep their row, where the vertical kernel is exactly 1.
Sample sampleInRow(float place_px, uint row, int width) {
    const float from_first = clamp(place_px, 0.5, float(width) - 0.5) - 0.5;
    const int base = int(floor(from_first));
    const float t = from_first - float(base);
    const vec4 weights = cubicWeights(t);
    vec4 taps[4];
    [[unroll]] for (int x = 0; x < 4; ++x) { taps[x] = sourceAt(row + uint(clamp(base + x - 1, 0, width - 1))); }
    const vec4 colour = weights.x * taps[0] + weights.y * taps[1] + weights.z * taps[2] + weights.w * taps[3];
    const vec3 lost = lostBetween(t, taps[3].rgb - taps[0].rgb + 3 * (taps[1].rgb - taps[2].rgb));
    return Sample(max(colour, vec4(0)), 0.5 * (t < 0.5 ? taps[2].rgb - taps[0].rgb : taps[3].rgb - taps[1].rgb), dot(lost, lost));
}

Sample sampleAround(vec2 place_px, ivec2 size, vec2 direction) {
    const vec2 from_first = clamp(place_px, vec2(0.5), vec2(size) - 0.5) - 0.5;
    const ivec2 base = ivec2(floor(from_first));
    const vec2 t = from_first - vec2(base);
    const vec4 weights_x = cubicWeights(t.x), weights_y = cubicWeights(t.y);
    const bool first_column = t.x < 0.5, first_row = t.y < 0.5;
    vec4 sum = vec4(0);
    vec3 across = vec3(0), down = vec3(0), lost_across = vec3(0), third_down = vec3(0);
    [[unroll]] for (int y = 0; y < 4; ++y) {
        const int row = clamp(base.y + y - 1, 0, size.y - 1) * size.x;
        vec4 taps[4];
        [[unroll]] for (int x = 0; x < 4; ++x) { taps[x] = sourceAt(uint(row + clamp(base.x + x - 1, 0, size.x - 1))); }
        sum += weights_y[y] * (weights_x.x * taps[0] + weights_x.y * taps[1] + weights_x.z * taps[2] + weights_x.w * taps[3]);
        if (y == 1 && first_row || y == 2 && !first_row) {
            across = 0.5 * (first_column ? taps[2].rgb - taps[0].rgb : taps[3].rgb - taps[1].rgb);
            lost_across = lostBetween(t.x, taps[3].rgb - taps[0].rgb + 3 * (taps[1].rgb - taps[2].rgb));
        }
        const vec3 middle = first_column ? taps[1].rgb : taps[2].rgb;
        if (y == (first_row ? 0 : 1)) { down -= 0.5 * middle; }
        if (y == (first_row ? 2 : 3)) { down += 0.5 * middle; }
        third_down += (y == 0 ? -1.0 : y == 1 ? 3.0 : y == 2 ? -3.0 : 1.0) * middle;
    }
    const vec3 lost_down = lostBetween(t.y, third_down);
    return Sample(max(sum, vec4(0)), direction.x * across + direction.y * down, dot(lost_across, lost_across) + dot(lost_down, lost_down));
}

// The expected squared error of a hole's pixel, which repeats what lies `repeated_px` away: what is hidden differs from that as
// much as what is seen equally far on the other side.
float holeError(WarpView warp, vec2 source_px, int repeated_px) {
    const ivec2 last = ivec2(warp.size_px) - 1;
    const ivec2 source = ivec2(floor(clamp(source_px, vec2(-1e6), vec2(1e6))));
    const ivec2 here = clamp(source, ivec2(0), last), beyond = clamp(source + ivec2(repeated_px, 0), ivec2(0), last);
    const int width = last.x + 1;
    const vec3 difference = warp.hole_error * (sourceAt(uint(beyond.y * width + beyond.x)).rgb - sourceAt(uint(here.y * width + here.x)).rgb);
    return dot(difference, difference) + kLeastHoleError;
}

// The source's pixel that arrived in a pixel of the row.
vec4 arrivedColour(WarpView warp, uint row, uvec2 at) {
    const uint arrival = arrivalAt(row, at.x);
    const vec2 place_px = movePixel(warp.source_from_target, vec2(at) + 0.5, inverseDepthOf(arrival)).xy;
    const ivec2 source = clamp(pixelOfParity(place_px, arrival), ivec2(0), ivec2(warp.size_px) - 1);
    return sourceAt(uint(source.y) * warp.size_px.x + uint(source.x));
}

struct Copied {
    vec4 colour;
    uint pixel_class;
    float inverse_depth;
};

// The paper to the letter. Section 3.1, stage 2: the initial view is the source pixels where they were projected; each keeps its colour.
// Stage 4: gaps, "small and surrounded by valid reprojected pixels", are "filled through adaptive interpolation". It does not say how
// small, nor what adapts: here runs of a row up to gap_px, and colours linear between the run's two ends, whichever is farther. Longer
// runs have no other filling in the paper either where centre ROIs are off (figure 3 a), and get the same; at the picture's border
// there is one end alone. A row that nothing reached shows what lies infinitely far.
Copied copyArrived(WarpView warp, uint row, uvec2 at) {
    const bool here = arrivalAt(row, at.x) != 0;
    const int left = here ? int(at.x) : arrivedBefore(at.x), right = here ? int(at.x) : arrivedAfter(at.x, warp.size_px.x);
    if (left < 0 && right < 0) {
        const vec2 place_px = movePixel(warp.source_from_target, vec2(at) + 0.5, 0).xy;
        const uvec2 source = uvec2(clamp(place_px, vec2(0.5), vec2(warp.size_px) - 0.5));
        return Copied(sourceAt(source.y * warp.size_px.x + source.x), kHole, 0);
    }
    const uint first = uint(left >= 0 ? left : right), last = uint(right >= 0 ? right : left);
    const float share = first == last ? 0 : float(at.x - first) / float(last - first);
    const bool inside = left >= 0 && right >= 0 && last - first - 1 <= warp.gap_px;
    return Copied(mix(arrivedColour(warp, row, uvec2(first, at.y)), arrivedColour(warp, row, uvec2(last, at.y)), share),
                  here ? kCovered : inside ? kGap : kHole, mix(inverseDepthOf(arrivalAt(row, first)), inverseDepthOf(arrivalAt(row, last)), share));
}

void putPixel(WarpView warp, uvec2 at, uint pixel_class, vec4 colour, float inverse_depth) {
    const uint i = at.y * warp.size_px.x + at.x;
    if (kComponents && pixel_class == kHole) {
        pass.component_pixels.at[kHalfColours ? i : 2 * i].parent = i;
    } else {
        putColour(pass.target, pass.half_target, i, colour);
    }
    if (kDepth) { pass.depths.at[i] = inverse_depth > 0 ? colour.a / inverse_depth : 0; }
}

// Writes a pixel of an odd row. A neighbour is repeated as the row above shows it, by whose depths it was found.
float sampleBelow(WarpView warp, uvec2 at, out uint pixel_class) {
    const uint word = placeAt(warp, at), place = placeWords().at[word];
    pixel_class = place & 3;
    const uint source_row = (place & kRepeats) != 0 ? at.y - 1 : at.y;
    const Sample found = sampleInRow(float(place >> 3) / kPlaceSteps, source_row * warp.size_px.x, int(warp.size_px.x));
    putPixel(warp, at, pixel_class, found.colour, kDepth ? uintBitsToFloat(placeWords().at[word + 1]) : 0);
    return 0;
}

// Writes the pixel; returns its expected squared error.
float putResolved(WarpView warp, uint row, uvec2 at, Resolved resolved, bool open) {
    const vec2 source_px = movePixel(warp.source_from_target, vec2(resolved.column, at.y) + 0.5, resolved.inverse_depth).xy;
    const ivec2 size = ivec2(warp.size_px);
    const vec2 source = floor(clamp(source_px, vec2(0), vec2(size) - 1)) + 0.5;
    const vec2 disparity = disparityPerInverseDepth(warp.target_from_source, source);
    const float disparity_px = kRectified ? abs(disparity.x) : length(disparity);
    if (movesEvenRows(warp) && (at.y & 1) == 0) { keepPlace(warp, at, resolved, source_px.x); }
    const Sample found = kRectified ? sampleInRow(source_px.x, at.y * warp.size_px.x, size.x)
                                    : sampleAround(source_px, size, disparity_px > 0 ? disparity / disparity_px : vec2(0));
    putPixel(warp, at, resolved.pixel_class, found.colour, resolved.inverse_depth);
    if (!kPredictErrors || (at.y & 1) != 0) { return 0; }
    if (open && resolved.pixel_class == kHole) { return 2 * holeError(warp, source_px, int(resolved.column) - int(at.x)); }
    const float variance_px2 = min(uncertaintyOf(row, at.x, warp.size_px.x, resolved) * disparity_px * disparity_px, kMaxSpread * kMaxSpread);
    return 2 * (variance_px2 * dot(found.gradient, found.gradient) + found.lost) / 3;
}

// Writes a pixel that something reached, or any if open ones are not told apart; returns its expected squared error, and its class.
float putReached(WarpView warp, uint row, uvec2 at, uint arrival, out uint pixel_class) {
    if (kForward) {
        const Copied copied = copyArrived(warp, row, at);
        pixel_class = copied.pixel_class;
        putPixel(warp, at, pixel_class, copied.colour, copied.inverse_depth);
        return 0;
    }
    if (kRowSource == kPlacesGiven) { return sampleBelow(warp, at, pixel_class); }
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
    if (pixel_class != kCovered) { atomicOr(tile_classes[x / kTileSize], pixel_class << (2 * (x % kTileSize))); }
}

uint errorSteps(float error) { return uint(min(error, kMaxPixelError) * kErrorSteps); }

// Lanes work side by side on a row of pixels of a tile, or of several: each 16 have a `tile`.
void addErrors(uint tile, uint steps, uint lanes) {
    const uint slots = max(lanes / kTileSize, 1u);
    uint s = 0;
    [[dont_unroll]] do {
        const bool own = lanes < kTileSize || gl_SubgroupInvocationID / kTileSize == s;
        const uint sum = subgroupAdd(own ? steps : 0);
        if (gl_SubgroupInvocationID == s * kTileSize && sum > 0) { atomicAdd(pass.tile_errors.at[tile], sum); }
        ++s;
    } while (s < slots);
}

// The rows above and below this one are even ones, which were there before any odd one was begun.
void putMeans(uint y, uint width, uint tiles) {
    for (uint item = gl_LocalInvocationIndex; item < mean_count * kTileSize; item += kWarpGroup) {
        const uint tile = moved_tiles[kMostTiles - 1 - item / kTileSize], x = tile * kTileSize + item % kTileSize;
        if (kClasses && item % kTileSize == 0) { tile_classes[tile] = pass.pixel_classes.at[(y - 1) * tiles + tile]; }
        if (x >= width) { continue; }
        const uint i = y * width + x;
        const vec4 above = colourAt(pass.target, pass.half_target, i - width);
        const vec4 below = colourAt(pass.target, pass.half_target, i + width);
        putColour(pass.target, pass.half_target, i, 0.5 * (above + below));
        if (kDepth) { pass.depths.at[i] = 0.5 * (pass.depths.at[i - width] + pass.depths.at[i + width]); }
    }
}

void hideTiles(uint y, uint first_tile, uint width) {
    for (uint x = gl_LocalInvocationIndex; x < width; x += kWarpGroup) {
        if (pass.tile_kinds.at[first_tile + x / kTileSize] != kTileHidden) { continue; }
        const uint i = y * width + x;
        putColour(pass.target, pass.half_target, i, vec4(pass.background, 0));
        if (kDepth) { pass.depths.at[i] = 0; }
    }
}

void main() {
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
    if (kRowSource != kPlacesGiven) {
        uint word = gl_LocalInvocationIndex;
        [[dont_unroll]] do {
            if (word < (width + 31) / 32) { arrived_bits[word] = 0; }
            word += kWarpGroup;
        } while (word < (width + 31) / 32);
    }
    if (kFindsOpen) {
        if (gl_LocalInvocationIndex < (tiles + 31) / 32) { open_bits[gl_LocalInvocationIndex] = 0; }
    }
    if (kClasses) {
        for (uint tile = gl_LocalInvocationIndex; tile < tiles; tile += kWarpGroup) { tile_classes[tile] = 0; }
    }
    if (kMovesRow) {
        const uint end = min(width + 4, kSharedRow + 1);
        uint x = gl_LocalInvocationIndex;
        [[dont_unroll]] do {
            if (x < end) { row_arrivals[x] = 0; }
            x += kWarpGroup;
        } while (x < end);
    }
    barrier();
    listTiles(first_tile, tiles, pass.counters.at[0].moves != 0, mayBeMean(warp, y));
    barrier();
    const uint items = moved_count * kTileSize;
    if (kMovesRow) {
        if (items > 0) { moveRow(warp, y, width); }
        barrier();
    }
    if (kRowSource != kPlacesGiven) {
        if (items > 0) { loadRow(row, width); }
        memoryBarrierBuffer();  // colours may take the place of what was read
        barrier();
    }

    uvec3 classes = uvec3(0);
    uint begin = 0;
    [[dont_unroll]] do {
        const uint item = begin + thread, slot = item / kTileSize;
        const uint tile = item < items ? moved_tiles[slot] : tiles, x = tile * kTileSize + item % kTileSize;
        uint steps = 0, arrival = 0;
        if (x < width) {
            if (kFindsOpen) { arrival = arrivalAt(row, x); }
            if (kFindsOpen && arrival == 0) {
                listOpen(slot);
            } else {
                uint pixel_class;
                steps = errorSteps(putReached(warp, row, uvec2(x, y), arrival, pixel_class));
                countClass(x, pixel_class, classes);
            }
        }
        if (kPredictErrors) { addErrors(first_tile + tile, steps, lanes); }
        begin += kWarpGroup;
    } while (begin < items);
    if (kFindsOpen) {
        barrier();
        const uint open_items = open_count * kTileSize;
        begin = 0;
        [[dont_unroll]] do {
            const uint item = begin + thread;
            const uint tile = item < open_items ? moved_tiles[open_tiles[item / kTileSize]] : tiles, x = tile * kTileSize + item % kTileSize;
            uint steps = 0;
            if (x < width && arrivalAt(row, x) == 0) {
                const Resolved resolved = resolveOpen(warp, row, uvec2(x, y));
                steps = errorSteps(putResolved(warp, row, uvec2(x, y), resolved, true));
                countClass(x, resolved.pixel_class, classes);
            }
            if (kPredictErrors) { addErrors(first_tile + tile, steps, lanes); }
            begin += kWarpGroup;
        } while (begin < open_items);
    }
    if (mean_count > 0) { putMeans(y, width, tiles); }
    if (hidden_count > 0) { hideTiles(y, first_tile, width); }
    if (!kClasses) { return; }
    barrier();
    for (uint tile = gl_LocalInvocationIndex; tile < tiles; tile += kWarpGroup) { pass.pixel_classes.at[y * tiles + tile] = tile_classes[tile]; }
    // As if no tile were chosen yet: the even rows count for the odd ones.
    classes *= warp.rows_apart == 1 ? 1 : pass.first_row == 0 ? min(2, warp.size_px.y - y) : 0;
    const uint covered = subgroupAdd(classes.x), gaps = subgroupAdd(classes.y), holes = subgroupAdd(classes.z);
    if (subgroupElect()) {
        if (covered > 0) { atomicAdd(pass.counters.at[0].covered_pixels, covered); }
        if (gaps > 0) { atomicAdd(pass.counters.at[0].gap_pixels, gaps); }
        if (holes > 0) { atomicAdd(pass.counters.at[0].hole_pixels, holes); }
        if (kComponents && holes > 0) {
            atomicOr(pass.counters.at[0].component_groups.x, warp.size_tiles.x);
            atomicOr(pass.counters.at[0].component_groups.y, 2 * warp.size_tiles.y);
            atomicOr(pass.counters.at[0].component_groups.z, 1);
        }
    }
}
