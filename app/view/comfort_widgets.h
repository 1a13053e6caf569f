// The panel's row about moving and seeing the room.
#pragma once

#include "app/view/view_settings.h"

namespace binosplat {

// Between Canvas::begin and record, in the panel's window. Passthrough is there to be chosen only where the headset has it.
void drawComfort(ViewSettings& settings, bool can_pass_through);

}  // namespace binosplat
