// What rasterize leaves for pictures made from its own: how far off a tile was, and how fast its error grew.

#include "lib/history_tile.glsl"

// Adds the difference between a pixel and what was there before.
void addError(inout float error, vec3 shown, uvec2 colours, uint at) {
    const vec3 off = shown - colourAt(FloatColours(colours), HalfColours(colours), at).rgb;
    error += min(dot(off, off), kMaxPixelError);
}

bool isMade() { return kMasked && (!kCoarse || TARGET.is_made != 0); }

// From sums over a quarter's pixels and channels, in kErrorSteps.
vec4 amplitudeOf(vec4 sums) { return sqrt(sums / (kErrorSteps * 3 * kCellSize * kCellSize)); }

uint inSquareSteps(float squares) { return uint(min(squares, kMostSquares) * kSquareSteps + 0.5); }

// Writes what a picture made from this one must know about the tile. `sums`: the errors that its quarters
// turned out to have; `lost`: the amplitude that a coarse tile lacks.
void leaveTile(uint tile, uint cost, vec4 sums, float lost) {
    const vec4 amplitude = isMade() ? amplitudeOf(sums) : vec4(0);
    HistoryTiles history_tiles = HistoryTiles(TARGET.history_tiles);
    const uint age = isMade() ? history_tiles.at[tile].age : 0;  // 0: nothing was there
    // An error of a tile that had never been seen says nothing about later frames.
    const vec4 expected = age > 0 ? amplitudeOf(vec4(history_tiles.at[tile].grown)) : vec4(1);
    vec4 counts = mix(vec4(1), vec4(0), greaterThanEqual(expected, vec4(kUnseenGrowth)));
    [[unroll]] for (uint q = 0; q < 4; ++q) {
        if (isMade() && unseenIn(history_tiles.at[tile].unseen, q) >= kNewPixels) { counts[q] = 0; }
    }
    const vec4 growth = counts * amplitude / float(max(age, 1)), off = history_tiles.at[tile].errors;
    if (kMasked && age > 0) {
        atomicAdd(TARGET.warp_counters.expected_squares,
                  inSquareSteps(3 * float(kCellSize * kCellSize) * dot(counts, off * off)));
        atomicAdd(TARGET.warp_counters.found_squares, inSquareSteps(dot(counts, sums) / kErrorSteps));
    }
    history_tiles.at[tile] = HistoryTile(cost, 0, growth, vec4(0), uvec4(0), lost, 0, 0);
}

// True if this frame measures what the tile would lose with pixels twice as wide, once it is rendered.
bool isMeasured(uint tile) {
    const bool measured =
        kMeasures && !is_wider && TARGET.is_made != 0 && tile % kMeasuredParts == TARGET.measured;
    if (measured && gl_LocalInvocationIndex == 0) {
        frames_waited = clamp(HistoryTiles(TARGET.history_tiles).at[tile].age, 1, kMostWaited);
    }
    return measured;
}

// What its pixels have found: its error or, with pixels twice as wide, their loss.
void leaveFound(uint tile, uint cost, vec4 sums) {
    if (kMeasures && is_wider) {
        atomicAdd(TARGET.warp_counters.wider_squares,
                  inSquareSteps(dot(sums, vec4(1)) / kErrorSteps) * frames_waited);
    } else {
        leaveTile(tile, cost, sums, 0);
    }
}
