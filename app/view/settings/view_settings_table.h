// The keys of [view] as rows, the basis of reading, writing and docs/options.md.
#pragma once

#include "app/options/option_row.h"
#include "app/view/settings/view_settings.h"

#include <span>
#include <string_view>

namespace binosplat {

// All keys except those that place the scene.
std::span<const OptionRow<ViewSettings>> viewSettingsRows();
const OptionRow<ViewSettings>* findViewRow(std::string_view key);  // nullptr if there is none

}  // namespace binosplat
