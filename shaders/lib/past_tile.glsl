// The parts of a PastTile that share a word.

// The pixels of a quarter that the history did not see.
uint unseenIn(uint unseen, uint quarter) { return unseen >> (8 * quarter) & 0xffu; }
