// Orders names as people would: room2 before room10, ignoring case.
#pragma once

#include <string_view>

namespace binosplat {

// Runs of digits count as numbers, of any length; ASCII letters compare without case. Names that are
// otherwise equal are compared by bytes, so that the order is total.
bool comesBefore(std::string_view a, std::string_view b);

}  // namespace binosplat
