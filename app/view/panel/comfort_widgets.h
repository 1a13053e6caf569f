// The panel's rows about moving and seeing the room, and about the headset's rate.
#pragma once

#include "app/view/panel/panel_widgets.h"
#include "app/view/view_settings.h"

#include <vector>

namespace binosplat {

// Between Canvas::begin and record, in the panel's window. Passthrough is there to be chosen only where the headset has it.
void drawComfort(PanelWidgets& widgets, ViewSettings& settings, bool can_pass_through);
// A row of the headset's rates; nothing where it cannot be asked for any.
void drawRates(PanelWidgets& widgets, ViewSettings& settings, const std::vector<double>& rates_hz);

}  // namespace binosplat
