// The list of commands and options for readers and shells.
#pragma once

#include <string>

namespace binosplat {

// `kind`: markdown (docs/options.md), config (configs/default.toml), man (section 1) or bash (completion). Throws Error (usage) for
// another.
std::string documentOf(const std::string& kind);

}  // namespace binosplat
