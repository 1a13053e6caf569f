// The tile of a pixel, the pixel of a place; and a set of tiles, one bit each: bit x & 31 of word x / 32 in
// the tile's row; every row begins a word.

uint tileOf(uvec2 size_tiles, uvec2 pixel) {
    return (pixel.y / kTileSize) * size_tiles.x + pixel.x / kTileSize;
}

// The pixel that contains a place, or the nearest one; within the picture even for NaN, which a clamp alone
// may turn into anything.
uvec2 pixelAt(uvec2 size_px, vec2 place_px) {
    return min(uvec2(clamp(place_px, vec2(0), vec2(size_px) - 1)), size_px - 1);
}

uint maskWords(uvec2 size_tiles) { return (size_tiles.x + 31) / 32; }

bool isInMask(Uints mask, uvec2 size_tiles, uvec2 tile) {
    return (mask.at[tile.y * maskWords(size_tiles) + tile.x / 32] & (1u << (tile.x & 31))) != 0;
}

// Where the word of tile `x` of a row ends, or `end` if that comes first.
uint wordEnd(uint x, uint end) { return min(end, (x & ~31u) + 32); }

// The mask's bits for a row's tiles from `begin` to `end` (exclusive, see wordEnd): bit 0 is the first
// tile's.
uint maskBits(Uints mask, uvec2 size_tiles, uint row, uint begin, uint end) {
    const uint bits = mask.at[row * maskWords(size_tiles) + begin / 32] >> (begin & 31);
    return end - begin < 32 ? bits & ((1u << (end - begin)) - 1) : bits;
}
