// A coarse tile: 8x8 samples, evenly spaced from the middle of the first pixel to that of the last, and the
// 16x16 pixels that Catmull and Rom's cubic makes of them. For rasterize, where each cell of a workgroup has
// such a tile: once its splats are blended, the samples take over their shared memory.

shared uint cell_details[kCellsPerTile];  // second differences, squared and summed, in kErrorSteps
shared uint sharp_cells;                  // cells whose tile needs all of its pixels, one bit each
shared uint most_pairs;                   // in a cell's tile

const int kLastSample = int(kCellSize) - 1, kHalfTile = int(kTileSize) / 2;

uint slotOf(uint cell, ivec2 at) {
    return (cell & 1) * kCellSize * kCellSize + uint(at.y) * kCellSize + uint(at.x);
}

// The sample's depth: D / A.
void putSample(uint cell, ivec2 at, vec4 colour, float depth, uint word) {
    const uint slot = slotOf(cell, at);
    if (cell < 2) {
        batch_reference[slot] = colour;
        batch_depth[slot].x = depth;
        batch_colour[slot].x = word;
    } else {
        batch_plane[slot] = colour;
        batch_depth[slot].y = depth;
        batch_colour[slot].y = word;
    }
}
vec4 sampleAt(uint cell, ivec2 at) {
    const uint slot = slotOf(cell, at);
    return cell < 2 ? batch_reference[slot] : batch_plane[slot];
}
float sampleDepth(uint cell, ivec2 at) {
    const vec2 depths = batch_depth[slotOf(cell, at)].xy;
    return cell < 2 ? depths.x : depths.y;
}
uint sampleWord(uint cell, ivec2 at) {
    const uvec2 words = batch_colour[slotOf(cell, at)];
    return cell < 2 ? words.x : words.y;
}

// Its squared second differences along both axes. There are none across the tile's border, so six out of
// eight samples stand for all.
float detailAt(uint cell, ivec2 at) {
    const vec3 here = sampleAt(cell, at).rgb;
    float squares = 0;
    if (at.x > 0 && at.x < kLastSample) {
        const vec3 across =
            sampleAt(cell, at - ivec2(1, 0)).rgb - 2 * here + sampleAt(cell, at + ivec2(1, 0)).rgb;
        squares += dot(across, across);
    }
    if (at.y > 0 && at.y < kLastSample) {
        const vec3 down =
            sampleAt(cell, at - ivec2(0, 1)).rgb - 2 * here + sampleAt(cell, at + ivec2(0, 1)).rgb;
        squares += dot(down, down);
    }
    return min(squares * (float(kCellSize) / float(kCellSize - 2)), kMaxPixelError);
}

// The weights of four samples for a pixel of the tile's first half, and the first of these samples. Outside
// the outermost sample, the parabola through it and the next two continues.
vec4 cubicAt(int pixel, out int first) {
    const float place = float(pixel) / kSamplesApart;
    const int before = int(place);
    const float t = place - float(before);
    const vec4 w = vec4(t * (t * (1 - 0.5 * t) - 0.5), 1 + t * t * (1.5 * t - 2.5),
                        t * (0.5 + t * (2 - 1.5 * t)), t * t * (0.5 * t - 0.5));
    first = max(before - 1, 0);
    return before == 0 ? vec4(w.y + 3 * w.x, w.z - 3 * w.x, w.w + w.x, 0) : w;
}

// The second half is the first one in reverse.
int mirrored(int i, int last, bool is_second) { return is_second ? last - i : i; }

// A column of half of the tile's pixels, from the border inwards, and the sampled rows from which its next
// pixel is made.
struct Column {
    uint cell;
    bool is_right, is_lower;
    int first_sample;  // along the rows
    vec4 across;
    vec4 rows[4];
    int rows_read;
};

void readRow(inout Column column) {
    const int y = mirrored(column.rows_read, kLastSample, column.is_lower);
    vec4 sum = vec4(0);
    [[unroll]] for (int i = 0; i < 4; ++i) {
        sum +=
            column.across[i] *
            sampleAt(column.cell, ivec2(mirrored(column.first_sample + i, kLastSample, column.is_right), y));
    }
    [[unroll]] for (int i = 0; i < 3; ++i) { column.rows[i] = column.rows[i + 1]; }
    column.rows[3] = sum;
    ++column.rows_read;
}

Column beginColumn(uint cell, int x, bool is_lower) {
    Column column;
    column.cell = cell;
    column.is_right = x >= kHalfTile;
    column.is_lower = is_lower;
    column.across = cubicAt(mirrored(x, int(kTileSize) - 1, column.is_right), column.first_sample);
    column.rows_read = 0;
    [[unroll]] for (int i = 0; i < 4; ++i) { column.rows[i] = vec4(0); }
    [[unroll]] for (int i = 0; i < 4; ++i) { readRow(column); }
    return column;
}

// The column's pixel `p`; must be called in order.
vec4 fillPixel(inout Column column, int p) {
    int first;
    const vec4 down = cubicAt(p, first);
    if (first + 4 > column.rows_read) { readRow(column); }
    const vec4 held = max(
        down.x * column.rows[0] + down.y * column.rows[1] + down.z * column.rows[2] + down.w * column.rows[3],
        vec4(0));
    return vec4(held.rgb, min(held.a, 1));
}
