// How rasterize fills coarse tiles from their samples.

// Fills each cell's coarse tile from the samples that were blended, unless the eye would notice the loss;
// returns a bit for each of these.
uint fillTiles(uint tile, uvec2 tile_px, uvec2 range) {
    const bool is_there = range.x < range.y;
    barrier();  // batches are still being blended
    if (gl_LocalInvocationIndex < kCellsPerTile) { cell_details[gl_LocalInvocationIndex] = 0; }
    if (gl_LocalInvocationIndex == 0) { sharp_cells = 0; }
    const ivec2 first = ivec2(indexInCell() % kCellSize, indexInCell() / kCellSize * kPixels);
    [[unroll]] for (uint p = 0; p < kPixels; ++p) {
        const float left = abs(transmittance[p]);
        putSample(cellIndex(), first + ivec2(0, p), vec4(shownOf(colour[p], left), 1 - left),
                  left < 1 ? depthSum(p, 1 - left) / (1 - left) : 0,
                  kHistory ? toMove(1 - left, depth[p], moments[p]) : 0);
    }
    barrier();
    float details = 0;
    [[unroll]] for (uint p = 0; p < kPixels; ++p) { details += detailAt(cellIndex(), first + ivec2(0, p)); }
    if (is_there) { atomicAdd(cell_details[cellIndex()], uint(details * kErrorSteps)); }
    barrier();
    const float lost = kCoarseLoss * float(cell_details[cellIndex()]);
    if (indexInCell() == 0 && is_there) {
        const bool is_seen =
            seenShareThere(TARGET.counters.gaze, tile_px / kTileSize) * lost >= kLeastSeenError * kErrorSteps;
        if (is_seen) { atomicOr(sharp_cells, 1u << cellIndex()); }
        atomicAdd(TARGET.counters.coarse_kept, is_seen ? 0 : 1);
        atomicAdd(TARGET.counters.coarse_pairs, range.y - range.x);
    }
    barrier();
    const uint sharp = sharp_cells;
    const bool is_filled = is_there && (sharp & (1u << cellIndex())) == 0;
    float error = 0;
    if (is_filled) {
        const uvec2 colours = TARGET.colours, depths = kDepth ? TARGET.depths : uvec2(0),
                    moving = kHistory ? TARGET.moving : uvec2(0);
        const uint width = pass.eyes.at[gl_WorkGroupID.z].size_px.x;
        for (uint task = indexInCell(); task < 2 * kTileSize; task += kThreadsPerCell) {
            const int x = int(task % kTileSize);
            const bool is_lower = task >= kTileSize;
            Column column = beginColumn(cellIndex(), x, is_lower);
            int p = 0;
            [[dont_unroll]] do {
                const vec4 filled = fillPixel(column, p);
                const int y = mirrored(p, int(kTileSize) - 1, is_lower);
                const ivec2 nearest = ivec2(x, y) / 2;
                const uvec2 pixel = tile_px + uvec2(x, y);
                const uint at = pixel.y * width + pixel.x;
                if (kHistory && isMade()) { addError(error, filled.rgb, colours, at); }
                putColour(FloatColours(colours), HalfColours(colours), at, filled);
                if (kDepth && isThere(depths)) {
                    Floats(depths).at[at] = filled.a * sampleDepth(cellIndex(), nearest);
                }
                if (kHistory) {
                    Uints(moving).at[pixel.y * width + pixel.x] = sampleWord(cellIndex(), nearest);
                }
                ++p;
            }
            while (p < kHalfTile)
                ;
        }
    }
    if (kHistory) {
        if (is_filled) { atomicAdd(squares[cellIndex()], uint(error * kErrorSteps)); }
        barrier();
        if (is_filled && indexInCell() == 0) {
            const vec4 sums = vec4(float(squares[cellIndex()]) / kCellsPerTile);
            leaveTile(tile, (range.y - range.x) / kCellsPerTile, sums,
                      sqrt(lost / (kErrorSteps * 3 * kTileSize * kTileSize)));
        }
    }
    return sharp;
}
