// Completion of commands, options and their values.
#pragma once

#include <string>

namespace binosplat {

std::string completionsOfBash();

}  // namespace binosplat
