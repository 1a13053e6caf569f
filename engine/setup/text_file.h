// Small files that people write: settings, headsets, cameras, head motion.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace binosplat {

inline constexpr std::size_t kMostTextBytes = std::size_t{16} << 20;

// All of a file. Throws Error "FILE: cannot be read (WHY), must be EXPECTED" if it is no regular file, which is found out without waiting
// for a pipe, or longer than kMostTextBytes.
std::string readTextFile(const std::filesystem::path& path, const std::string& expected);

}  // namespace binosplat
