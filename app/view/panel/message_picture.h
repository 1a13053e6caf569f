// A message as a picture of two lines at most, for wearers who do not see the panel.
#pragma once

#include "app/view/room/sprites.h"

#include <string_view>

namespace binosplat {

inline constexpr glm::uvec2 kMessagePx(768, 64);

// In the current ImGui context's letters, white on a dark plate as wide as they need.
TexelPicture drawMessage(std::string_view message, const TexelLayout& layout);

}  // namespace binosplat
