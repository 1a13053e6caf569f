// A small picture that hangs in the room.
#pragma once

#include "app/view/room/sprites.h"
#include "app/view/room/strips.h"

namespace binosplat {

struct Thing {
    Sprite sprite;
    Strip strip;
};

}  // namespace binosplat
