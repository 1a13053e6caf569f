// Image files: which kind is written and read how.
#include "engine/picture/image_io.h"

#include "engine/error.h"
#include "engine/picture/image_library.h"
#include "engine/picture/netpbm.h"
#include "engine/platform.h"

#include <algorithm>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

// "dir/left" + ".exr"; not replace_extension, which would cut a stem that holds a dot.
fs::path withExtension(const fs::path& stem, const char* extension) { return stem.string() + extension; }

#ifdef BINOSPLAT_OPENIMAGEIO

// Loaded once, by the first picture: OpenImageIO brings some 250 other libraries along, and each start of the program would take a third
// of a second more if they were linked.
const ImageLibrary& imageLibrary() {
    static const ImageLibrary* const library = [] {
        const fs::path folder = programFile().parent_path();
        check(folder.is_absolute(), "{} is not found: the system does not say where the program lies", BINOSPLAT_IMAGE_LIBRARY);
        const fs::path beside = folder / BINOSPLAT_IMAGE_LIBRARY;
        const fs::path installed = folder.parent_path() / "lib" / "binosplat" / BINOSPLAT_IMAGE_LIBRARY;
        std::error_code ignored;
        return static_cast<const ImageLibrary*>(findInLibrary(fs::exists(beside, ignored) ? beside : installed, kImageLibrarySymbol));
    }();
    return *library;
}

#endif

}  // namespace

const char* extensionOf(PictureKind kind) {
#ifdef BINOSPLAT_OPENIMAGEIO
    return kind == PictureKind::kFloat ? ".exr" : ".png";
#else
    return kind == PictureKind::kFloat ? ".pfm" : ".ppm";
#endif
}

std::vector<fs::path> writePicture(const fs::path& stem, PictureKind kind, const Image& image) {
    const fs::path path = withExtension(stem, extensionOf(kind));
    const bool fits = image.channels == 4 || image.channels == 3 || (image.channels == 1 && kind == PictureKind::kFloat);
    check(fits, "{}: image has {} channels, must be 3 or 4, or 1 for floats", path.string(), image.channels);
    check(image.pixelCount() > 0 && image.values.size() == image.pixelCount() * static_cast<std::size_t>(image.channels),
          "{}: image has {} values, must be {} x {} x {}", path.string(), image.values.size(), image.size_px.x, image.size_px.y,
          image.channels);
    const Image rgb = image.channels == 4 ? selectChannels(image, 0, 3) : Image{};
    const Image& opaque = image.channels == 4 ? rgb : image;
#ifdef BINOSPLAT_OPENIMAGEIO
    if (kind == PictureKind::kFloat) {
        imageLibrary().write_exr(path, image);
    } else {
        std::vector<unsigned char> bytes(opaque.values.size());
        std::ranges::transform(opaque.values, bytes.begin(), quantize);
        imageLibrary().write_png(path, opaque.size_px, bytes);
    }
    return {path};
#else
    if (kind == PictureKind::kDisplay) {
        writePnm(path, opaque);
        return {path};
    }
    writePfm(path, opaque);
    if (image.channels != 4) { return {path}; }
    const fs::path alpha = withExtension(stem, "_alpha.pfm");
    writePfm(alpha, selectChannels(image, 3, 1));
    return {path, alpha};
#endif
}

Image readPicture(const fs::path& path) {
    std::string reason;
    check(openRegularFile(path, reason) != nullptr, "{}: cannot be read ({}), must be an image file", path.string(), reason);
    if (path.extension() == ".pfm") { return readPfm(path); }
    if (path.extension() == ".ppm" || path.extension() == ".pgm") { return readPnm(path); }
#ifdef BINOSPLAT_OPENIMAGEIO
    Image image;
    imageLibrary().read(path, image);
    return image;
#else
    fail("{}: cannot be read in a build without OpenImageIO, must be .pfm, .ppm or .pgm", path.string());
#endif
}

}  // namespace binosplat
