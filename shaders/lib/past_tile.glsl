// What a PastTile holds in parts of a word.

// The pixels of a quarter that the past did not see.
uint unseenIn(uint unseen, uint quarter) { return unseen >> (8 * quarter) & 0xffu; }
