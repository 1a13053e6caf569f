// A pixel on its way from one eye to the other, in a word. If two meet in a pixel, the greater word stays:
// the nearer pixel.
//
//   31..6  one more than the upper 26 of the 31 bits of its inverse depth; 0: nothing is there, or it goes
//          nowhere
//   5      it landed in this pixel; otherwise it lies between two that did
//   4..0   how far its inverse depth spreads, as the standard deviation's share of the mean:
//          2^((code - 1)/2 - 13), or nothing; where colours are copied, which pixel it is: bit 0 of its
//          column, and in the next place that of its row
//
// Rounding costs up to 2^-19 of the inverse depth: 1e-4 px where the eyes see a point 50 px apart.

#include "lib/sign.glsl"

const uint kLanded = 0x20u;
const uint kSpreadBits = 0x1fu;

uint movingPixel(float inverse_depth, uint landed, uint spread) {
    return ((((floatBitsToUint(inverse_depth) + 16) >> 5) + 1) << 6) | landed | spread;
}
float inverseDepthOf(uint moving) { return uintBitsToFloat(((moving >> 6) - 1) << 5); }

// A pixel is moved back from the middle of the pixel in which it arrived, so it is misplaced by its distance
// from that middle, which is less than a pixel. Only one of the pixels around that place has its parity.
uint parityOf(uvec2 pixel) { return (pixel.x & 1) | (pixel.y & 1) << 1; }
ivec2 pixelOfParity(vec2 place_px, uint moving) {
    const vec2 parity = vec2(moving & 1, moving >> 1 & 1);
    return ivec2(2 * round(0.5 * (place_px - 0.5 - parity)) + parity);
}

// Half octaves of the spread are octaves of its square, which the exponent gives. `variance_share`: variance
// of the inverse depth, as a share of its square. NaN counts as none.
uint spreadCode(float variance_share) {
    const int octave = int(floatBitsToUint(variance_share * 1.41421356) >> 23) - 127;  // the nearest
    return isPositive(variance_share)
               ? uint(clamp(octave - int(2 * kLeastSpreadLog2) + 1, 0, int(kSpreadCodes)))
               : 0;
}
float varianceShareOf(uint moving) {
    const int code = int(moving & kSpreadBits);
    return code == 0 ? 0 : intBitsToFloat((code - 1 + int(2 * kLeastSpreadLog2) + 127) << 23);
}
