// present: an eye's picture in the format of the headset's swapchain image: 8 bits per channel and, on
// request, its depth. Trained values are display-encoded already, as are the bytes of an sRGB image. A
// program's own picture may lie behind it, and in front of it where the program's depth says so: compared
// with the depth that stands for all splats of a pixel, unless each was tested by itself.
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
    if (kind == kTileHidden) { return colour; }  // nothing says how its pixels were made
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

// As it was displayed, whatever the order and the meaning of its bytes.
vec4 unpackBehind(uint bytes) {
    const vec4 value = unpackUnorm4x8(bytes), ordered = pass.blue_first != 0 ? value.bgra : value;
    return pass.linear != 0 ? vec4(encode(ordered.rgb), ordered.a) : ordered;
}

// The depth of everything that a pixel shows: D/A, or what its word says.
float inverseDepthAt(uint i, float alpha) {
    if (!isThere(uvec2(pass.words))) { return alpha / pass.depths.at[i]; }
    const uint word = pass.words.at[i];
    return word == 0 ? 0 : inverseDepthOf(word);
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, pass.size_px))) { return; }
    const uint i = at.y * pass.size_px.x + at.x;
    vec4 pixel = colourAt(pass.colours, pass.half_colours, i);
    const bool has_mesh = isThere(uvec2(pass.mesh_depths)), has_depth = has_mesh || isThere(uvec2(pass.device_depths));
    const float inverse_depth = has_depth ? inverseDepthAt(i, pixel.a) : 0;
    const float mesh_depth = has_mesh ? pass.mesh_depths.at[i] : 0;
    if (has_mesh && pass.is_cut == 0 && !(inverse_depth > (mesh_depth - pass.depth_offset) / pass.depth_scale)) { pixel = vec4(0); }
    vec3 colour = clampToDisplay(pixel.rgb);
    // Colours were multiplied by alpha as display-encoded values, but headsets blend light: alpha is divided
    // out and multiplied back in.
    const bool see_through = pass.see_through != 0, linear = pass.linear != 0;
    const float alpha = see_through ? (pixel.a > 0 ? min(pixel.a, 1) : 0) : 1;
    float left_alpha = alpha;
    if (pass.over != 0) {
        const vec4 behind = unpackBehind(pass.pixels.at[i]);
        const float share = 1 - (pixel.a > 0 ? min(pixel.a, 1) : 0);
        colour = min(colour + share * behind.rgb, vec3(1));
        left_alpha = 1 - share + share * behind.a;
    }
    if (see_through) { colour = alpha > 0 ? clampToDisplay(pixel.rgb / alpha) : vec3(0); }
    if (isThere(uvec2(pass.tile_kinds))) { colour = tint(colour, at, (pass.size_px.x + kTileSize - 1) / kTileSize); }
    if (linear || see_through) { colour = alpha * decode(colour); }
    if (see_through && !linear) { colour = encode(colour); }
    const uvec3 bytes = uvec3(colour * 255 + 0.5);
    const uint word = (pass.blue_first != 0 ? bytes.b | bytes.g << 8 | bytes.r << 16 : bytes.r | bytes.g << 8 | bytes.b << 16) | uint(left_alpha * 255 + 0.5) << 24;
    const uint kept = pass.kept_bits;
    pass.pixels.at[i] = kept == 0 ? word : (word & ~kept) | (pass.pixels.at[i] & kept);
    if (isThere(uvec2(pass.device_depths))) {
        // Infinitely far where there is nothing; in a pixel with a mesh, the depth of whichever covers more
        // of it.
        const bool is_shown = inverse_depth > 0 && pixel.a >= (has_mesh ? 0.5 : kMinAlpha);
        const float own = clamp((is_shown ? inverse_depth * pass.depth_scale : 0) + pass.depth_offset, 0, 1);
        pass.device_depths.at[i] = has_mesh && !is_shown ? mesh_depth : own;
    }
}
