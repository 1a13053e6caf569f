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

// All of a file. Throws Error "FILE: cannot be read (WHY), must be EXPECTED" if it is no regular file, which
// is found out without waiting for a pipe, or longer than `most_bytes`; and for a Git LFS pointer.
std::string readTextFile(const std::filesystem::path& path, const std::string& expected,
                         std::size_t most_bytes = kMostTextBytes);

}  // namespace binosplat
