// fill_periphery: fills the tiles that are not rendered at an eye's own size from its half-size picture, by Catmull and Rom's cubic. A
// sample is as wide as two pixels, so a pixel lies a quarter of a sample before or behind its centre. A thread goes down one column of a
// tile's samples, so that each row is sampled across once.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/tile_mask.glsl"

layout(local_size_x = kTileSize / 2, local_size_y = kFillTiles) in;
layout(push_constant, scalar) uniform Push { FillPeripheryPass pass; };
layout(constant_id = 0) const bool kDepth = false;
layout(constant_id = 1) const bool kHalfColours = false;
layout(constant_id = 2) const bool kPast = false;  // later pictures are made from this one

#include "lib/picture.glsl"

// Weights of the samples from two before a pixel to one behind it, for a pixel before the centre of the third; in reverse order for one
// behind the centre of the second.
const vec4 kCubic = vec4(-0.0234375, 0.2265625, 0.8671875, -0.0703125);

// The two pixels of each sample of a column in one of its rows, before and behind the sample's centre; D and A between two samples.
struct Across {
    vec4 before, behind;
    vec2 linear_before, linear_behind;
};

Across sampleAcross(ivec2 at, ivec2 last) {
    const int row = clamp(at.y, 0, last.y) * (last.x + 1);
    vec4 taps[5];
    vec2 depths[3] = vec2[](vec2(0), vec2(0), vec2(0));
    [[unroll]] for (int x = 0; x < 5; ++x) {
        const uint k = uint(row + clamp(at.x + x - 2, 0, last.x));
        taps[x] = colourAt(pass.source, pass.half_source, k);
        if (kDepth && x > 0 && x < 4) { depths[x - 1] = vec2(pass.source_depths.at[k], taps[x].a); }
    }
    return Across(kCubic.x * taps[0] + kCubic.y * taps[1] + kCubic.z * taps[2] + kCubic.w * taps[3],
                  kCubic.w * taps[1] + kCubic.z * taps[2] + kCubic.y * taps[3] + kCubic.x * taps[4],
                  0.25 * depths[0] + 0.75 * depths[1], 0.75 * depths[1] + 0.25 * depths[2]);
}

// A pixel's D is its alpha times its depth, which is interpolated linearly and so does not overshoot.
void putPixel(uvec2 pixel, vec4 cubic, vec2 linear, bool hidden) {
    if (any(greaterThanEqual(pixel, pass.size_px))) { return; }
    const vec4 held = hidden ? vec4(pass.background, 0) : max(cubic, vec4(0));
    const vec4 colour = vec4(held.rgb, min(held.a, 1));
    const uint k = pixel.y * pass.size_px.x + pixel.x;
    putColour(pass.target, pass.half_target, k, colour);
    if (kDepth) { pass.depths.at[k] = !hidden && linear.y > 0 ? colour.a * linear.x / linear.y : 0; }
}

// Writes what later pictures must know of each of the sample's pixels: how far away the sample is.
void putWords(ivec2 at, ivec2 last, bool hidden) {
    const uint word = hidden ? 0 : pass.source_words.at[at.y * (last.x + 1) + at.x];
    [[unroll]] for (uint i = 0; i < 4; ++i) {
        const uvec2 pixel = uvec2(2 * at) + uvec2(i & 1, i >> 1);
        if (all(lessThan(pixel, pass.size_px))) { pass.words.at[pixel.y * pass.size_px.x + pixel.x] = word; }
    }
}

// And of the tile: its cost if rendered, estimated from that of the half-size tile that it is made from, and its error: the loss at half
// size plus the error of that tile's quarter.
void putTile(uvec2 tile, uvec2 size_tiles, bool hidden) {
    const uvec2 half_tiles = ((pass.size_px + 1) / 2 + kTileSize - 1) / kTileSize;
    const PastTile from = pass.source_tiles.at[tile.y / 2 * half_tiles.x + tile.x / 2];
    const uint at = tile.y * size_tiles.x + tile.x, quarter = 2 * (tile.y & 1) + (tile.x & 1);
    const float lost = sqrt(float(pass.tile_losses.at[at]) / (kErrorSteps * 3 * kTileSize * kTileSize));
    PastTile its = PastTile(0, 0, vec4(0), vec4(0), uvec4(0));
    if (!hidden) {
        its.cost = uint(kOwnCost * float(from.cost));
        its.errors = vec4(lost + from.errors[quarter]);
    }
    pass.tiles.at[at] = its;
}

vec4 cubicDown(vec4 a, vec4 b, vec4 c, vec4 d) { return kCubic.x * a + kCubic.y * b + kCubic.z * c + kCubic.w * d; }
vec2 linearDown(vec2 far, vec2 near) { return 0.25 * far + 0.75 * near; }

void main() {
    const uvec2 size_tiles = (pass.size_px + kTileSize - 1) / kTileSize;
    const uvec2 tile = uvec2(gl_WorkGroupID.x * kFillTiles + gl_LocalInvocationID.y, gl_WorkGroupID.y);
    if (tile.x >= size_tiles.x || isInMask(pass.tile_mask, size_tiles, tile)) { return; }
    const bool hidden = any(notEqual(uvec2(pass.shown_mask), uvec2(0))) && !isInMask(pass.shown_mask, size_tiles, tile);
    const ivec2 last = ivec2((pass.size_px + 1) / 2) - 1;
    ivec2 at = ivec2(tile * (kTileSize / 2)) + ivec2(gl_LocalInvocationID.x, 0);
    if (kPast && gl_LocalInvocationID.x == 0) { putTile(tile, size_tiles, hidden); }
    if (at.x > last.x) { return; }
    // Rows from two above the sample to one below it.
    Across a = sampleAcross(at - ivec2(0, 2), last), b = sampleAcross(at - ivec2(0, 1), last), c = sampleAcross(at, last);
    Across d = sampleAcross(at + ivec2(0, 1), last);
    const int end = min(at.y + int(kTileSize) / 2, last.y + 1);
    [[dont_unroll]] do {
        const Across e = sampleAcross(at + ivec2(0, 2), last);
        const uvec2 pixel = uvec2(2 * at);
        putPixel(pixel, cubicDown(a.before, b.before, c.before, d.before), linearDown(b.linear_before, c.linear_before), hidden);
        putPixel(pixel + uvec2(1, 0), cubicDown(a.behind, b.behind, c.behind, d.behind), linearDown(b.linear_behind, c.linear_behind), hidden);
        putPixel(pixel + uvec2(0, 1), cubicDown(e.before, d.before, c.before, b.before), linearDown(d.linear_before, c.linear_before), hidden);
        putPixel(pixel + uvec2(1, 1), cubicDown(e.behind, d.behind, c.behind, b.behind), linearDown(d.linear_behind, c.linear_behind), hidden);
        if (kPast) { putWords(at, last, hidden); }
        a = b;
        b = c;
        c = d;
        d = e;
        ++at.y;
    } while (at.y < end);
}
