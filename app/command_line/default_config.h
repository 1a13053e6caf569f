// configs/default.toml: every key of a config, from the table of options.
#pragma once

#include <string>

namespace binosplat {

// A key without a default of its own, or with one that depends on the command, is a comment there, with an example value.
std::string defaultConfig();

}  // namespace binosplat
