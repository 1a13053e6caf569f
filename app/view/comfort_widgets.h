// The panel's row about moving and seeing the room.
#pragma once

#include "app/view/panel_widgets.h"
#include "app/view/view_settings.h"

namespace binosplat {

// Between Canvas::begin and record, in the panel's window. Passthrough is there to be chosen only where the headset has it.
void drawComfort(PanelWidgets& widgets, ViewSettings& settings, bool can_pass_through);

}  // namespace binosplat
