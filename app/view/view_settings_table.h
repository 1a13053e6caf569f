// The keys of [view] as rows, from which reading, writing and docs/options.md follow.
#pragma once

#include "app/options/option_row.h"
#include "app/view/view_settings.h"

#include <span>

namespace binosplat {

// All but those that place the scene.
std::span<const OptionRow<ViewSettings>> viewSettingsRows();

}  // namespace binosplat
