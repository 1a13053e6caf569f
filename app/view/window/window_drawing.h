// Drawing finished pictures into a window's.
#pragma once

#include "engine/gpu/commands.h"

#include <glm/glm.hpp>

namespace binosplat {

// A part of a window, in its pixels.
struct WindowPart {
    glm::ivec2 at_px{0, 0}, size_px{0, 0};
};

void changeLayout(Commands& commands, vk::Image image, vk::ImageLayout from, vk::ImageLayout to);
// Black everywhere, ready for blits.
void clearWindow(Commands& commands, vk::Image window);
// The middle of a part, as large as the aspect ratio of a picture of this size allows.
WindowPart fittedInto(glm::uvec2 from_px, const WindowPart& part);
// Scales the first `from_px` pixels of an image into a part of the window; of these only what lies right of
// the column `from_x`.
void blitInto(Commands& commands, vk::Image from, glm::uvec2 from_px, vk::Image window,
              const WindowPart& part, std::uint32_t from_x = 0);

}  // namespace binosplat
