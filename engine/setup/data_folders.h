// Where the files are that come with the program: configs/headsets and the bench plans.
#pragma once

#include "engine/platform.h"

#include <filesystem>
#include <vector>

namespace binosplat {

// The folders that may hold configs/, in order of precedence: $BINOSPLAT_DATA, the working directory, those
// above the program (a build inside the source tree), and ../share/binosplat beside its folder (an installed
// program).
std::vector<std::filesystem::path> dataFolders();

}  // namespace binosplat
