// What shells complete of commands, options and their values.
#pragma once

#include <string>

namespace binosplat {

std::string completionsOfBash();
std::string completionsOfZsh();
std::string completionsOfFish();

}  // namespace binosplat
