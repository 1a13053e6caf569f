// turn: shows a presented picture in a view from the same place with other axes, as a headset's compositor
// does: each pixel from the four around its place, with linear weights, in linear light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"

layout(local_size_x = 16, local_size_y = 8) in;

#include "lib/srgb.glsl"

layout(push_constant, scalar) uniform Push { TurnPass pass; };

vec4 lightAt(uint x, uint y) {
    const vec4 value = unpackUnorm4x8(pass.pixels.at[y * pass.picture_px.x + x]);
    return pass.linear != 0 ? value : vec4(decode(value.rgb), value.a);
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, pass.view_px))) { return; }
    const vec3 ray = mat3(pass.column_x, pass.column_y, pass.column_z) * vec3(vec2(at) + 0.5, 1);
    const uvec2 last = pass.picture_px - 1;
    const vec2 place = clamp(ray.xy / ray.z - 0.5, vec2(0), vec2(last));
    const uvec2 low = uvec2(place), high = min(low + 1, last);
    const vec2 share = place - vec2(low);
    const vec4 light = mix(mix(lightAt(low.x, low.y), lightAt(high.x, low.y), share.x),
                           mix(lightAt(low.x, high.y), lightAt(high.x, high.y), share.x), share.y);
    pass.shown.at[at.y * pass.view_px.x + at.x] =
        packUnorm4x8(pass.linear != 0 ? light : vec4(encode(light.rgb), light.a));
}
