// present: an eye's picture in the format of the headset's swapchain image: 8 bits per channel and, on request, its depth. Trained values
// are display-encoded already, as are the bytes of an sRGB image.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"

layout(constant_id = 0) const bool kHalfColours = false;
layout(local_size_x = 16, local_size_y = 8) in;

#include "lib/picture.glsl"
#include "lib/moving_pixel.glsl"
#include "lib/srgb.glsl"

layout(push_constant, scalar) uniform Push { PresentPass pass; };

// NaN becomes 0, like everything that is not above 0.
vec3 clampToDisplay(vec3 colour) { return mix(vec3(0), min(colour, vec3(1)), greaterThan(colour, vec3(0))); }

// The share is kTintShare of engine/picture/roi_picture.h and the colours are those of its tintOf.
vec3 tint(vec3 colour, uvec2 at, uint row_tiles) {
    const uint kind = pass.tile_kinds.at[(at.y / kTileSize) * row_tiles + at.x / kTileSize];
    if (kind == kTileHidden) { return colour; }  // nothing says what made its pixels
    const uint pixel_class = isThere(uvec2(pass.pixel_classes)) ? (pass.pixel_classes.at[at.y * row_tiles + at.x / kTileSize] >> (2 * (at.x % kTileSize))) & 3u : kCovered;
    vec3 shade;
    if (kind == kTileEdge) {
        shade = vec3(0, 0.35, 1);
    } else if (kind == kTileCenter) {
        shade = vec3(0, 0.8, 0.2);
    } else if (kind == kTilePredicted) {
        shade = vec3(0.9, 0, 0.9);
    } else if (kind == kTileCheap) {
        shade = vec3(0, 0.8, 0.9);
    } else if (pixel_class == kGap) {
        shade = vec3(1, 0.85, 0);
    } else if (pixel_class == kHole) {
        shade = vec3(1, 0, 0);
    } else {
        return colour;
    }
    return mix(colour, shade, 0.4);
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, pass.size_px))) { return; }
    const uint i = at.y * pass.size_px.x + at.x;
    const vec4 pixel = colourAt(pass.colours, pass.half_colours, i);
    vec3 colour = clampToDisplay(pixel.rgb);
    // Colours were multiplied by alpha as display-encoded values, but headsets blend light: alpha is divided out and multiplied back in.
    const bool see_through = pass.see_through != 0, linear = pass.linear != 0;
    const float alpha = see_through ? (pixel.a > 0 ? min(pixel.a, 1) : 0) : 1;
    if (see_through) { colour = alpha > 0 ? clampToDisplay(pixel.rgb / alpha) : vec3(0); }
    if (isThere(uvec2(pass.tile_kinds))) { colour = tint(colour, at, (pass.size_px.x + kTileSize - 1) / kTileSize); }
    if (linear || see_through) { colour = alpha * decode(colour); }
    if (see_through && !linear) { colour = encode(colour); }
    const uvec3 bytes = uvec3(colour * 255 + 0.5);
    pass.pixels.at[i] = (pass.blue_first != 0 ? bytes.b | bytes.g << 8 | bytes.r << 16 : bytes.r | bytes.g << 8 | bytes.b << 16) | uint(alpha * 255 + 0.5) << 24;
    if (isThere(uvec2(pass.device_depths))) {
        // near over the depth D/A: 1 at the near plane, 0 where there is nothing.
        const bool from_words = isThere(uvec2(pass.words));
        const uint word = from_words ? pass.words.at[i] : 0;
        const float share = !from_words ? pass.near * pixel.a / pass.depths.at[i] : word == 0 ? 0 : pass.near * inverseDepthOf(word);
        pass.device_depths.at[i] = share > 0 && pixel.a >= kMinAlpha ? min(share, 1) : 0;
    }
}
