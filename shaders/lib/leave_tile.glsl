// What rasterize leaves to pictures that are made from its own: how far off a tile was, and how fast its error grew.

#include "lib/past_tile.glsl"

// Adds the difference between a pixel and what was there before.
void addError(inout float error, vec3 shown, uvec2 colours, uint at) {
    const vec3 off = shown - colourAt(FloatColours(colours), HalfColours(colours), at).rgb;
    error += min(dot(off, off), kMaxPixelError);
}

bool isMade() { return kMasked && (!kCoarse || TARGET.is_made != 0); }

// Of sums over a quarter's pixels and channels, in kErrorSteps.
vec4 amplitudeOf(vec4 sums) { return sqrt(sums / (kErrorSteps * 3 * kCellSize * kCellSize)); }

// Writes what a picture that is made from this one must know of the tile; `sums` is what its quarters turned out to have had, and
// `lost` the amplitude that it lacks.
void leaveTile(uint tile, uint cost, vec4 sums, float lost) {
    const vec4 amplitude = isMade() ? amplitudeOf(sums) : vec4(0);
    PastTiles past_tiles = PastTiles(TARGET.past_tiles);
    const uint age = isMade() ? past_tiles.at[tile].age : 0;  // 0: nothing was there
    // What was wrong because nobody had seen it says nothing of later frames.
    const vec4 expected = age > 0 ? amplitudeOf(vec4(past_tiles.at[tile].grown)) : vec4(1);
    vec4 growth = mix(amplitude / float(max(age, 1)), vec4(0), greaterThanEqual(expected, vec4(kUnseenGrowth)));
    [[unroll]] for (uint q = 0; q < 4; ++q) {
        if (isMade() && unseenIn(past_tiles.at[tile].unseen, q) >= kNewPixels) { growth[q] = 0; }
    }
    past_tiles.at[tile] = PastTile(cost, 0, growth, vec4(0), uvec4(0), lost, 0);
}
