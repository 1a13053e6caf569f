// 9: the colour of each pixel of the affiliated eye that no tile will render again, sampled backwards: the pixel knows its place in
// the dominant picture to a fraction of a pixel, and a cubic kernel (Catmull and Rom 1974) reads it there. Tiles that no lens shows
// become background.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/stereo.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform Push { ResamplePass pass; };

layout(constant_id = 1) const bool kDepth = false;

shared uint row_classes[16];

// Weights of the samples at -1, 0, 1, 2 for a place `t` after sample 0. At t = 0 they are exactly 0, 1, 0, 0.
vec4 cubicWeights(float t) {
    return 0.5 * vec4(t * (-1 + t * (2 - t)), 2 + t * t * (-5 + 3 * t), t * (1 + t * (4 - 3 * t)), t * t * (t - 1));
}

// Rectified pixels keep their row, where the vertical kernel is exactly 1.
vec4 sampleCubicInRow(float place_px, int row, int width) {
    const float from_first = clamp(place_px, 0.5, float(width) - 0.5) - 0.5;
    const int base = int(floor(from_first));
    const vec4 weights = cubicWeights(from_first - float(base));
    vec4 sum = vec4(0);
    for (int x = 0; x < 4; ++x) { sum += weights[x] * pass.dominant.at[row * width + clamp(base + x - 1, 0, width - 1)]; }
    return max(sum, vec4(0));
}

vec4 sampleCubic(vec2 place_px, ivec2 size) {
    const vec2 from_first = clamp(place_px, vec2(0.5), vec2(size) - 0.5) - 0.5;
    const ivec2 base = ivec2(floor(from_first));
    const vec4 weights_x = cubicWeights(from_first.x - float(base.x)), weights_y = cubicWeights(from_first.y - float(base.y));
    vec4 sum = vec4(0);
    for (int y = 0; y < 4; ++y) {
        const int row = clamp(base.y + y - 1, 0, size.y - 1) * size.x;
        vec4 in_row = vec4(0);
        for (int x = 0; x < 4; ++x) { in_row += weights_x[x] * pass.dominant.at[row + clamp(base.x + x - 1, 0, size.x - 1)]; }
        sum += weights_y[y] * in_row;
    }
    return max(sum, vec4(0));
}

void main() {
    const StereoView stereo = pass.stereo.at[0];
    const uvec2 at = gl_GlobalInvocationID.xy;
    const bool inside = all(lessThan(at, stereo.size_px));
    if (gl_LocalInvocationIndex < 16) { row_classes[gl_LocalInvocationIndex] = 0; }
    barrier();
    const uint i = at.y * stereo.size_px.x + at.x;
    const uint kind = pass.tile_kinds.at[gl_WorkGroupID.y * stereo.size_tiles.x + gl_WorkGroupID.x];
    // Tiles that were rendered again hold colours already.
    if (inside && kind == 0) {
        const uint nearest = pass.pixels.at[i].nearest;
        atomicOr(row_classes[gl_LocalInvocationID.y], pixelClass(nearest) << (2 * gl_LocalInvocationID.x));
        const float column = float(isUncovered(nearest) ? anchorColumn(nearest) : at.x);
        const vec2 pixel_px = vec2(column, float(at.y)) + 0.5;
        const float inverse_depth = pass.pixels.at[i].resolved_inverse_depth;
        const vec2 source_px = movePixel(stereo.dominant_from_affiliated, pixel_px, inverse_depth).xy;
        const vec4 colour = kRectified ? sampleCubicInRow(source_px.x, int(at.y), int(stereo.size_px.x)) : sampleCubic(source_px, ivec2(stereo.size_px));
        pass.affiliated.at[i] = colour;
        if (kDepth) { pass.depths.at[i] = inverse_depth > 0 ? colour.a / inverse_depth : 0; }
    } else if (inside && kind == kTileHidden) {
        pass.affiliated.at[i] = vec4(pass.background, 0);
        if (kDepth) { pass.depths.at[i] = 0; }
    }
    barrier();
    if (gl_LocalInvocationID.x == 0 && inside) { pass.pixel_classes.at[at.y * stereo.size_tiles.x + gl_WorkGroupID.x] = row_classes[gl_LocalInvocationID.y]; }
}
