// The sign of a float by its bits: NaN has none. A compiler may assume that there are no NaNs, and reverse
// comparisons that rely on them.

const uint kInfinityBits = 0x7f800000u;

bool isPositive(float value) { return floatBitsToUint(value) - 1 < kInfinityBits; }
bool isNegative(float value) { return floatBitsToUint(value) - 0x80000001u < kInfinityBits; }
bool isNotNegative(float value) { return floatBitsToUint(value) <= kInfinityBits; }  // nor -0
