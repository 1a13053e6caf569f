// A message as a picture of at most two lines, for wearers who do not see the panel.
#pragma once

#include "app/view/room/sprites.h"

#include <functional>
#include <string_view>

namespace binosplat {

// A point of a drawing: its linear colour, not premultiplied by alpha.
struct DrawnPoint {
    glm::dvec3 light{0.0};
    double alpha = 0.0;
};
// Draws a square, from -1 to 1 in each direction, y down.
using Drawing = std::function<DrawnPoint(const glm::dvec2&)>;

// In the current ImGui context's font, white on a dark plate as wide as needed, with a drawing next to the
// text, if there is one.
TexelPicture drawMessage(std::string_view message, const TexelLayout& layout, const Drawing& drawing = {});

}  // namespace binosplat
