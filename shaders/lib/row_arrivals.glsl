// For resample: the pixels that arrived in a row of the target, in shared memory if they fit. They come from
// memory, or from the source's row.

uint arrivalAt(uint row, uint x) { return kSharedRow == 0 ? pass.moving.at[row + x] : row_arrivals[x]; }

bool hidesTiles() { return kRowSource != kWholeRowMoved && isThere(uvec2(pass.shown_mask)); }

void put(WarpView warp, ivec2 at, uint arrival) {
    if (at.x >= 0 && at.x < int(warp.size_px.x)) { atomicMax(row_arrivals[at.x], arrival); }
}

#include "lib/reproject.glsl"

// Moves the source's row to where the target sees it; four pixels at a time, each with its right neighbour.
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
                if (!copiesColours() && warp.gap_px > 0) { putBetween(warp, here, right, int(y)); }
            }
            here = right;
            ++x;
        }
        while (x < end)
            ;
        x += 4 * kWarpGroup - 4;
    }
    while (x < width)
        ;
}

// Four pixels at a time. Nothing arrives beyond the row's end.
void loadRow(uint row, uint width) {
    uint x = 4 * gl_LocalInvocationIndex;
    [[dont_unroll]] do {
        uvec4 four = uvec4(0);
        if (kMovesRow) {
            if (x < width) {
                four = uvec4(row_arrivals[x], row_arrivals[x + 1], row_arrivals[x + 2], row_arrivals[x + 3]);
            }
        } else if (x + 4 <= width) {
            four = uvec4(pass.moving.at[row + x], pass.moving.at[row + x + 1], pass.moving.at[row + x + 2],
                         pass.moving.at[row + x + 3]);
        } else {
            [[unroll]] for (uint i = 0; i < 3; ++i) {
                four[i] = x + i < width ? pass.moving.at[row + x + i] : 0;
            }
        }
        if (!kMovesRow && kSharedRow != 0 && x < width) {
            [[unroll]] for (uint i = 0; i < 4; ++i) { row_arrivals[x + i] = four[i]; }
        }
        const uvec4 arrived = mix(uvec4(0), uvec4(1, 2, 4, 8), notEqual(four, uvec4(0)));
        const uint bits = arrived.x | arrived.y | arrived.z | arrived.w;
        if (bits != 0) { atomicOr(arrived_bits[x / 32], bits << (x & 31)); }
        x += 4 * kWarpGroup;
    }
    while (x < width)
        ;
}

// The nearest pixel to the left, or right, of `x` that something reached; -1: none.
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

// Where a pixel's colour comes from: the place in the source of the pixel in `column` of its row, at this
// depth.
struct Resolved {
    uint column;
    uint pixel_class;
    float inverse_depth;
    float variance_share;  // of the inverse depth, as a share of its square
};

Resolved resolveArrived(uvec2 at, uint arrival) {
    return Resolved(at.x, (arrival & kLanded) != 0 ? kCovered : kGap, inverseDepthOf(arrival),
                    varianceShareOf(arrival));
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
            return Resolved(at.x, kGap,
                            mix(left_depth, right_depth, float(int(at.x) - left) / float(right - left)), 0);
        }
        return left_depth <= right_depth ? Resolved(uint(left), kGap, left_depth, 0)
                                         : Resolved(uint(right), kGap, right_depth, 0);
    }
    if (left >= 0 && (right < 0 || left_depth <= right_depth)) {
        return Resolved(uint(left), kHole, left_depth, 0);
    }
    return right >= 0 ? Resolved(uint(right), kHole, right_depth, 0) : Resolved(at.x, kHole, 0, 0);
}
