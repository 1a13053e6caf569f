// Image files: EXR and PNG through OpenImageIO, or through OpenEXR and libpng, which are not used outside
// this folder; PFM and PPM in a build with none of these. A failed write leaves no file. Write files that
// others may watch into OutputFiles' staging folder.
#pragma once

#include "engine/picture/image.h"

#include <filesystem>
#include <vector>

namespace binosplat {

enum class PictureKind {
    kFloat,    // float32, every channel as it is: .exr, or .pfm
    kDisplay,  // 8 bits, opaque display-encoded RGB, clamped and rounded: .png, or .ppm
};

// The extension of a kind in this build, with its dot.
const char* extensionOf(PictureKind kind);

// Writes `stem` + extension. Float pictures have 4 channels (R, G, B, A), 3 (R, G, B) or 1, called D (depth);
// display pictures 3 or 4. PFM has no fourth channel: A goes to a separate file `stem`_alpha.pfm. Returns the
// files written. Throws Error naming the file.
std::vector<std::filesystem::path> writePicture(const std::filesystem::path& stem, PictureKind kind,
                                                const Image& image);

// A display picture as `stem`.jpg, the only format that some galleries take. Empty: this build cannot write
// it.
std::filesystem::path writeJpeg(const std::filesystem::path& stem, const Image& image);

// Reads any image file that this build knows, by its content or extension; 8-bit values become 0 to 1. For
// tests, goldens and photographs.
Image readPicture(const std::filesystem::path& path);

}  // namespace binosplat
