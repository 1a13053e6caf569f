// Names in the order that people put them: room2 before room10, whatever their capitals.
#pragma once

#include <string_view>

namespace binosplat {

// Runs of digits count as numbers, of any length; letters of ASCII alike in both cases. Names that differ in nothing else go by their
// bytes, so that this orders all names.
bool comesBefore(std::string_view a, std::string_view b);

}  // namespace binosplat
