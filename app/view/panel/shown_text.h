// Text as the panel shows it.
#pragma once

#include <string>
#include <string_view>

namespace binosplat {

// UTF-8 from left to right, as ImGui draws it, of text that may hold anything: control characters become boxes, words of Hebrew and Arabic
// are turned round, and Arabic letters joined (Unicode's bidirectional algorithm, by FriBidi).
std::string asShown(std::string_view text);
// The first of it alone.
std::string withoutControls(std::string_view text);

}  // namespace binosplat
