// Joins rows.
#include "engine/picture/join.h"

#include <cstddef>

namespace binosplat {

Image besideOneAnother(const Image& left, const Image& right) {
    Image both{{left.size_px.x + right.size_px.x, left.size_px.y}, left.channels, {}};
    both.values.reserve(left.values.size() + right.values.size());
    const auto row = static_cast<std::ptrdiff_t>(left.size_px.x) * left.channels;
    for (auto l = left.values.begin(), r = right.values.begin(); l != left.values.end(); l += row, r += row) {
        both.values.insert(both.values.end(), l, l + row);
        both.values.insert(both.values.end(), r, r + row);
    }
    return both;
}

Image aboveOneAnother(const Image& top, const Image& bottom) {
    Image both = top;
    both.size_px.y += bottom.size_px.y;
    both.values.insert(both.values.end(), bottom.values.begin(), bottom.values.end());
    return both;
}

}  // namespace binosplat
