// A kernel for pictures that are resampled again and again: Lagrange's polynomial through six samples, plus
// what it blurs, as differences of the samples before and after the place. Weights sum to 1, and no frequency
// comes out stronger than it went in, for any place between the two middle samples.

const uint kTaps = 6;

// Fourth differences around sample 0, and second ones, in the shares that lose least of a picture whose
// amplitudes fall with frequency, at no gain above 1.
const float kSharper[kTaps] = float[kTaps](0.024, -0.076, 0.104, -0.076, 0.024, 0);

// Weights of the samples at -2 ... 3 for a place `t` (0 to 1) after sample 0. At t = 0 and 1 they are exactly
// 0 and 1.
void sixTapWeights(float t, out float weights[kTaps]) {
    const float a = t + 2, b = t + 1, c = t, d = t - 1, e = t - 2, f = t - 3;
    const float low = a * b * c, high = d * e * f;
    weights[0] = b * c * high * (-1.0 / 120);
    weights[1] = a * c * high * (1.0 / 24);
    weights[2] = a * b * high * (-1.0 / 12);
    weights[3] = low * e * f * (1.0 / 12);
    weights[4] = low * d * f * (-1.0 / 24);
    weights[5] = low * d * e * (1.0 / 120);
    const float most = 16 * c * c * d * d, before = -d * most, after = c * most;
    [[unroll]] for (uint k = 0; k < kTaps; ++k) {
        weights[k] += before * kSharper[k] + after * kSharper[kTaps - 1 - k];
    }
}

// 32 times the amplitude of what alternates in sign over six consecutive samples. It is lost halfway between
// them; of longer waves more is kept, so that all in all four fifths are lost.
const float kFifthDifference[kTaps] = float[kTaps](-1, 5, -10, 10, -5, 1);
float lostShare(float t) { return 0.8 * 4 * t * (1 - t) / 32; }
