// Writes the pairs of a splat. For shaders with a BinPass as `pass`, after lib/list.glsl and lib/target.glsl.

uint firstSplat() { return gl_WorkGroupID.z * pass.splats_apart; }

// Where the pairs of the target's block of kListBlock splats begin.
uint pairsBefore(uint block) {
    return pass.group_sums.at[gl_WorkGroupID.z * groupsOver(pass.visible.at[0].count, kListBlock) + block];
}

// Where the `count` pairs of a splat lie, half open; empty if the capacity does not suffice for the pairs of
// all splats.
uvec2 pairsFrom(uint begin, uint count) {
    return pass.pairs.at[0].count > 0 ? uvec2(begin, begin + count) : uvec2(0);
}

// See lib/pair_word.glsl.
void putPairAt(uint place, uint tile, uint rank) {
    if (pass.rank_bits == 0) {
        pass.tiles.at[place] = tile;
        pass.ranks.at[place] = rank;
    } else {
        pass.tiles.at[place] = tile << pass.rank_bits | rank;
    }
}

// The next of `pairs`, if there is one. `tile`: its number.
void putPair(inout uvec2 pairs, uint tile, uint rank) {
    if (pairs.x >= pairs.y) { return; }
    putPairAt(pairs.x, tile, rank);
    ++pairs.x;
}
