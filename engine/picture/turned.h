// A picture as a view from the same place with other axes or angles shows it.
#pragma once

#include "engine/geometry.h"
#include "engine/picture/image.h"

namespace binosplat {

// What a headset's compositor makes of a picture of `eye` for `view`: each pixel of the view from the four around its place in the picture,
// by linear weights, in linear light. A view that has the picture's own axes and pixels gets these as they are.
Image showTurned(const Image& picture, const Eye& eye, const Eye& view);

}  // namespace binosplat
