// The tiles that a splat meets, in 64 bits: where its box begins and, if the box has at most 4x4 tiles, a bit
// for each tile that it meets (under a mask: only tiles of the mask). Otherwise the last column and row of
// the box, and how many tiles there are; the outline must then tell again which rows meet which tiles. 0: none.
//
//   x0 | y0 << 10 | x1 << 20,   y1 | tiles << 10                    a large box; pictures have 2^10 columns
//   x0 | y0 << 10,              1 << 31 | 1 << (column + 4 row)     a small one

const int kSmallBox = 4;

bool isSmallBox(ivec4 box) { return all(lessThanEqual(box.zw - box.xy, ivec2(kSmallBox))); }

// A bit for each tile of a row, from x to y (exclusive) within the box; meaningless if the box is large.
uint smallRow(ivec2 in_row) {
    const ivec2 clipped = clamp(in_row, ivec2(0), ivec2(kSmallBox));
    return clipped.y > clipped.x ? (1u << clipped.y) - (1u << clipped.x) : 0;
}

// Of a splat that meets `tiles` of them, at least one.
uvec2 packTileSet(ivec4 box, uint small, uint tiles) {
    const uint first = uint(box.x) | uint(box.y) << 10;
    return isSmallBox(box) ? uvec2(first, 0x80000000u | small)
                           : uvec2(first | uint(box.z - 1) << 20, uint(box.w - 1) | tiles << 10);
}

bool isSmall(uvec2 tile_set) { return (tile_set.y & 0x80000000u) != 0; }

uint tileCount(uvec2 tile_set) {
    return isSmall(tile_set) ? bitCount(tile_set.y & 0xffffu) : tile_set.y >> 10;
}

ivec2 firstTile(uvec2 tile_set) { return ivec2(tile_set.x & 0x3ffu, tile_set.x >> 10 & 0x3ffu); }

ivec4 largeBox(uvec2 tile_set) {
    return ivec4(firstTile(tile_set), (tile_set.x >> 20) + 1, (tile_set.y & 0x3ffu) + 1);
}

// The tiles of a small set, one bit each, and where the tile of a bit lies.
uint smallTiles(uvec2 tile_set) { return isSmall(tile_set) ? tile_set.y & 0xffffu : 0; }
ivec2 tileOfBit(uvec2 tile_set, int bit) {
    return firstTile(tile_set) + ivec2(bit % kSmallBox, bit / kSmallBox);
}
