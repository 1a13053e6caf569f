// Pictures at another size.
#pragma once

#include "engine/picture/image.h"

namespace binosplat {

// The picture scaled up as a headset's compositor does: by cubic convolution (Keys 1981, a = -1/2), all
// channels, not below 0. Weights beyond the border are given to the pixels within. Throws Error if the size
// is smaller in either direction.
Image scaleUp(const Image& picture, glm::uvec2 size_px);

}  // namespace binosplat
