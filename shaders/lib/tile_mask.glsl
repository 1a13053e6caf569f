// A set of tiles, a bit each: bit x & 31 of word x / 32 in the tile's row; every row begins a word.

uint maskWords(uvec2 size_tiles) { return (size_tiles.x + 31) / 32; }

bool isInMask(Uints mask, uvec2 size_tiles, uvec2 tile) {
    return (mask.at[tile.y * maskWords(size_tiles) + tile.x / 32] & (1u << (tile.x & 31))) != 0;
}

// The tile's bit, and those of the tiles to its right as far as the row goes: at least four of them.
uint maskBits(Uints mask, uvec2 size_tiles, uvec2 tile) {
    const uint words = maskWords(size_tiles), word = tile.x / 32, shift = tile.x & 31;
    if (word >= words) { return 0; }
    const uint low = mask.at[tile.y * words + word] >> shift;
    return shift > 28 && word + 1 < words ? low | mask.at[tile.y * words + word + 1] << (32 - shift) : low;
}

// How many tiles of a row, of those from `begin` to `end` (exclusive), belong to it.
uint countInMask(Uints mask, uvec2 size_tiles, uint row, uint begin, uint end) {
    uint tiles = 0;
    while (begin < end) {
        const uint next = min(end, (begin & ~31u) + 32);
        const uint bits = mask.at[row * maskWords(size_tiles) + begin / 32] >> (begin & 31);
        const uint width = next - begin;
        tiles += bitCount(width < 32 ? bits & ((1u << width) - 1) : bits);
        begin = next;
    }
    return tiles;
}
