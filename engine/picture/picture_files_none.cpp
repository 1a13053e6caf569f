// Image files of a build without libraries for them.
#include "engine/error.h"
#include "engine/picture/picture_files.h"

#include <cassert>

namespace binosplat {

bool hasPngAndExr() { return false; }

void writeExr(const std::filesystem::path&, const Image&) { assert(false); }

void writePng(const std::filesystem::path&, const Image&) { assert(false); }

bool writeJpegFile(const std::filesystem::path&, const Image&) { return false; }

Image readPictureFile(const std::filesystem::path& path, std::FILE*) {
    fail("{}: cannot be read in a build without OpenImageIO, must be .pfm, .ppm or .pgm", path.string());
}

}  // namespace binosplat
