// Pixels of a picture, as floats or as half floats. For shaders that say which: kHalfColours.

#include "lib/address.glsl"

uvec2 packHalves(vec4 colour) {
    const vec4 finite = clamp(colour, vec4(-65504), vec4(65504));  // what half floats reach
    return uvec2(packHalf2x16(finite.xy), packHalf2x16(finite.zw));
}
vec4 unpackHalves(uvec2 packed) { return vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y)); }

vec4 colourAt(FloatColours colours, HalfColours half_colours, uint i) {
    return kHalfColours ? unpackHalves(half_colours.at[i]) : colours.at[i];
}

void putColour(FloatColours colours, HalfColours half_colours, uint i, vec4 colour) {
    if (kHalfColours) {
        half_colours.at[i] = packHalves(colour);
    } else {
        colours.at[i] = colour;
    }
}
