// Where the files lie that come with the program: configs/headsets and the bench plans.
#pragma once

#include "engine/platform.h"

#include <filesystem>
#include <vector>

namespace binosplat {

// The folders that may hold configs/, first come first served: $BINOSPLAT_DATA, the working directory, those that the program lies in (a
// build inside the source tree), and ../share/binosplat beside its folder (an installed program).
std::vector<std::filesystem::path> dataFolders();

}  // namespace binosplat
