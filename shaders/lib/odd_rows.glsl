// Rows that are made after those above and below them: sampled at the places of the row above, or as the mean
// of both. For resample.

// Where a pixel was sampled, for the pixel below it in an odd row; stored where that pixel's colour is going
// to be.
//
//   31..3  its column in the source, in pixels, with 15 bits of fraction
// 1: it repeats a neighbour, in the row above
//   1..0   the class
//
// If depths are requested, a second word follows: the inverse depth.
const float kPlaceSteps = 32768;
const uint kRepeats = 4;

Uints placeWords() { return Uints(uvec2(pass.half_target)); }
uint placeAt(WarpView warp, uvec2 at) { return (at.y * warp.size_px.x + at.x) * (kHalfColours ? 2 : 4); }

void keepPlace(WarpView warp, uvec2 at, Resolved resolved, float place_px) {
    if (at.y + 1 >= warp.size_px.y) { return; }
    const uint word = placeAt(warp, at + uvec2(0, 1));
    const uint steps = uint(clamp(place_px, 0.0, float(warp.size_px.x) - 0.5) * kPlaceSteps + 0.5);
    placeWords().at[word] = steps << 3 | (resolved.column != at.x ? kRepeats : 0) | resolved.pixel_class;
    if (keepsDepths()) { placeWords().at[word + 1] = floatBitsToUint(resolved.inverse_depth); }
}

// Writes a pixel of an odd row. A neighbour is repeated as the row above shows it, since that row's depths
// chose the neighbour.
float sampleBelow(WarpView warp, uvec2 at, out uint pixel_class) {
    const uint word = placeAt(warp, at), place = placeWords().at[word];
    pixel_class = place & 3;
    const uint source_row = (place & kRepeats) != 0 ? at.y - 1 : at.y;
    const Sample found =
        sampleInRow(float(place >> 3) / kPlaceSteps, source_row * warp.size_px.x, int(warp.size_px.x));
    putPixel(warp, at, pixel_class, found.colour,
             keepsDepths() ? uintBitsToFloat(placeWords().at[word + 1]) : 0);
    return 0;
}

// True if the row may be the mean of those above and below: both exist, in the same tiles, and tile_errors
// says in which.
bool mayBeMean(WarpView warp, uint y) {
    const bool between = (y & 1) == 1 && (y + 1) % kTileSize != 0 && y + 1 < warp.size_px.y;
    return !predictsErrors() && between && isThere(uvec2(pass.tile_errors));
}

// The rows above and below this one are even, and finished before any odd row is begun.
void putMeans(uint y, uint width, uint tiles) {
    for (uint item = gl_LocalInvocationIndex; item < mean_count * kTileSize; item += kWarpGroup) {
        const uint tile = reprojected_tiles[kMostTiles - 1 - item / kTileSize],
                   x = tile * kTileSize + item % kTileSize;
        if (kClasses && item % kTileSize == 0) {
            tile_classes[tile] = pass.pixel_classes.at[(y - 1) * tiles + tile];
        }
        if (x >= width) { continue; }
        const uint i = y * width + x;
        const vec4 above = colourAt(pass.target, pass.half_target, i - width);
        const vec4 below = colourAt(pass.target, pass.half_target, i + width);
        putColour(pass.target, pass.half_target, i, 0.5 * (above + below));
        if (keepsDepths()) {
            pass.depths.at[i] = 0.5 * (pass.depths.at[i - width] + pass.depths.at[i + width]);
        }
    }
}
