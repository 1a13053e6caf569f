// PNG and EXR, and the other formats that this build's library knows: implemented by one of
// picture_files_*.cpp.
#pragma once

#include "engine/picture/image.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace binosplat {

// The largest number of values in a picture, since a broken file must not exhaust memory.
inline constexpr std::uint64_t kMostPictureValues = std::uint64_t{1} << 30;

// If not, the next two are never called.
bool hasPngAndExr();
// In float32. If this throws Error, there is no file.
void writeExr(const std::filesystem::path& path, const Image& image);
// With 8 bits, from an image with three channels. If this throws Error, there is no file.
void writePng(const std::filesystem::path& path, const Image& rgb);

// The same as JPEG; false if this build cannot.
bool writeJpegFile(const std::filesystem::path& path, const Image& rgb);

// `file` is the file at `path`, at its beginning. Throws Error.
Image readPictureFile(const std::filesystem::path& path, std::FILE* file);

}  // namespace binosplat
