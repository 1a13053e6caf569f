// A (tile, splat) pair. Where both numbers fit, one word has the tile above the `rank_bits` bits of the
// splat's rank; otherwise the tile has a word, the rank has another, and `rank_bits` is 0.

uint tileOfPair(uint word, uint rank_bits) { return word >> rank_bits; }

uint rankOfPair(uint word, uint rank_bits) {
    return rank_bits == 0 ? word : word & ((1u << rank_bits) - 1);
}
