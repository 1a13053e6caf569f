// PNG files of composed pictures, the same bytes for the same picture: no time stamps, no program names.
#pragma once

#include "xr/simulated/compose/compose.h"

#include <filesystem>

namespace simulated {

// The file's name until it is complete.
[[nodiscard]] std::filesystem::path nameUnfinishedPicture(const std::filesystem::path& path);
// The file appears whole or not at all. Throws std::runtime_error naming it, also if there is an unfinished
// one already.
void writePng(const std::filesystem::path& path, const RgbPicture& picture);
[[nodiscard]] RgbPicture readPng(const std::filesystem::path& path);

}  // namespace simulated
