// Image files: the part that does not depend on the library used in this build.
#include "engine/picture/image_io.h"

#include "engine/error.h"
#include "engine/git_lfs.h"
#include "engine/picture/netpbm.h"
#include "engine/picture/picture_files.h"
#include "engine/platform.h"

#include <algorithm>
#include <array>
#include <span>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

// "dir/left" + ".exr"; replace_extension would cut a stem that contains a dot.
fs::path withExtension(const fs::path& stem, const char* extension) { return stem.string() + extension; }

}  // namespace

const char* extensionOf(PictureKind kind) {
    if (hasPngAndExr()) { return kind == PictureKind::kFloat ? ".exr" : ".png"; }
    return kind == PictureKind::kFloat ? ".pfm" : ".ppm";
}

std::vector<fs::path> writePicture(const fs::path& stem, PictureKind kind, const Image& image) {
    const fs::path path = withExtension(stem, extensionOf(kind));
    const bool fits =
        image.channels == 4 || image.channels == 3 || (image.channels == 1 && kind == PictureKind::kFloat);
    check(fits, "{}: image has {} channels, must be 3 or 4, or 1 for floats", path.string(), image.channels);
    check(image.pixelCount() > 0 &&
              image.values.size() == image.pixelCount() * static_cast<std::size_t>(image.channels),
          "{}: image has {} values, must be {} x {} x {}", path.string(), image.values.size(),
          image.size_px.x, image.size_px.y, image.channels);
    const Image rgb = image.channels == 4 ? selectChannels(image, 0, 3) : Image{};
    const Image& opaque = image.channels == 4 ? rgb : image;
    if (hasPngAndExr()) {
        if (kind == PictureKind::kFloat) {
            writeExr(path, image);
        } else {
            writePng(path, opaque);
        }
        return {path};
    }
    if (kind == PictureKind::kDisplay) {
        writePnm(path, opaque);
        return {path};
    }
    writePfm(path, opaque);
    if (image.channels != 4) { return {path}; }
    const fs::path alpha = withExtension(stem, "_alpha.pfm");
    writePfm(alpha, selectChannels(image, 3, 1));
    return {path, alpha};
}

fs::path writeJpeg(const fs::path& stem, const Image& image) {
    const fs::path path = withExtension(stem, ".jpg");
    return writeJpegFile(path, image.channels == 4 ? selectChannels(image, 0, 3) : image) ? path : fs::path();
}

Image readPicture(const fs::path& path) {
    std::string reason;
    const File file = openRegularFile(path, reason);
    check(file != nullptr, "{}: cannot be read ({}), must be an image file", path.string(), reason);
    std::array<char, kLfsPointerStart.size()> start{};
    requireNoLfsPointer(
        {start.data(), readAt(file.get(), 0, std::as_writable_bytes(std::span(start))).value_or(0)},
        path.string());
    if (path.extension() == ".pfm") { return readPfm(path); }
    if (path.extension() == ".ppm" || path.extension() == ".pgm") { return readPnm(path); }
    return readPictureFile(path, file.get());
}

}  // namespace binosplat
