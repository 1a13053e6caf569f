// Writing the pairs of a splat. For shaders with a BinPass as `pass`.

// Where the `count` pairs of a splat lie, half open; empty if there is no room for the pairs of all splats.
uvec2 pairsFrom(uint begin, uint count) { return pass.pairs.at[0].count > 0 ? uvec2(begin, begin + count) : uvec2(0); }

// The next of `pairs`, if there is any.
void putPair(inout uvec2 pairs, uvec2 tile, uint rank) {
    if (pairs.x >= pairs.y) { return; }
    pass.tiles.at[pairs.x] = tile.y * pass.size_tiles.x + tile.x;
    pass.ranks.at[pairs.x] = rank;
    ++pairs.x;
}
