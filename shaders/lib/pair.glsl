// Writing the pairs of a splat. For shaders with a BinPass as `pass` and with kMasked.

// Where the pairs of a splat lie, half open; nowhere if there is no such splat or no room for all.
uvec2 pairsOf(uint rank) {
    const uint splats = pass.visible.at[0].count, pairs = pass.pairs.at[0].count;
    if (rank >= splats || pairs == 0) { return uvec2(0); }
    return uvec2(pass.pair_offsets.at[rank], rank + 1 < splats ? pass.pair_offsets.at[rank + 1] : pairs);
}

// The next of `pairs`, if there is any and the tile counts.
void putPair(inout uvec2 pairs, uint tile, uint rank) {
    if (pairs.x >= pairs.y || (kMasked && pass.tiles_before.at[tile + 1] == pass.tiles_before.at[tile])) { return; }
    pass.tiles.at[pairs.x] = tile;
    pass.ranks.at[pairs.x] = rank;
    ++pairs.x;
}

uint tileIndex(ivec2 tile) { return uint(tile.y) * pass.size_tiles.x + uint(tile.x); }
