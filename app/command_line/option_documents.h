// The list of commands and options for readers and shells.
#pragma once

#include <string>

namespace binosplat {

// `kind`: markdown (docs/options.md), config (configs/default.toml), man (section 1), or a shell's
// completion: bash, zsh or fish. Throws Error (usage) for any other.
std::string documentOf(const std::string& kind);

// configs/default.toml. A key without a default of its own, or with one that depends on the command, is a
// comment there, with an example value.
std::string defaultConfig();

// Completion of commands, options and their values.
std::string completionsOfBash();
std::string completionsOfZsh();
std::string completionsOfFish();

}  // namespace binosplat
