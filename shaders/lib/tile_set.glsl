// The tiles that a splat touches, in 64 bits: where its box begins and, if the box has at most 4x4 tiles, a
// bit for each tile that it touches (under a mask: only tiles of the mask). Otherwise where the box ends,
// half open; the outline must then say again which tiles of which rows it touches.
//
//   x0 | y0 << 16,   x1 | y1 << 16                                  a large box; coordinates are below 2^11
//   x0 | y0 << 16,   1 << 31 | 1 << (column + 4 row) for each tile  a small one

const int kSmallBox = 4;

bool isSmallBox(ivec4 box) { return all(lessThanEqual(box.zw - box.xy, ivec2(kSmallBox))); }

// A bit for each tile of a row, from x to y (exclusive) within the box; meaningless if the box is large.
uint smallRow(ivec2 in_row) {
    const ivec2 clipped = clamp(in_row, ivec2(0), ivec2(kSmallBox));
    return clipped.y > clipped.x ? (1u << clipped.y) - (1u << clipped.x) : 0;
}

uvec2 packTileSet(ivec4 box, uint small) {
    return uvec2(uint(box.x) | uint(box.y) << 16,
                 isSmallBox(box) ? 0x80000000u | small : uint(box.z) | uint(box.w) << 16);
}

bool isSmall(uvec2 tile_set) { return (tile_set.y & 0x80000000u) != 0; }

ivec2 firstTile(uvec2 tile_set) { return ivec2(tile_set.x & 0xffffu, tile_set.x >> 16); }

ivec4 largeBox(uvec2 tile_set) { return ivec4(firstTile(tile_set), tile_set.y & 0xffffu, tile_set.y >> 16); }

// The tiles of a small set, one bit each, and where the tile of a bit lies.
uint smallTiles(uvec2 tile_set) { return isSmall(tile_set) ? tile_set.y & 0xffffu : 0; }
ivec2 tileOfBit(uvec2 tile_set, int bit) {
    return firstTile(tile_set) + ivec2(bit % kSmallBox, bit / kSmallBox);
}
