// 8b: every pixel of the affiliated eye gets a place in the dominant picture, a workgroup a row. Covered pixels keep the depth that
// reached them. Runs of uncovered pixels lie between two covered ones: short runs across a slanted surface interpolate its depth,
// all others repeat the farther neighbour, since what was hidden lies behind. Where errors are predicted, a tile's sum counts
// what the picture changes by beside a hole, and for mixed pixels the spread of their disparity times the picture's gradient.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/stereo.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { ResolvePass pass; };
layout(constant_id = 1) const bool kPredictErrors = false;
layout(constant_id = 2) const bool kHiddenTiles = false;

const uint kTilesPerStep = kGroupSize / kTileSize;
shared uint step_errors[kTilesPerStep];
shared uint row_counts[3];

vec3 dominantColour(ivec2 pixel, ivec2 last) {
    const ivec2 at = clamp(pixel, ivec2(0), last);
    return pass.colours.at[at.y * (last.x + 1) + at.x].rgb;
}

// The expected squared error of a covered pixel: its disparity's standard deviation times the gradient along the disparity.
float mixedDepthError(StereoView stereo, vec2 pixel_px, float inverse_depth) {
    const vec2 source_px = movePixel(stereo.dominant_from_affiliated, pixel_px, inverse_depth).xy;
    const ivec2 last = ivec2(stereo.size_px) - 1;
    const ivec2 source = clamp(ivec2(source_px), ivec2(0), last);
    const uint i = uint(source.y) * stereo.size_px.x + uint(source.x);
    const float alpha = pass.colours.at[i].w;
    if (!(alpha > 0)) { return 0; }
    const float mean = pass.pixels.at[i].inverse_depth_sum / alpha;
    const float variance = max(pass.pixels.at[i].inverse_depth_square_sum / alpha - mean * mean, 0);
    const vec2 disparity = disparityPerInverseDepth(stereo.affiliated_from_dominant, vec2(source) + 0.5);
    const float length_px = length(disparity);
    if (!(length_px > 0)) { return 0; }
    const float spread_px = min(sqrt(variance) * length_px, kMaxSpread);
    vec3 gradient = 0.5 * (dominantColour(source + ivec2(1, 0), last) - dominantColour(source - ivec2(1, 0), last));
    if (!kRectified) {
        const vec2 direction = disparity / length_px;
        gradient = direction.x * gradient +
                   direction.y * (0.5 * (dominantColour(source + ivec2(0, 1), last) - dominantColour(source - ivec2(0, 1), last)));
    }
    return spread_px * spread_px * dot(gradient, gradient) / 3;
}

// The expected squared error of a hole's pixel, which repeats what lies `repeated_px` beside it: what is hidden differs from that as
// much as what is seen equally far on the other side.
float holeError(StereoView stereo, vec2 anchor_px, float inverse_depth, int repeated_px) {
    const ivec2 source = ivec2(floor(movePixel(stereo.dominant_from_affiliated, anchor_px, inverse_depth).xy));
    const ivec2 last = ivec2(stereo.size_px) - 1;
    const vec3 difference = stereo.hole_error * (dominantColour(source + ivec2(repeated_px, 0), last) - dominantColour(source, last));
    return dot(difference, difference) + kLeastHoleError;
}

void main() {
    const uint y = gl_WorkGroupID.x;
    const uint thread = threadIndex();
    const StereoView stereo = pass.stereo.at[0];
    const uint width = stereo.size_px.x;
    const uint row = y * width;
    if (gl_LocalInvocationIndex < 3) { row_counts[gl_LocalInvocationIndex] = 0; }

    // Left to right: 1 + the column of the last covered pixel at or before each, kept in the pixel for a moment.
    uint last_before = 0;
    for (uint begin = 0; begin < width; begin += kGroupSize) {
        const uint x = begin + thread;
        const uint covered = x < width && pass.pixels.at[row + x].nearest != 0 ? x + 1 : 0;
        uint last_in_step;
        const uint last = max(scanGroupMax(covered, last_in_step), last_before);
        if (x < width) { pass.pixels.at[row + x].resolved_inverse_depth = uintBitsToFloat(last); }
        last_before = max(last_before, last_in_step);
    }
    // Right to left: likewise the first covered pixel at or after each; with both the pixel is resolved.
    uint first_after = 0;  // width - column
    const uint steps = (width + kGroupSize - 1) / kGroupSize;
    for (uint step_back = 0; step_back < steps; ++step_back) {
        const uint begin = (steps - 1 - step_back) * kGroupSize;
        const uint x = begin + (kGroupSize - 1 - thread);
        const uint nearest = x < width ? pass.pixels.at[row + x].nearest : 0;
        uint first_in_step;
        const uint first = max(scanGroupMax(nearest != 0 ? width - x : 0, first_in_step), first_after);
        first_after = max(first_after, first_in_step);
        if (kPredictErrors && gl_LocalInvocationIndex < kTilesPerStep) { step_errors[gl_LocalInvocationIndex] = 0; }
        barrier();
        if (x < width) {
            const uint last = floatBitsToUint(pass.pixels.at[row + x].resolved_inverse_depth);
            uint anchor = x;
            uint pixel_class = kCovered;
            float inverse_depth = 0;
            if (nearest != 0) {
                inverse_depth = inverseDepthOf(nearest);
                pixel_class = pixelClass(nearest);
            } else {
                const bool has_left = last != 0, has_right = first != 0;
                const uint left = last - 1, right = width - first;
                // Covered neighbours keep what reached them, so it does not matter which of them are resolved already.
                const float left_depth = has_left ? inverseDepthOf(pass.pixels.at[row + left].nearest) : 0;
                const float right_depth = has_right ? inverseDepthOf(pass.pixels.at[row + right].nearest) : 0;
                const bool inside = has_left && has_right;
                const uint run = right - left - 1;
                pixel_class = inside && run <= stereo.gap_px ? kGap : kHole;
                const float disparity_px = length(disparityPerInverseDepth(stereo.affiliated_from_dominant, vec2(x, y) + 0.5));
                if (pixel_class == kGap && abs(left_depth - right_depth) * disparity_px <= float(run + 1)) {
                    inverse_depth = mix(left_depth, right_depth, float(x - left) / float(right - left));
                } else if (has_left && (!has_right || left_depth <= right_depth)) {
                    anchor = left;
                    inverse_depth = left_depth;
                } else if (has_right) {
                    anchor = right;
                    inverse_depth = right_depth;
                }
            }
            pass.pixels.at[row + x].resolved_inverse_depth = inverse_depth;
            if (nearest == 0) { pass.pixels.at[row + x].nearest = packUncovered(anchor, pixel_class); }
            const bool shown = !kHiddenTiles || pass.tile_kinds.at[(y / kTileSize) * stereo.size_tiles.x + x / kTileSize] != kTileHidden;
            if (shown) { atomicAdd(row_counts[pixel_class], 1); }
            if (kPredictErrors && shown) {
                // Mixed pixels are many and alike: every other row stands for two.
                const float error = pixel_class == kHole ? holeError(stereo, vec2(anchor, y) + 0.5, inverse_depth, int(anchor) - int(x))
                                    : (y & 1) == 0       ? 2 * mixedDepthError(stereo, vec2(x, y) + 0.5, inverse_depth)
                                                         : 0;
                const uint steps_of_error = uint(min(error, kMaxPixelError) * kErrorSteps);
                if (steps_of_error > 0) { atomicAdd(step_errors[(x - begin) / kTileSize], steps_of_error); }
            }
        }
        barrier();
        if (kPredictErrors && gl_LocalInvocationIndex < kTilesPerStep) {
            const uint tile_x = begin / kTileSize + gl_LocalInvocationIndex;
            if (tile_x < stereo.size_tiles.x && step_errors[gl_LocalInvocationIndex] > 0) {
                atomicAdd(pass.tile_errors.at[(y / kTileSize) * stereo.size_tiles.x + tile_x], step_errors[gl_LocalInvocationIndex]);
            }
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0) {
        atomicAdd(pass.counters.at[0].covered_pixels, row_counts[kCovered]);
        atomicAdd(pass.counters.at[0].gap_pixels, row_counts[kGap]);
        atomicAdd(pass.counters.at[0].hole_pixels, row_counts[kHole]);
    }
}
