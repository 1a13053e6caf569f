// PFM (float32) and binary PPM and PGM (8 bits): image files for builds without OpenImageIO. No dependencies.
#pragma once

#include "engine/picture/image.h"

#include <filesystem>

namespace binosplat {

// 1 or 3 channels, little endian, rows bottom to top as the format requires. Throws Error naming the file.
void writePfm(const std::filesystem::path& path, const Image& image);
Image readPfm(const std::filesystem::path& path);

// 1 (PGM) or 3 (PPM) channels; 0 to 1 becomes 0 to 255, clamped and rounded; NaN becomes 0.
void writePnm(const std::filesystem::path& path, const Image& image);
Image readPnm(const std::filesystem::path& path);

// 8 bits of a display-encoded value.
unsigned char quantize(float value);

// The given channels of an image, in that order.
Image selectChannels(const Image& image, int first, int count);

}  // namespace binosplat
