// Image files; this alone knows OpenImageIO.
#include "engine/picture/image_io.h"

#include "engine/error.h"
#include "engine/git_lfs.h"
#include "engine/picture/netpbm.h"
#include "engine/platform.h"

#ifdef BINOSPLAT_OPENIMAGEIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <OpenImageIO/imageio.h>
#pragma GCC diagnostic pop
#endif

#include <algorithm>
#include <array>
#include <span>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

// "dir/left" + ".exr"; not replace_extension, which would cut a stem that holds a dot.
fs::path withExtension(const fs::path& stem, const char* extension) { return stem.string() + extension; }

#ifdef BINOSPLAT_OPENIMAGEIO

constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 30;

// The library's messages can span lines; ours are one.
std::string oneLine(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    while (!text.empty() && text.back() == ' ') { text.pop_back(); }
    return text;
}

void writeWithLibrary(const fs::path& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* values) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string());
    check(output != nullptr, "{}: cannot be written ({})", path.string(), oneLine(OIIO::geterror()));
    const bool opened = output->open(path.string(), spec);
    // `close` flushes: a full disk may show there only.
    const bool written = opened && output->write_image(type, values);
    const std::string first_error = written ? "" : output->geterror();
    const bool closed = output->close();
    if (!written || !closed) {
        std::error_code ignored;
        fs::remove(path, ignored);
        fail("{}: cannot be written ({})", path.string(), oneLine(written ? output->geterror() : first_error));
    }
}

void writeExr(const fs::path& path, const Image& image) {
    OIIO::ImageSpec spec(static_cast<int>(image.size_px.x), static_cast<int>(image.size_px.y), image.channels, OIIO::TypeDesc::FLOAT);
    if (image.channels == 1) { spec.channelnames = {"D"}; }
    spec.attribute("compression", "zip");
    writeWithLibrary(path, spec, OIIO::TypeDesc::FLOAT, image.values.data());
}

void writePng(const fs::path& path, const Image& rgb) {
    OIIO::ImageSpec spec(static_cast<int>(rgb.size_px.x), static_cast<int>(rgb.size_px.y), 3, OIIO::TypeDesc::UINT8);
    std::vector<unsigned char> bytes(rgb.values.size());
    std::ranges::transform(rgb.values, bytes.begin(), quantize);
    writeWithLibrary(path, spec, OIIO::TypeDesc::UINT8, bytes.data());
}

Image readWithLibrary(const fs::path& path) {
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);  // colours are not multiplied by alpha
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string(), &as_stored);
    check(input != nullptr, "{}: cannot be read ({}), must be an image file", path.string(), oneLine(OIIO::geterror()));
    const OIIO::ImageSpec& spec = input->spec();
    const bool is_flat = spec.width > 0 && spec.height > 0 && spec.depth <= 1 && spec.nchannels > 0 && !spec.deep;
    check(is_flat && spec.image_pixels() <= kMaxValues / static_cast<std::uint64_t>(spec.nchannels),
          "{}: has {}x{}x{} pixels of {} channels{}, must be a flat picture of up to 2^30 values", path.string(), spec.width, spec.height,
          spec.depth, spec.nchannels, spec.deep ? ", deep" : "");
    Image image{{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height)}, spec.nchannels, {}};
    image.values.resize(image.pixelCount() * static_cast<std::size_t>(image.channels));
    const bool read = input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data());
    check(read, "{}: cannot be read ({})", path.string(), oneLine(input->geterror()));
    return image;
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
        writeExr(path, image);
    } else {
        writePng(path, opaque);
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
    const File file = openRegularFile(path, reason);
    check(file != nullptr, "{}: cannot be read ({}), must be an image file", path.string(), reason);
    std::array<char, kLfsPointerStart.size()> start{};
    requireNoLfsPointer({start.data(), readAt(file.get(), 0, std::as_writable_bytes(std::span(start))).value_or(0)}, path.string());
    if (path.extension() == ".pfm") { return readPfm(path); }
    if (path.extension() == ".ppm" || path.extension() == ".pgm") { return readPnm(path); }
#ifdef BINOSPLAT_OPENIMAGEIO
    return readWithLibrary(path);
#else
    fail("{}: cannot be read in a build without OpenImageIO, must be .pfm, .ppm or .pgm", path.string());
#endif
}

}  // namespace binosplat
