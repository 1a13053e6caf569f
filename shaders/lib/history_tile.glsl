// The parts of a HistoryTile that share a word.

// The pixels of a quarter that the history did not see.
uint unseenIn(uint unseen, uint quarter) { return unseen >> (8 * quarter) & 0xffu; }
