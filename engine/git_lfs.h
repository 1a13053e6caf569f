// In place of a large file that has not been fetched, Git LFS leaves a text of three lines.
#pragma once

#include "engine/error.h"

#include <string>
#include <string_view>

namespace binosplat {

// A pointer is shorter than this (by its specification) and begins with this.
inline constexpr std::size_t kLongestLfsPointer = 1024;
inline constexpr std::string_view kLfsPointerStart = "version https://git-lfs.github.com/spec/";

// Throws Error if `start`, the beginning of `file`, is a pointer's.
inline void requireNoLfsPointer(std::string_view start, const std::string& file) {
    check(!start.starts_with(kLfsPointerStart),
          "{}: is a Git LFS pointer, three lines in place of the file: must be fetched (`git lfs pull`)",
          file);
}

}  // namespace binosplat
