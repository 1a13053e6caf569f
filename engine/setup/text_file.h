// Small files that people write (settings, headsets, scripts) and larger ones that programs write (cameras,
// head motion, fonts).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace binosplat {

inline constexpr std::size_t kMostTextBytes = std::size_t{4} << 20;
// Forty minutes of head motion at 60 Hz; fonts of many scripts.
inline constexpr std::size_t kMostRecordingBytes = std::size_t{16} << 20;

// The whole content of a file. Throws Error "FILE: cannot be read (WHY), must be EXPECTED" if it is not a
// regular file (which is checked without waiting for a pipe), is longer than `most_bytes`, or is a Git LFS
// pointer.
std::string readTextFile(const std::filesystem::path& path, const std::string& expected,
                         std::size_t most_bytes = kMostTextBytes);

}  // namespace binosplat
