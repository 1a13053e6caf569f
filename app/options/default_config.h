// configs/default.toml: every key of a config, as the table of options has it.
#pragma once

#include <string>

namespace binosplat {

// What has no default of its own, or one that depends on the command, stands there as a comment, with a value that it could have.
std::string defaultConfig();

}  // namespace binosplat
