// The keys of [view] as rows, from which reading, writing and docs/options.md follow.
#pragma once

#include "app/options/option_row.h"
#include "app/view/settings/view_settings.h"

#include <span>
#include <string_view>

namespace binosplat {

// All but those that place the scene.
std::span<const OptionRow<ViewSettings>> viewSettingsRows();
const OptionRow<ViewSettings>* findViewRow(std::string_view key);  // nullptr: there is none

}  // namespace binosplat
