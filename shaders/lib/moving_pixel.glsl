// A pixel on its way from one eye to the other, in a word. Of two that meet in a pixel the greater one stays: the nearer.
//
//   31..6  one more than the upper 26 of the 31 bits of its inverse depth; 0: nothing is there, or it goes nowhere
//   5      it landed in this pixel; otherwise it lies between two that did
//   4..0   how far its inverse depth spreads, as the standard deviation's share of the mean: 2^((code - 1)/2 - 13), or nothing;
//          where colours are copied, which pixel it is: bit 0 of its column, and in the next place that of its row
//
// What is cut off the inverse depth is 2^-19 of it: 1e-4 px where the eyes see a point 50 px apart.

const uint kLanded = 0x20u;
const uint kSpreadBits = 0x1fu;

uint movingPixel(float inverse_depth, uint landed, uint spread) { return ((((floatBitsToUint(inverse_depth) + 16) >> 5) + 1) << 6) | landed | spread; }
float inverseDepthOf(uint moving) { return uintBitsToFloat(((moving >> 6) - 1) << 5); }

// Moved back from the middle of the pixel it arrived in, a pixel is less than one off, by what it landed beside that middle: of those
// around that place, only one has its parity.
uint parityOf(uvec2 pixel) { return (pixel.x & 1) | (pixel.y & 1) << 1; }
ivec2 pixelOfParity(vec2 place_px, uint moving) {
    const vec2 parity = vec2(moving & 1, moving >> 1 & 1);
    return ivec2(2 * round(0.5 * (place_px - 0.5 - parity)) + parity);
}

// `spread`: of the inverse depth, as a share of it. NaN counts as none.
uint spreadCode(float spread) {
    if (!(spread > 0)) { return 0; }
    return uint(clamp(round(2 * (log2(spread) - kLeastSpreadLog2)) + 1, 0, float(kSpreadCodes)));
}
float spreadOf(uint moving) {
    const uint code = moving & kSpreadBits;
    return code == 0 ? 0 : exp2(0.5 * float(code - 1) + kLeastSpreadLog2);
}
