// Where the files are that come with the program: configs/headsets and the bench plans.
#pragma once

#include "engine/platform.h"

#include <filesystem>
#include <vector>

namespace binosplat {

// The folders that may contain configs/, in order of precedence: $BINOSPLAT_DATA, the working directory, the
// folders above the program (a build inside the source tree), and ../share/binosplat next to its folder (an
// installed program).
std::vector<std::filesystem::path> dataFolders();
// `name`; but if it is configs/..., and there is no such file here, that of the first of these folders that
// has one.
std::filesystem::path givenOrShipped(const std::filesystem::path& name);

}  // namespace binosplat
