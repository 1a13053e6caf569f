// present: an eye's picture in the format of the headset's swapchain image: 8 bits per channel and, on
// request, its depth. Trained values are already encoded for a display, as are the bytes of an sRGB image. A
// program's own picture may be behind it, and in front of it where the program's depth says so: that is
// compared with the depth that stands for all splats of a pixel, unless each splat was tested by itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
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
    const uint pixel_class =
        isThere(uvec2(pass.pixel_classes))
            ? (pass.pixel_classes.at[at.y * row_tiles + at.x / kTileSize] >> (2 * (at.x % kTileSize))) & 3u
            : kCovered;
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

// Of all that a pixel shows: of D/A, or as its word has it.
float inverseDepthAt(uint i) {
    if (!isThere(uvec2(pass.words))) {
        const float depth_sum = pass.depths.at[i];
        return depth_sum > 0 ? colourAt(pass.colours, pass.half_colours, i).a / depth_sum : 0;
    }
    const uint word = pass.words.at[i];
    return word == 0 ? 0 : inverseDepthOf(word);
}

// From pixel to pixel depths of one surface differ by less than this share, and those of two by more than
// that.
const float kOnSurface = 0.02, kBetweenSurfaces = 0.1;
const int kSilhouettePx = 16;  // on each side of a silhouette

// Where the slope of depths ends that leads away from a pixel: on the surface there; 0: none is near.
float surfaceAlong(ivec2 at, ivec2 way, float inverse_depth) {
    [[dont_unroll]] for (int step = 0; step < kSilhouettePx; ++step) {
        at += way;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(pass.size_px)))) { return 0; }
        const float next = inverseDepthAt(uint(at.y) * pass.size_px.x + uint(at.x));
        if (abs(next - inverse_depth) <= kOnSurface * inverse_depth) {
            return step == 0 ? inverse_depth : next;
        }
        inverse_depth = next;
    }
    return 0;
}

// At a silhouette a pixel blends two surfaces, and its mean depth lies between them, where nothing is: of the
// surface at which blending passes half of the light. Elsewhere the pixel's own.
float surfaceDepth(ivec2 at, float inverse_depth, float alpha) {
    float front = 0, back = 3e38;
    [[dont_unroll]] for (int w = 0; w < 4; ++w) {
        const float found = surfaceAlong(at, ivec2(w & 1, 1 - (w & 1)) * (w < 2 ? 1 : -1), inverse_depth);
        front = max(front, found);
        back = found > 0 ? min(back, found) : back;
    }
    if (!(front > (1 + kBetweenSurfaces) * back)) { return inverse_depth; }
    const bool is_of_inverse = isThere(uvec2(pass.words));  // the mean
    const float share = is_of_inverse ? (inverse_depth - back) / (front - back)
                                      : (1 / back - 1 / inverse_depth) / (1 / back - 1 / front);
    return share * alpha >= 0.5 ? front : back;
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, pass.size_px))) { return; }
    const uint i = at.y * pass.size_px.x + at.x;
    vec4 pixel = colourAt(pass.colours, pass.half_colours, i);
    const bool has_mesh = isThere(uvec2(pass.mesh_depths)),
               has_depth = has_mesh || isThere(uvec2(pass.device_depths));
    float inverse_depth = has_depth ? inverseDepthAt(i) : 0;
    const float mesh_depth = has_mesh ? pass.mesh_depths.at[i] : 0;
    if (has_mesh && pass.is_cut == 0 &&
        !(inverse_depth > (mesh_depth - pass.depth_offset) / pass.depth_scale)) {
        pixel = vec4(0);
    }
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
    if (isThere(uvec2(pass.tile_kinds))) {
        colour = tint(colour, at, (pass.size_px.x + kTileSize - 1) / kTileSize);
    }
    if (linear || see_through) { colour = alpha * decode(colour); }
    if (see_through && !linear) { colour = encode(colour); }
    const uvec3 bytes = uvec3(colour * 255 + 0.5);
    const uint word = (pass.blue_first != 0 ? bytes.b | bytes.g << 8 | bytes.r << 16
                                            : bytes.r | bytes.g << 8 | bytes.b << 16) |
                      uint(left_alpha * 255 + 0.5) << 24;
    const uint kept = pass.kept_bits;
    pass.pixels.at[i] = kept == 0 ? word : (word & ~kept) | (pass.pixels.at[i] & kept);
    if (isThere(uvec2(pass.device_depths))) {
        // Of what is more of the pixel: infinitely far where that is nothing, and the mesh's depth where
        // there is one.
        const bool is_shown = inverse_depth > 0 && pixel.a >= 0.5;
        if (is_shown && !has_mesh && pass.of_surface == 0) {
            inverse_depth = surfaceDepth(ivec2(at), inverse_depth, pixel.a);
        }
        const float own = clamp((is_shown ? inverse_depth * pass.depth_scale : 0) + pass.depth_offset, 0, 1);
        pass.device_depths.at[i] = has_mesh && !is_shown ? mesh_depth : own;
    }
}
