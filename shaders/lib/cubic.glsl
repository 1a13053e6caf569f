// A cubic kernel (Catmull and Rom 1974) over the source's picture. For shaders that have sourceAt().

// Weights of the samples at -1, 0, 1, 2 for a place `t` after sample 0. At t = 0 they are exactly 0, 1, 0, 0.
vec4 cubicWeights(float t) {
    return 0.5 *
           vec4(t * (-1 + t * (2 - t)), 2 + t * t * (-5 + 3 * t), t * (1 + t * (4 - 3 * t)), t * t * (t - 1));
}

// A colour; how the picture changes from pixel to pixel along the disparity, at the pixel that contains the
// place; and the squared loss caused by sampling between pixels.
struct Sample {
    vec4 colour;
    vec3 gradient;
    float lost;
    float squared_gradient;  // of the picture, summed over channels
};

// What alternates in sign from pixel to pixel is lost halfway between pixels, and partly on the way there.
vec3 lostBetween(float t, vec3 third_difference) { return 0.5 * t * (1 - t) * third_difference; }

// Rectified pixels keep their row, where the vertical kernel is exactly 1.
Sample sampleInRow(float place_px, uint row, int width) {
    const float from_first = clamp(place_px, 0.5, float(width) - 0.5) - 0.5;
    const int base = int(floor(from_first));
    const float t = from_first - float(base);
    const vec4 weights = cubicWeights(t);
    vec4 taps[4];
    [[unroll]] for (int x = 0; x < 4; ++x) {
        taps[x] = sourceAt(row + uint(clamp(base + x - 1, 0, width - 1)));
    }
    const vec4 colour = weights.x * taps[0] + weights.y * taps[1] + weights.z * taps[2] + weights.w * taps[3];
    const vec3 lost = lostBetween(t, taps[3].rgb - taps[0].rgb + 3 * (taps[1].rgb - taps[2].rgb));
    return Sample(max(colour, vec4(0)),
                  0.5 * (t < 0.5 ? taps[2].rgb - taps[0].rgb : taps[3].rgb - taps[1].rgb), dot(lost, lost),
                  0);
}

Sample sampleAround(vec2 place_px, ivec2 size, vec2 direction) {
    const vec2 from_first = clamp(place_px, vec2(0.5), vec2(size) - 0.5) - 0.5;
    const ivec2 base = ivec2(floor(from_first));
    const vec2 t = from_first - vec2(base);
    const vec4 weights_x = cubicWeights(t.x), weights_y = cubicWeights(t.y);
    const bool first_column = t.x < 0.5, first_row = t.y < 0.5;
    vec4 sum = vec4(0);
    vec3 across = vec3(0), down = vec3(0), lost_across = vec3(0), third_down = vec3(0);
    [[unroll]] for (int y = 0; y < 4; ++y) {
        const int row = clamp(base.y + y - 1, 0, size.y - 1) * size.x;
        vec4 taps[4];
        [[unroll]] for (int x = 0; x < 4; ++x) {
            taps[x] = sourceAt(uint(row + clamp(base.x + x - 1, 0, size.x - 1)));
        }
        sum += weights_y[y] * (weights_x.x * taps[0] + weights_x.y * taps[1] + weights_x.z * taps[2] +
                               weights_x.w * taps[3]);
        if (y == 1 && first_row || y == 2 && !first_row) {
            across = 0.5 * (first_column ? taps[2].rgb - taps[0].rgb : taps[3].rgb - taps[1].rgb);
            lost_across = lostBetween(t.x, taps[3].rgb - taps[0].rgb + 3 * (taps[1].rgb - taps[2].rgb));
        }
        const vec3 middle = first_column ? taps[1].rgb : taps[2].rgb;
        if (y == (first_row ? 0 : 1)) { down -= 0.5 * middle; }
        if (y == (first_row ? 2 : 3)) { down += 0.5 * middle; }
        third_down += (y == 0 ? -1.0 : y == 1 ? 3.0 : y == 2 ? -3.0 : 1.0) * middle;
    }
    const vec3 lost_down = lostBetween(t.y, third_down);
    return Sample(max(sum, vec4(0)), direction.x * across + direction.y * down,
                  dot(lost_across, lost_across) + dot(lost_down, lost_down),
                  dot(across, across) + dot(down, down));
}
