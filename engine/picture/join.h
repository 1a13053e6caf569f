// Two pictures as one.
#pragma once

#include "engine/picture/image.h"

namespace binosplat {

// Pictures of the same size; the first is on the left, or above.
Image besideOneAnother(const Image& left, const Image& right);
Image aboveOneAnother(const Image& top, const Image& bottom);

}  // namespace binosplat
