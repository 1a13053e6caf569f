// A picture as it looks from the same place with other axes or angles.
#pragma once

#include "engine/geometry.h"
#include "engine/picture/image.h"

namespace binosplat {

// What a headset's compositor makes of a picture of `eye` for `view`: each pixel of the view comes from the
// four around its place in the picture, with linear weights, in linear light. If the view has the picture's
// own axes and pixels, it gets the pixels as they are.
Image showTurned(const Image& picture, const Eye& eye, const Eye& view);

}  // namespace binosplat
